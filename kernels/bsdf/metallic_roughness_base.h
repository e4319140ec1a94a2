// The diffuse base of glTF's metallic-roughness material: what its dielectric surface lets through.
#ifndef WAVELOBE_BSDF_METALLIC_ROUGHNESS_BASE_H
#define WAVELOBE_BSDF_METALLIC_ROUGHNESS_BASE_H

#include "bsdf/metallic_roughness_parameters.h"
#include "sampling/warps.h"

typedef struct {
    MetallicRoughness material;
} MetallicRoughnessBaseLobe;

INLINE MetallicRoughnessBaseLobe metallic_roughness_base_load(MaterialInput in) {
    MetallicRoughnessBaseLobe l = {load_metallic_roughness(in)};
    return l;
}

// Share of light that reaches the base of the dielectric, by the cosine on the half vector.
INLINE Float transmitted_to_base(MetallicRoughness m, Float cosine) {
    Float reflected = max_component(dielectric_reflectance(m, schlick_weight(cosine)));
    return (1.0f - m.metallic) * (1.0f - reflected);
}

INLINE Float metallic_roughness_base_weight(MetallicRoughnessBaseLobe l, Vec3 wi) {
    return max_component(l.material.base) * transmitted_to_base(l.material, wi.z);
}

INLINE LobeValue metallic_roughness_base_eval(MetallicRoughnessBaseLobe l, Vec3 wi, Vec3 wo) {
    Float pdf = wo.z * INV_PI;
    Int visible = (wi.z > 0.0f) & (wo.z > 0.0f);
    Float cos_m = SELECT(visible, dot3(wi, normalize3(add(wi, wo))), ONE);
    return lobe_value_where(visible, scale(l.material.base, pdf * transmitted_to_base(l.material, cos_m)), pdf);
}

INLINE Vec3 metallic_roughness_base_sample(MetallicRoughnessBaseLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    return select3(wi.z > 0.0f, sample_cosine_hemisphere(u1, u2), vec3_all(ZERO));
}

#endif
