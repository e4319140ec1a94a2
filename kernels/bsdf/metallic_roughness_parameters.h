// Parameters of glTF 2.0's metallic-roughness material, as appendix B of its specification defines it (Khronos Group 2021).
// Both of its lobes read them.
#ifndef WAVELOBE_BSDF_METALLIC_ROUGHNESS_PARAMETERS_H
#define WAVELOBE_BSDF_METALLIC_ROUGHNESS_PARAMETERS_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacet.h"

typedef struct {
    Rgb base;     // albedo of the diffuse base, and reflectance of the metal at normal incidence
    Rgb f0;       // reflectance of the dielectric at normal incidence
    Float f90;    // and at grazing incidence
    Float metallic;
} MetallicRoughness;

INLINE MetallicRoughness load_metallic_roughness(MaterialInput in) {
    MetallicRoughness m;
    m.base = load_scaled_rgb(in, diffuse);
#if HAS_VERTEX_COLORS
    m.base = mul(m.base, in.color);
#endif
    m.f0 = constant_rgb(in, WORD_OFFSET(Material, specular));
    m.f90 = load_constant(in, specular_weight);
    m.metallic = load_scaled_float(in, metallic);
    return m;
}

INLINE Rgb schlick_from(Rgb f0, Float f90, Float weight) {
    return vec3(madd(f90 - f0.x, weight, f0.x), madd(f90 - f0.y, weight, f0.y), madd(f90 - f0.z, weight, f0.z));
}

// What the dielectric's surface reflects and does not let through to the base.
INLINE Rgb dielectric_reflectance(MetallicRoughness m, Float weight) { return schlick_from(m.f0, m.f90, weight); }

#endif
