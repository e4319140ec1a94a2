// A diffuse base below a rough dielectric surface: as plastic_base, with the surface's mean transmittance at the cosines
// of both directions.
#ifndef WAVELOBE_BSDF_ROUGH_PLASTIC_BASE_H
#define WAVELOBE_BSDF_ROUGH_PLASTIC_BASE_H

#include "bsdf/rough_transmittance.h"
#include "sampling/warps.h"

typedef struct {
    Rgb diffuse;
    Float eta, internal_reflectance, specular_weight;
    Int nonlinear;
    MaterialInput transmittance;
} RoughPlasticBaseLobe;

INLINE RoughPlasticBaseLobe rough_plastic_base_load(MaterialInput in) {
    RoughPlasticBaseLobe l;
    l.diffuse = load_rgb(in, diffuse);
    l.eta = load_constant(in, eta.x);
    l.internal_reflectance = load_constant(in, diffuse_fresnel_internal);
    l.specular_weight = load_constant(in, specular_weight);
    l.nonlinear = (load_flags(in) & (UInt)MATERIAL_NONLINEAR) != (UInt)0u;
    l.transmittance = extension_of(in);
    return l;
}

INLINE Float rough_plastic_base_weight(RoughPlasticBaseLobe l, Vec3 wi) {
    return rough_transmittance(l.transmittance, wi.z) * (1.0f - l.specular_weight);
}

INLINE LobeValue rough_plastic_base_eval(RoughPlasticBaseLobe l, Vec3 wi, Vec3 wo) {
    Float transmitted =
        rough_transmittance(l.transmittance, wi.z) * rough_transmittance(l.transmittance, wo.z) / (l.eta * l.eta);
    Float pdf = wo.z * INV_PI;
    Rgb trapped = scale(select3(l.nonlinear, l.diffuse, vec3_all(ONE)), l.internal_reflectance);
    Rgb base = vec3(l.diffuse.x / (1.0f - trapped.x), l.diffuse.y / (1.0f - trapped.y), l.diffuse.z / (1.0f - trapped.z));
    return lobe_value_where((wi.z > 0.0f) & (wo.z > 0.0f), scale(base, pdf * transmitted), pdf);
}

INLINE Vec3 rough_plastic_base_sample(RoughPlasticBaseLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    return select3(wi.z > 0.0f, sample_cosine_hemisphere(u1, u2), vec3_all(ZERO));
}

#endif
