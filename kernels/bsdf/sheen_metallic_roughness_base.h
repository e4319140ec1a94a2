// glTF's sheen (KHR_materials_sheen) and the diffuse base below it, under what other layers the material has.
#ifndef WAVELOBE_BSDF_SHEEN_METALLIC_ROUGHNESS_BASE_H
#define WAVELOBE_BSDF_SHEEN_METALLIC_ROUGHNESS_BASE_H

#include "bsdf/layered_parameters.h"
#include "sampling/warps.h"

typedef struct {
    Layered layers;
} SheenMetallicRoughnessBaseLobe;

INLINE SheenMetallicRoughnessBaseLobe sheen_metallic_roughness_base_load(MaterialInput in) {
    SheenMetallicRoughnessBaseLobe l = {load_layered(in)};
    return l;
}

// Relative chances of sheen and base.
typedef struct {
    Float sheen, base;
} SheenWeights;

INLINE SheenWeights sheen_weights(Layered l, Float cosine) {
    Float albedo = sheen_albedo(l.sheen, cosine);
    SheenWeights w;
    w.sheen = coat_transmittance(l, cosine) * max_component(l.sheen.color) * LESSER(albedo, ONE);
    w.base = (1.0f - l.transmission) * base_share(l, cosine) * max_component(l.material.base) * sheen_rest(l.sheen, albedo);
    return w;
}

INLINE Float sheen_metallic_roughness_base_weight(SheenMetallicRoughnessBaseLobe l, Vec3 wi) {
    SheenWeights w = sheen_weights(l.layers, fabs(wi.z));
    return w.sheen + w.base;
}

INLINE LobeValue sheen_metallic_roughness_base_eval(SheenMetallicRoughnessBaseLobe lobe, Vec3 wi, Vec3 wo) {
    Layered l = lobe.layers;
    Int turned = turned_over(l, wi);
    wi = turn_where(turned, wi);
    wo = turn_where(turned, wo);
    Int visible = (wi.z > 0.0f) & (wo.z > 0.0f);
    // Lanes that are not compute what is finite.
    wi = select3(visible, wi, vec3(ZERO, ZERO, ONE));
    wo = select3(visible, wo, vec3(ZERO, ZERO, ONE));
    Float cos_m = dot3(wi, normalize3(add(wi, wo)));
    SheenWeights w = sheen_weights(l, wi.z);
    Float all = w.sheen + w.base;
    Float albedo = GREATER(sheen_albedo(l.sheen, wi.z), sheen_albedo(l.sheen, wo.z));
    Rgb sheen = scale(l.sheen.color, coat_transmittance(l, cos_m) * sheen_value(l.sheen, wi, wo, albedo));
    Float cosine_pdf = wo.z * INV_PI;
    Rgb base = scale(l.material.base, cosine_pdf * (1.0f - l.transmission) * base_share(l, cos_m) * sheen_rest(l.sheen, albedo));
    Float pdf = madd(w.sheen, (Float)(0.5f * INV_PI), w.base * cosine_pdf) / all;
    return lobe_value_where(visible & (all > 0.0f), add(sheen, base), pdf);
}

INLINE Vec3 sheen_metallic_roughness_base_sample(SheenMetallicRoughnessBaseLobe lobe, Vec3 wi, Float u1, Float u2, Float u3) {
    Int turned = turned_over(lobe.layers, wi);
    SheenWeights w = sheen_weights(lobe.layers, fabs(wi.z));
    // Evenly over the hemisphere: sheen is broad, and more so than a cosine towards the horizon.
    Float s, c, r = sqrt(u1 * (2.0f - u1));
    lane_sin_cos_turns(u2, &s, &c);
    Int even = u3 * (w.sheen + w.base) < w.sheen;
    Vec3 wo = select3(even, vec3(r * c, r * s, 1.0f - u1), sample_cosine_hemisphere(u1, u2));
    wo = select3((turned | (wi.z > 0.0f)) & (w.sheen + w.base > 0.0f), wo, vec3_all(ZERO));
    return turn_where(turned, wo);
}

#endif
