// The specular part of the principled material: reflection off dielectric and metal, refraction, and a clear coat.
#ifndef WAVELOBE_BSDF_PRINCIPLED_H
#define WAVELOBE_BSDF_PRINCIPLED_H

#include "bsdf/principled_parameters.h"

typedef struct {
    Rgb base;
    Float eta; // below the surface over above it
    Float metallic, spec_tint, refracting; // refracting: share of what is not metal
    Float coat, coat_alpha;
    Microfacets microfacets;
} PrincipledLobe;

INLINE PrincipledLobe principled_load(MaterialInput in) {
    PrincipledLobe l;
    l.base = load_rgb(in, diffuse);
    l.eta = load_constant(in, eta.x);
    l.metallic = load_float(in, metallic);
    l.spec_tint = load_principled_float(in, spec_tint);
    l.refracting = (1.0f - l.metallic) * load_principled_float(in, spec_trans);
    l.coat = 0.25f * load_principled_float(in, clearcoat);
    l.coat_alpha = mix_float((Float)0.1f, (Float)0.001f, load_principled_float(in, clearcoat_gloss));
    l.microfacets = principled_microfacets(load_float(in, alpha_u), load_principled_float(in, anisotropic));
    return l;
}

// Of microfacets seen from above; `dielectric` is their Fresnel reflectance.
INLINE Rgb principled_fresnel(PrincipledLobe l, Float cos_i, Float dielectric) {
    Float weight = interface_schlick_weight(cos_i, l.eta);
    Float rest = 1.0f - l.metallic;
    Rgb metal = mix_rgb(l.base, vec3_all(ONE), weight);
    Rgb tinted = mix_rgb(scale(tint_of(l.base), normal_reflectance(l.eta)), vec3_all(ONE), weight);
    Rgb other = scale(tinted, rest * l.spec_tint);
    return add(scale(metal, l.metallic), add(other, vec3_all(rest * (1.0f - l.spec_tint) * dielectric)));
}

INLINE Float principled_weight(PrincipledLobe l, Vec3 wi) {
    Float dielectric = fresnel_dielectric(fabs(wi.z), l.eta).reflectance;
    Float above = max_component(principled_fresnel(l, fabs(wi.z), dielectric)) + l.refracting * (1.0f - dielectric) + l.coat;
    return SELECT(wi.z > 0.0f, above, SELECT(l.refracting > 0.0f, ONE, ZERO));
}

// The coat's share of samples; there is none from below.
INLINE Float coat_share(PrincipledLobe l, Vec3 wi) { return SELECT(wi.z > 0.0f, l.coat / (1.0f + l.coat), ZERO); }

// Of those that meet a microfacet, the shares that are reflected and refracted; both keep their digits where they are small.
INLINE Float reflected_share(PrincipledLobe l, Vec3 wi, DielectricFresnel f) {
    return SELECT(wi.z > 0.0f, madd(l.refracting, f.reflectance, 1.0f - l.refracting), f.reflectance);
}
INLINE Float refracted_share(PrincipledLobe l, Vec3 wi, DielectricFresnel f) {
    return SELECT(wi.z > 0.0f, l.refracting, ONE) * f.transmittance;
}

// Normals of the coat follow 1 / (sin^2 + alpha^2 cos^2) (Burley's generalized Trowbridge-Reitz of exponent 1).
INLINE Float coat_density(Float alpha, Vec3 m) {
    Float square = alpha * alpha;
    Float sin_squared = madd(m.x, m.x, m.y * m.y);
    return (square - 1.0f) / (PI_F * lane_log(square) * madd(square, m.z * m.z, sin_squared));
}

INLINE Float coat_masking(Vec3 v) {
    Float square = v.z * v.z;
    return 2.0f * v.z / (v.z + sqrt(madd((Float)0.0625f, 1.0f - square, square)));
}

INLINE Vec3 turn_above(Vec3 v) { return select3(v.z < 0.0f, negate(v), v); }

