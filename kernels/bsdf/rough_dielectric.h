// A rough interface between two dielectrics. Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces".
#ifndef WAVELOBE_BSDF_ROUGH_DIELECTRIC_H
#define WAVELOBE_BSDF_ROUGH_DIELECTRIC_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacet.h"

typedef struct {
    Rgb specular, transmission;
    Float eta; // below the surface over above it
    Microfacets microfacets;
} RoughDielectricLobe;

INLINE RoughDielectricLobe rough_dielectric_load(MaterialInput in) {
    RoughDielectricLobe l = {load_rgb(in, specular), load_rgb(in, transmission), load_constant(in, eta.x),
                             load_microfacets(in)};
    return l;
}

INLINE Float rough_dielectric_weight(RoughDielectricLobe l, Vec3 wi) { return ONE; }

INLINE Vec3 turn_up(Vec3 v) { return select3(v.z < 0.0f, negate(v), v); }

INLINE LobeValue rough_dielectric_eval(RoughDielectricLobe l, Vec3 wi, Vec3 wo) {
    Int above = wi.z > 0.0f;
    Int reflects = above == (wo.z > 0.0f);
    Int valid = (wi.z != 0.0f) & (wo.z != 0.0f);

    // The half vector, of reflection or refraction: the direction below weighs eta. It needs no reciprocal of eta, and one
    // rounding, which matters for narrow lobes.
    Vec3 outer = select3(above, wi, wo);
    Vec3 inner = select3(above, wo, wi);
    Vec3 h = turn_up(scale_add(inner, SELECT(reflects, ONE, l.eta), outer));
    Float squared_length = length_squared(h);
    Float inverse_length = 1.0f / sqrt(squared_length);
    Vec3 m = scale(h, inverse_length);
    Float cos_i = dot3(wi, m);
    Float cos_o = dot3(wo, m);
    valid = valid & (cos_i * wi.z > 0.0f) & (cos_o * wo.z > 0.0f);

    DielectricFresnel f = fresnel_dielectric(cos_i, l.eta);
    Float density = microfacet_density(l.microfacets, m);
    Masking g = microfacet_masking(l.microfacets, turn_up(wi), turn_up(wo));

    // Jacobian of the half vector times |wi . m|: 1/4, or eta_it^2 |wi . m| |wo . m| / |wi + eta_it wo|^2.
    Float eta_squared = l.eta * l.eta;
    Float refracted = fabs(cos_i * cos_o) * (inverse_length * inverse_length);
    Float common = density * SELECT(reflects, 0.25f * f.reflectance, refracted * f.transmittance);
    // Refracted radiance is divided by eta_it^2.
    Float pdf = common * g.visible * SELECT(reflects | !above, ONE, eta_squared);
    Float value = common * g.both * SELECT(reflects | above, ONE, eta_squared);
    return lobe_value_where(valid, scale(select3(reflects, l.specular, l.transmission), value), pdf);
}

INLINE Vec3 rough_dielectric_sample(RoughDielectricLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    Vec3 m = sample_visible_normal(l.microfacets, turn_up(wi), u1, u2);
    Float cos_i = dot3(wi, m);
    DielectricFresnel f = fresnel_dielectric(cos_i, l.eta);
    Int reflects = u3 < f.reflectance;
    Vec3 reflected = scale_add(m, 2.0f * cos_i, negate(wi));
    Vec3 refracted = scale_add(m, madd(cos_i, f.eta_ti, f.cos_t), scale(wi, -f.eta_ti));
    Vec3 wo = select3(reflects, reflected, refracted);
    // Light that a single microfacet sends through the surface the wrong way is lost.
    Float side = wi.z * wo.z;
    Int valid = SELECT(reflects, side, -side) > 0.0f;
    return select3(valid, wo, vec3_all(ZERO));
}

#endif
