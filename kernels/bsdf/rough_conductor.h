// A rough conductor: reflection off microfacets.
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
    MicrofacetReflection r = microfacet_reflection(l.microfacets, wi, wo);
    Rgb fresnel = fresnel_conductor_rgb(r.cos_m, l.eta, l.k);
    return lobe_value_where(r.visible, scale(mul(l.specular, fresnel), r.value), r.pdf);
}

INLINE Vec3 rough_conductor_sample(RoughConductorLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    return sample_microfacet_reflection(l.microfacets, wi, u1, u2);
}

#endif