INLINE LobeValue principled_eval(PrincipledLobe l, Vec3 wi, Vec3 wo) {
    Int above = wi.z > 0.0f;
    Int reflects = above == (wo.z > 0.0f);
    // The half vector of reflection or refraction, in which the direction below weighs eta.
    Vec3 outer = select3(above, wi, wo);
    Vec3 inner = select3(above, wo, wi);
    Vec3 h = turn_above(scale_add(inner, SELECT(reflects, ONE, l.eta), outer));
    Float inverse_length = 1.0f / sqrt(length_squared(h));
    Vec3 m = scale(h, inverse_length);
    Float cos_i = dot3(wi, m), cos_o = dot3(wo, m);
    Int valid = (wi.z != 0.0f) & (wo.z != 0.0f) & (above | (l.refracting > 0.0f)) & (cos_i * wi.z > 0.0f) & (cos_o * wo.z > 0.0f);

    DielectricFresnel f = fresnel_dielectric(cos_i, l.eta);
    Float density = microfacet_density(l.microfacets, m);
    Masking g = microfacet_masking(l.microfacets, turn_above(wi), turn_above(wo));
    // As of a rough dielectric, whose reflectance the principled one takes the place of.
    Rgb reflectance = select3(above, principled_fresnel(l, cos_i, f.reflectance), vec3_all(l.refracting * f.reflectance));
    reflectance = select3(f.reflectance > 0.0f, reflectance, vec3_all(ZERO));
    Float transmittance = l.refracting * f.transmittance;
    Rgb transmitted = scale(vec3(sqrt(l.base.x), sqrt(l.base.y), sqrt(l.base.z)), transmittance);
    Float jacobian = SELECT(reflects, (Float)0.25f, fabs(cos_i * cos_o) * inverse_length * inverse_length);
    Float eta_squared = l.eta * l.eta;
    Float common = density * jacobian;
    Rgb value = scale(select3(reflects, reflectance, transmitted), common * g.both * SELECT(reflects | above, ONE, eta_squared));
    Float chance = SELECT(reflects, reflected_share(l, wi, f), refracted_share(l, wi, f));
    Float share = coat_share(l, wi);
    Float pdf = (1.0f - share) * common * g.visible * chance * SELECT(reflects | !above, ONE, eta_squared);

    Int coated = above & reflects & (l.coat > 0.0f);
    if (any_lane(coated)) {
        Float coat = coat_density(l.coat_alpha, m);
        Float fresnel = mix_float((Float)0.04f, ONE, interface_schlick_weight(cos_i, l.eta));
        Float coating = l.coat * fresnel * coat * coat_masking(wi) * coat_masking(wo) * wo.z;
        value = select3(coated, add(value, vec3_all(coating)), value);
        pdf = SELECT(coated, madd(share, 0.25f * coat * m.z / cos_o, pdf), pdf);
    }
    return lobe_value_where(valid, value, pdf);
}

INLINE Vec3 principled_sample(PrincipledLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    Float share = coat_share(l, wi);
    Int coated = u3 < share;
    Vec3 m = sample_visible_normal(l.microfacets, turn_above(wi), u1, u2);
    if (any_lane(coated)) {
        Float square = l.coat_alpha * l.coat_alpha;
        Float power = lane_exp((1.0f - u2) * lane_log(square));
        Float inverse = 1.0f / (1.0f - square);
        Float sine = sqrt(GREATER(power - square, ZERO) * inverse);
        Float s, c;
        lane_sin_cos_turns(u1, &s, &c);
        m = select3(coated, vec3(sine * c, sine * s, sqrt((1.0f - power) * inverse)), m);
    }
    Float cos_i = dot3(wi, m);
    DielectricFresnel f = fresnel_dielectric(cos_i, l.eta);
    Int reflects = coated | (1.0f - u3 > (1.0f - share) * refracted_share(l, wi, f));
    Vec3 reflected = scale_add(m, 2.0f * cos_i, negate(wi));
    Vec3 refracted = scale_add(m, madd(cos_i, f.eta_ti, f.cos_t), scale(wi, -f.eta_ti));
    Vec3 wo = select3(reflects, reflected, refracted);
    // Light that a single microfacet sends through the surface the wrong way is lost, as is all from behind what is opaque.
    Float side = wi.z * wo.z;
    Int valid = (SELECT(reflects, side, -side) > 0.0f) & (cos_i * wi.z > 0.0f) & ((wi.z > 0.0f) | (l.refracting > 0.0f));
    return select3(valid, wo, vec3_all(ZERO));
}

#endif
