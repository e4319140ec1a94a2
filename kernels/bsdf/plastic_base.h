// A diffuse base below a smooth dielectric surface: light refracts in, is scattered, and is reflected from inside any
// number of times before it refracts out again.
#ifndef WAVELOBE_BSDF_PLASTIC_BASE_H
#define WAVELOBE_BSDF_PLASTIC_BASE_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "sampling/warps.h"

typedef struct {
    Rgb diffuse;
    Float eta, internal_reflectance, specular_weight;
    Int nonlinear;
} PlasticBaseLobe;

INLINE PlasticBaseLobe plastic_base_load(MaterialInput in) {
    PlasticBaseLobe l;
    l.diffuse = load_rgb(in, diffuse);
    l.eta = load_constant(in, eta.x);
    l.internal_reflectance = load_constant(in, diffuse_fresnel_internal);
    l.specular_weight = load_constant(in, specular_weight);
    l.nonlinear = (load_flags(in) & (UInt)MATERIAL_NONLINEAR) != (UInt)0u;
    return l;
}

INLINE Float plastic_base_weight(PlasticBaseLobe l, Vec3 wi) {
    return fresnel_dielectric(fabs(wi.z), l.eta).transmittance * (1.0f - l.specular_weight);
}

INLINE LobeValue plastic_base_eval(PlasticBaseLobe l, Vec3 wi, Vec3 wo) {
    Float transmitted = fresnel_dielectric(fabs(wi.z), l.eta).transmittance *
                        fresnel_dielectric(fabs(wo.z), l.eta).transmittance / (l.eta * l.eta);
    Float pdf = wo.z * INV_PI;
    // Geometric series of internal reflections: with its colour, or keeping the hue of the base.
    Rgb trapped = scale(select3(l.nonlinear, l.diffuse, vec3_all(ONE)), l.internal_reflectance);
    Rgb base = vec3(l.diffuse.x / (1.0f - trapped.x), l.diffuse.y / (1.0f - trapped.y), l.diffuse.z / (1.0f - trapped.z));
    return lobe_value_where((wi.z > 0.0f) & (wo.z > 0.0f), scale(base, pdf * transmitted), pdf);
}

INLINE Vec3 plastic_base_sample(PlasticBaseLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    return select3(wi.z > 0.0f, sample_cosine_hemisphere(u1, u2), vec3_all(ZERO));
}

#endif
