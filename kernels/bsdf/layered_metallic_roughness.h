// glTF's metallic-roughness material with layers: reflection off its coat, its dielectric and its metal, and what passes it as
// if through a thin wall, spread by the same microfacets.
#ifndef WAVELOBE_BSDF_LAYERED_METALLIC_ROUGHNESS_H
#define WAVELOBE_BSDF_LAYERED_METALLIC_ROUGHNESS_H

#include "bsdf/layered_parameters.h"

typedef struct {
    Layered layers;
} LayeredMetallicRoughnessLobe;

INLINE LayeredMetallicRoughnessLobe layered_metallic_roughness_load(MaterialInput in) {
    LayeredMetallicRoughnessLobe l = {load_layered(in)};
    return l;
}

// Relative chances of the three ways on.
typedef struct {
    Float coat, surface, through;
} LayerWeights;

// Seen along `wi`, which is above the surface.
INLINE LayerWeights layer_weights(Layered l, Vec3 wi) {
    LayerWeights w;
    Float cosine = wi.z;
#if HAS_COAT_NORMALS
    Float on_coat = to_coat(l, wi).z;
    w.coat = SELECT(on_coat > 0.0f, coat_reflectance(l, on_coat), ZERO);
#else
    w.coat = coat_reflectance(l, cosine);
#endif
    w.surface = coat_transmittance(l, cosine) * max_component(metallic_roughness_fresnel(l.material, cosine));
    w.through = l.transmission * base_share(l, cosine) * max_component(l.material.base);
#if HAS_SHEEN
    Float below = sheen_rest(l.sheen, sheen_albedo(l.sheen, cosine));
    w.surface *= below;
    w.through *= below;
#endif
    return w;
}

INLINE Float layered_metallic_roughness_weight(LayeredMetallicRoughnessLobe l, Vec3 wi) {
    LayerWeights w = layer_weights(l.layers, vec3(wi.x, wi.y, fabs(wi.z)));
    return w.coat + w.surface + w.through;
}

INLINE LobeValue layered_metallic_roughness_eval(LayeredMetallicRoughnessLobe lobe, Vec3 wi, Vec3 wo) {
    Layered l = lobe.layers;
    Int turned = turned_over(l, wi);
    wi = turn_where(turned, wi);
    wo = turn_where(turned, wo);
    Int through = l.two_sided & (wo.z < 0.0f);
    wo = turn_where(through, wo);
    LayerWeights w = layer_weights(l, wi);
    Float all = w.coat + w.surface + w.through;
    Float inverse = SELECT(all > 0.0f, 1.0f / all, ZERO);
    MicrofacetReflection surface = microfacet_reflection(l.microfacets, to_microfacets(l, wi), to_microfacets(l, wo));
    MicrofacetReflection coat = microfacet_reflection(l.coat_microfacets, to_coat(l, wi), to_coat(l, wo));
#if HAS_COAT_NORMALS
    coat.value = SELECT(coat.visible, coat.value, ZERO);
    coat.pdf = SELECT(coat.visible, coat.pdf, ZERO);
#endif

#if HAS_SHEEN
    // The sheen lies between the coat and all else.
    surface.value *= sheen_rest(l.sheen, GREATER(sheen_albedo(l.sheen, wi.z), sheen_albedo(l.sheen, wo.z)));
#endif
    Rgb reflected = scale(metallic_roughness_fresnel(l.material, surface.cos_m), coat_transmittance(l, surface.cos_m) * surface.value);
    Float off_coat = coat_reflectance(l, surface.cos_m) * coat.value;
    Rgb passed = scale(l.material.base, l.transmission * base_share(l, surface.cos_m) * surface.value);
    Rgb value = select3(through, passed, vec3(reflected.x + off_coat, reflected.y + off_coat, reflected.z + off_coat));
    Float pdf = SELECT(through, w.through * surface.pdf, madd(w.surface, surface.pdf, w.coat * coat.pdf));
    return lobe_value_where(surface.visible & (all > 0.0f), value, inverse * pdf);
}

INLINE Vec3 layered_metallic_roughness_sample(LayeredMetallicRoughnessLobe lobe, Vec3 wi, Float u1, Float u2, Float u3) {
    Layered l = lobe.layers;
    Int turned = turned_over(l, wi);
    wi = turn_where(turned, wi);
    LayerWeights w = layer_weights(l, wi);
    Float at = u3 * (w.coat + w.surface + w.through);
    Int coat = at < w.coat;
    Int through = !coat & !(at < w.coat + w.surface) & (w.through > 0.0f);
    Microfacets d = l.microfacets;
    d.alpha_u = SELECT(coat, l.coat_microfacets.alpha_u, d.alpha_u);
    d.alpha_v = SELECT(coat, l.coat_microfacets.alpha_v, d.alpha_v);
#if HAS_COAT_NORMALS
    Vec3 wo = sample_microfacet_reflection(d, select3(coat, to_coat(l, wi), to_microfacets(l, wi)), u1, u2);
    wo = select3(coat, from_coat(l, wo), from_microfacets(l, wo));
    // What the coat sends below the surface under it goes nowhere, and what it would see from there is nothing.
    wo = select3(coat & !((wi.z > 0.0f) & (wo.z > 0.0f)), vec3_all(ZERO), wo);
#else
    Vec3 wo = from_microfacets(l, sample_microfacet_reflection(d, to_microfacets(l, wi), u1, u2));
#endif
    return turn_where(turned, turn_where(through, wo));
}

#endif
