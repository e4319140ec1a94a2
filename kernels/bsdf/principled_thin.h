// The specular part of the thin principled material: reflection, and transmission that does not bend. Both sides are alike.
#ifndef WAVELOBE_BSDF_PRINCIPLED_THIN_H
#define WAVELOBE_BSDF_PRINCIPLED_THIN_H

#include "bsdf/principled_parameters.h"

typedef struct {
    Rgb base;
    Float eta, spec_trans, spec_tint;
    Microfacets reflecting, transmitting;
} PrincipledThinLobe;

INLINE PrincipledThinLobe principled_thin_load(MaterialInput in) {
    PrincipledThinLobe l;
    l.base = load_rgb(in, diffuse);
    l.eta = load_principled_float(in, eta);
    l.spec_trans = load_principled_float(in, spec_trans);
    l.spec_tint = load_principled_float(in, spec_tint);
    Float roughness = load_float(in, alpha_u), anisotropic = load_principled_float(in, anisotropic);
    l.reflecting = principled_microfacets(roughness, anisotropic);
    // Burley 2015, figure 15: light that does not bend spreads less.
    l.transmitting = principled_microfacets(madd(l.eta, (Float)0.65f, (Float)-0.35f) * roughness, anisotropic);
    return l;
}

INLINE Float principled_thin_weight(PrincipledThinLobe l, Vec3 wi) { return l.spec_trans; }

INLINE Microfacets microfacets_of_side(PrincipledThinLobe l, Int reflects) {
    Microfacets d = {SELECT(reflects, l.reflecting.alpha_u, l.transmitting.alpha_u),
                     SELECT(reflects, l.reflecting.alpha_v, l.transmitting.alpha_v), !TRUE_MASK};
    return d;
}

// Seen from above.
INLINE Vec3 on_upper_side(Vec3 wi, Vec3 v) { return select3(wi.z < 0.0f, negate(v), v); }

INLINE LobeValue principled_thin_eval(PrincipledThinLobe l, Vec3 wi, Vec3 wo) {
    wo = on_upper_side(wi, wo);
    wi = on_upper_side(wi, wi);
    Int reflects = wo.z > 0.0f;
    Vec3 folded = vec3(wo.x, wo.y, fabs(wo.z));
    Microfacets d = microfacets_of_side(l, reflects);
    Vec3 m = normalize3(add(wi, folded));
    Float cos_m = dot3(wi, m);
    // Transmission behind the microfacet only.
    Int valid = (wi.z > 0.0f) & (wo.z != 0.0f) & (cos_m > 0.0f) & (reflects | (dot3(wo, m) < 0.0f));
    DielectricFresnel f = fresnel_dielectric(cos_m, l.eta);
    Rgb tinted = mix_rgb(scale(tint_of(l.base), normal_reflectance(l.eta)), vec3_all(ONE), interface_schlick_weight(cos_m, l.eta));
    Rgb reflectance = mix_rgb(vec3_all(f.reflectance), tinted, l.spec_tint);
    Rgb color = select3(reflects, reflectance, scale(l.base, f.transmittance));
    Float density = 0.25f * microfacet_density(d, m);
    Masking g = microfacet_masking(d, wi, folded);
    return lobe_value_where(valid, scale(color, l.spec_trans * density * g.both), 0.5f * density * g.visible);
}

INLINE Vec3 principled_thin_sample(PrincipledThinLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    Int reflects = u3 < 0.5f;
    Vec3 upper = on_upper_side(wi, wi);
    Vec3 m = sample_visible_normal(microfacets_of_side(l, reflects), upper, u1, u2);
    Vec3 wo = scale_add(m, 2.0f * dot3(upper, m), negate(upper));
    Int valid = (wo.z > 0.0f) & (wi.z != 0.0f);
    wo.z = SELECT(reflects, wo.z, -wo.z);
    valid &= reflects | (dot3(wo, m) < 0.0f);
    return select3(valid, on_upper_side(wi, wo), vec3_all(ZERO));
}

#endif
