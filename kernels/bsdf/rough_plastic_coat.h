// The rough surface of plastic: what of it reflects. Its lower part is rough_plastic_base.
#ifndef WAVELOBE_BSDF_ROUGH_PLASTIC_COAT_H
#define WAVELOBE_BSDF_ROUGH_PLASTIC_COAT_H

#include "bsdf/fresnel.h"
#include "bsdf/microfacet.h"
#include "bsdf/rough_transmittance.h"

typedef struct {
    Rgb specular;
    Float eta, specular_weight;
    Microfacets microfacets;
    MaterialInput transmittance;
} RoughPlasticCoatLobe;

INLINE RoughPlasticCoatLobe rough_plastic_coat_load(MaterialInput in) {
    RoughPlasticCoatLobe l = {load_rgb(in, specular), load_constant(in, eta.x), load_constant(in, specular_weight),
                              load_microfacets(in), extension_of(in)};
    return l;
}

INLINE Float rough_plastic_coat_weight(RoughPlasticCoatLobe l, Vec3 wi) {
    return (1.0f - rough_transmittance(l.transmittance, wi.z)) * l.specular_weight;
}

INLINE LobeValue rough_plastic_coat_eval(RoughPlasticCoatLobe l, Vec3 wi, Vec3 wo) {
    MicrofacetReflection r = microfacet_reflection(l.microfacets, wi, wo);
    Float fresnel = fresnel_dielectric(r.cos_m, l.eta).reflectance;
    return lobe_value_where(r.visible, scale(l.specular, fresnel * r.value), r.pdf);
}

INLINE Vec3 rough_plastic_coat_sample(RoughPlasticCoatLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    return sample_microfacet_reflection(l.microfacets, wi, u1, u2);
}

#endif
