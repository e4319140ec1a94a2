// A rough conductor: reflection off microfacets. Cook, Torrance 1982, "A Reflectance Model for Computer Graphics".
#ifndef WAVELOBE_BSDF_ROUGH_CONDUCTOR_H
#define WAVELOBE_BSDF_ROUGH_CONDUCTOR_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacet.h"

typedef struct {
    Rgb specular, eta, k;
    Microfacets microfacets;
} RoughConductorLobe;

INLINE RoughConductorLobe rough_conductor_load(MaterialInput in) {
    RoughConductorLobe l = {load_rgb(in, specular), constant_rgb(in, WORD_OFFSET(Material, eta)),
                            constant_rgb(in, WORD_OFFSET(Material, k)), load_microfacets(in)};
    return l;
}

INLINE Float rough_conductor_weight(RoughConductorLobe l, Vec3 wi) { return ONE; }

INLINE LobeValue rough_conductor_eval(RoughConductorLobe l, Vec3 wi, Vec3 wo) {
    Vec3 m = normalize3(add(wi, wo));
    Float cos_m = dot3(wi, m);
    // The last condition fails where the half vector of two grazing directions underflows.
    Int visible = (wi.z > 0.0f) & (wo.z > 0.0f) & (cos_m > 0.0f);
    // Density of normals times the Jacobian 1 / (4 wo . m) of the half vector, whose cosine cancels.
    Float density = 0.25f * microfacet_density(l.microfacets, m);
    Masking g = microfacet_masking(l.microfacets, wi, wo);
    Rgb fresnel = fresnel_conductor_rgb(cos_m, l.eta, l.k);
    return lobe_value_where(visible, scale(mul(l.specular, fresnel), density * g.both), density * g.visible);
}

INLINE Vec3 rough_conductor_sample(RoughConductorLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    Vec3 m = sample_visible_normal(l.microfacets, wi, u1, u2);
    Vec3 wo = scale_add(m, 2.0f * dot3(wi, m), negate(wi));
    return select3((wi.z > 0.0f) & (wo.z > 0.0f), wo, vec3_all(ZERO));
}

#endif
