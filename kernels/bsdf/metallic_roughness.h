// glTF's metallic-roughness material: reflection off the microfacets of its dielectric and of its metal.
#ifndef WAVELOBE_BSDF_METALLIC_ROUGHNESS_H
#define WAVELOBE_BSDF_METALLIC_ROUGHNESS_H

#include "bsdf/metallic_roughness_parameters.h"

typedef struct {
    MetallicRoughness material;
    Microfacets microfacets;
} MetallicRoughnessLobe;

INLINE MetallicRoughnessLobe metallic_roughness_load(MaterialInput in) {
    MetallicRoughnessLobe l;
    l.material = load_metallic_roughness(in);
    Float roughness = load_scaled_float(in, alpha_u);
    l.microfacets.alpha_u = GREATER(roughness * roughness, (Float)MIN_ALPHA);
    l.microfacets.alpha_v = l.microfacets.alpha_u;
    l.microfacets.beckmann = !TRUE_MASK;
    return l;
}

INLINE Rgb metallic_roughness_fresnel(MetallicRoughness m, Float cosine) {
    Float weight = schlick_weight(cosine);
    Rgb dielectric = dielectric_reflectance(m, weight);
    Rgb metal = schlick_from(m.base, ONE, weight);
    return add(scale(dielectric, 1.0f - m.metallic), scale(metal, m.metallic));
}

INLINE Float metallic_roughness_weight(MetallicRoughnessLobe l, Vec3 wi) {
    return max_component(metallic_roughness_fresnel(l.material, wi.z));
}

INLINE LobeValue metallic_roughness_eval(MetallicRoughnessLobe l, Vec3 wi, Vec3 wo) {
    Vec3 m = normalize3(add(wi, wo));
    Float cos_m = dot3(wi, m);
    Int visible = (wi.z > 0.0f) & (wo.z > 0.0f) & (cos_m > 0.0f);
    Float density = 0.25f * microfacet_density(l.microfacets, m);
    Masking g = microfacet_masking(l.microfacets, wi, wo);
    Rgb fresnel = metallic_roughness_fresnel(l.material, cos_m);
    return lobe_value_where(visible, scale(fresnel, density * g.both), density * g.visible);
}

INLINE Vec3 metallic_roughness_sample(MetallicRoughnessLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    Vec3 m = sample_visible_normal(l.microfacets, wi, u1, u2);
    Vec3 wo = scale_add(m, 2.0f * dot3(wi, m), negate(wi));
    return select3((wi.z > 0.0f) & (wo.z > 0.0f), wo, vec3_all(ZERO));
}

#endif
