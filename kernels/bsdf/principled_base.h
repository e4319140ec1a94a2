// The diffuse part of the principled material.
#ifndef WAVELOBE_BSDF_PRINCIPLED_BASE_H
#define WAVELOBE_BSDF_PRINCIPLED_BASE_H

#include "bsdf/principled_parameters.h"
#include "sampling/warps.h"

typedef struct {
    PrincipledDiffuse diffuse;
    Float scattering; // share of what is neither metal nor refracts
    Float sheen;
} PrincipledBaseLobe;

INLINE PrincipledBaseLobe principled_base_load(MaterialInput in) {
    PrincipledBaseLobe l;
    l.diffuse = load_principled_diffuse(in);
    Float rest = 1.0f - load_float(in, metallic);
    l.scattering = rest * (1.0f - load_principled_float(in, spec_trans));
    l.sheen = SELECT(l.scattering > 0.0f, rest, ZERO);
    return l;
}

INLINE Float principled_base_weight(PrincipledBaseLobe l, Vec3 wi) {
    Float weight = max_component(add(scale(l.diffuse.base, l.scattering), scale(l.diffuse.sheen, l.sheen)));
    return SELECT(wi.z > 0.0f, weight, ZERO);
}

INLINE LobeValue principled_base_eval(PrincipledBaseLobe l, Vec3 wi, Vec3 wo) {
    Rgb value = principled_diffuse(l.diffuse, wi, wo, l.scattering, l.sheen);
    return lobe_value_where((wi.z > 0.0f) & (wo.z > 0.0f), value, wo.z * INV_PI);
}

INLINE Vec3 principled_base_sample(PrincipledBaseLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    return select3(wi.z > 0.0f, sample_cosine_hemisphere(u1, u2), vec3_all(ZERO));
}

#endif
