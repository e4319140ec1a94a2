// Parameters of the principled materials, and the terms that their lobes share. Burley 2012, "Physically Based Shading at
// Disney", and 2015, "Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering", as Mitsuba 3 has them.
#ifndef WAVELOBE_BSDF_PRINCIPLED_PARAMETERS_H
#define WAVELOBE_BSDF_PRINCIPLED_PARAMETERS_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacet.h"

#if HAS_TEXTURES
INLINE Int is_principled(MaterialInput in) {
    const uint lobes = 1u << LOBE_PRINCIPLED | 1u << LOBE_PRINCIPLED_BASE | 1u << LOBE_PRINCIPLED_THIN | 1u << LOBE_PRINCIPLED_THIN_BASE;
    return (as_UInt(load_constant(in, lobes)) & (UInt)lobes) != (UInt)0u;
}
#endif

#define load_principled_float(in, field) load_record_float(extension_of(in), is_principled(in), PrincipledParameters, field)

// (1 - cos)^5: Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering".
INLINE Float principled_schlick_weight(Float cosine) {
    Float x = LESSER(GREATER(1.0f - cosine, ZERO), ONE);
    Float square = x * x;
    return square * square * x;
}

// Schlick's weight at an interface, by the cosine on the thinner side; cos_i is positive outside.
INLINE Float interface_schlick_weight(Float cos_i, Float eta) {
    Float eta_it = SELECT(cos_i >= 0.0f, eta, 1.0f / eta);
    Float cos_t_squared = madd(madd(cos_i, cos_i, (Float)-1.0f), 1.0f / (eta_it * eta_it), ONE);
    return principled_schlick_weight(SELECT(eta_it > 1.0f, fabs(cos_i), sqrt(GREATER(cos_t_squared, ZERO))));
}

INLINE Float normal_reflectance(Float eta) {
    Float amplitude = (eta - 1.0f) / (eta + 1.0f);
    return amplitude * amplitude;
}

// a + (b - a) t
INLINE Float mix_float(Float a, Float b, Float t) { return madd(b - a, t, a); }
INLINE Rgb mix_rgb(Rgb a, Rgb b, Float t) { return vec3(mix_float(a.x, b.x, t), mix_float(a.y, b.y, t), mix_float(a.z, b.z, t)); }

// The hue of a colour: white where it is black.
INLINE Rgb tint_of(Rgb base) {
    Float bright = luminance(base);
    return select3(bright > 0.0f, scale(base, 1.0f / SELECT(bright > 0.0f, bright, ONE)), vec3_all(ONE));
}

// Slopes are no smaller than Mitsuba 3 has them in this material, or its pictures of smooth ones would differ from ours.
#define LEAST_PRINCIPLED_ALPHA 1e-3f

// Slopes of microfacets of a roughness, stretched along u.
INLINE Microfacets principled_microfacets(Float roughness, Float anisotropic) {
    Float square = roughness * roughness;
    Float aspect = sqrt(madd(anisotropic, (Float)-0.9f, ONE));
    const Float least = (Float)LEAST_PRINCIPLED_ALPHA;
    Microfacets d = {GREATER(square / aspect, least), GREATER(square * aspect, least), !TRUE_MASK};
    return d;
}

// The diffuse part of both materials: base, retro-reflection, flattening and sheen.
typedef struct {
    Rgb base, sheen; // sheen: with its tint
    Float roughness, flatness;
} PrincipledDiffuse;

INLINE PrincipledDiffuse load_principled_diffuse(MaterialInput in) {
    PrincipledDiffuse d;
    d.base = load_rgb(in, diffuse);
    d.roughness = load_float(in, alpha_u);
    d.flatness = load_principled_float(in, flatness);
    Rgb tint = mix_rgb(vec3_all(ONE), tint_of(d.base), load_principled_float(in, sheen_tint));
    d.sheen = scale(tint, load_principled_float(in, sheen));
    return d;
}

// BSDF times cos wo of light between two directions above the surface; `scattering` and `sheen` are the shares of both parts.
INLINE Rgb principled_diffuse(PrincipledDiffuse d, Vec3 wi, Vec3 wo, Float scattering, Float sheen) {
    Float weight_o = principled_schlick_weight(wo.z), weight_i = principled_schlick_weight(wi.z);
    Float cos_d = 0.5f * sqrt(length_squared(add(wi, wo))); // between either direction and the half vector
    Float diffuse = madd(weight_i, (Float)-0.5f, ONE) * madd(weight_o, (Float)-0.5f, ONE);
    Float retro = 2.0f * d.roughness * cos_d * cos_d;
    Float reflected = retro * (weight_o + weight_i + weight_o * weight_i * (retro - 1.0f));
    // Flattened as if light went below the surface: Hanrahan, Krueger 1993, "Reflection from Layered Surfaces due to
    // Subsurface Scattering".
    Float grazing = 0.5f * retro;
    Float below = madd(weight_o, grazing, schlick_rest(wo.z)) * madd(weight_i, grazing, schlick_rest(wi.z));
    Float flattened = 1.25f * madd(below, 1.0f / GREATER(wo.z + wi.z, (Float)1e-30f) - 0.5f, (Float)0.5f);
    Float f = scattering * mix_float(diffuse + reflected, flattened, d.flatness) * INV_PI;
    // 1 - cos_d, from the difference of the directions: no digits are lost where they are close.
    Float x = 0.25f * length_squared(sub(wi, wo)) / (1.0f + cos_d);
    return scale(add(scale(d.base, f), scale(d.sheen, sheen * x * x * x * x * x)), wo.z);
}

#endif
