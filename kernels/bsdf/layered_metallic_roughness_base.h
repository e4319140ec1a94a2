// The diffuse base of glTF's metallic-roughness material below its layers.
#ifndef WAVELOBE_BSDF_LAYERED_METALLIC_ROUGHNESS_BASE_H
#define WAVELOBE_BSDF_LAYERED_METALLIC_ROUGHNESS_BASE_H

#include "bsdf/layered_parameters.h"
#include "sampling/warps.h"

typedef struct {
    Layered layers;
} LayeredMetallicRoughnessBaseLobe;

INLINE LayeredMetallicRoughnessBaseLobe layered_metallic_roughness_base_load(MaterialInput in) {
    LayeredMetallicRoughnessBaseLobe l = {load_layered(in)};
    return l;
}

INLINE Float layered_metallic_roughness_base_weight(LayeredMetallicRoughnessBaseLobe l, Vec3 wi) {
    return (1.0f - l.layers.transmission) * base_share(l.layers, fabs(wi.z)) * max_component(l.layers.material.base);
}

INLINE LobeValue layered_metallic_roughness_base_eval(LayeredMetallicRoughnessBaseLobe lobe, Vec3 wi, Vec3 wo) {
    Layered l = lobe.layers;
    Int turned = turned_over(l, wi);
    wi = turn_where(turned, wi);
    wo = turn_where(turned, wo);
    Float pdf = wo.z * INV_PI;
    Int visible = (wi.z > 0.0f) & (wo.z > 0.0f);
    Float cos_m = SELECT(visible, dot3(wi, normalize3(add(wi, wo))), ONE);
    return lobe_value_where(visible, scale(l.material.base, pdf * (1.0f - l.transmission) * base_share(l, cos_m)), pdf);
}

INLINE Vec3 layered_metallic_roughness_base_sample(LayeredMetallicRoughnessBaseLobe lobe, Vec3 wi, Float u1, Float u2, Float u3) {
    Int turned = turned_over(lobe.layers, wi);
    Vec3 wo = select3(turned | (wi.z > 0.0f), sample_cosine_hemisphere(u1, u2), vec3_all(ZERO));
    return turn_where(turned, wo);
}

#endif
