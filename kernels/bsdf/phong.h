// The glossy part of the normalized Phong model. Lafortune, Willems 1994, "Using the Modified Phong Reflectance Model for
// Physically Based Rendering": f = specular (n + 2) / (2 pi) cos^n, of the angle between wo and the mirror direction.
#ifndef WAVELOBE_BSDF_PHONG_H
#define WAVELOBE_BSDF_PHONG_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

typedef struct {
    Rgb specular;
    Float exponent;
} PhongLobe;

INLINE PhongLobe phong_load(MaterialInput in) {
    PhongLobe l = {load_rgb(in, specular), load_float(in, exponent)};
    return l;
}

INLINE Float phong_weight(PhongLobe l, Vec3 wi) { return max_component(l.specular); }

// log(1 - x), accurate for small x too: high exponents magnify its relative error.
// Kahan's correction of the rounding in 1 - x (Higham 2002, "Accuracy and Stability of Numerical Algorithms", section 1.14).
INLINE Float log_one_minus(Float x) {
    Float w = 1.0f - x;
    Float rounded = 1.0f - w; // exact
    return SELECT(rounded == 0.0f, -x, lane_log(w) * (x / rounded));
}

// 1 - exp(x) for x <= 0
INLINE Float one_minus_exp(Float x) {
    // Taylor's series to x^8: the rest is below 2^-24 of the sum down to x = -0.6.
    Float series = ONE;
    series = madd(series, x * (1.0f / 8.0f), ONE);
    series = madd(series, x * (1.0f / 7.0f), ONE);
    series = madd(series, x * (1.0f / 6.0f), ONE);
    series = madd(series, x * (1.0f / 5.0f), ONE);
    series = madd(series, x * (1.0f / 4.0f), ONE);
    series = madd(series, x * (1.0f / 3.0f), ONE);
    series = madd(series, x * (1.0f / 2.0f), ONE);
    return SELECT(x > -0.6f, -x * series, 1.0f - lane_exp(x));
}

INLINE LobeValue phong_eval(PhongLobe l, Vec3 wi, Vec3 wo) {
    // The cosine by way of the chord: the product of directions would lose the lobe of a high exponent in rounding.
    Float one_minus_cos = 0.5f * length_squared(sub(wo, mirror_direction(wi)));
    Int inside = (wi.z > 0.0f) & (wo.z > 0.0f) & (one_minus_cos < 1.0f);
    Float power = lane_exp(l.exponent * log_one_minus(SELECT(inside, one_minus_cos, ZERO)));
    Float lobe = power * (0.5f * INV_PI);
    return lobe_value_where(inside, scale(l.specular, (l.exponent + 2.0f) * lobe * wo.z), (l.exponent + 1.0f) * lobe);
}

INLINE Vec3 phong_sample(PhongLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    // 1 - u1 is never zero.
    Float one_minus_cos = one_minus_exp(lane_log(1.0f - u1) / (l.exponent + 1.0f));
    Float radius = sqrt(one_minus_cos * (2.0f - one_minus_cos));
    Float s, c;
    lane_sin_cos_turns(u2, &s, &c);
    Vec3 wo = to_world(frame_of_normal(mirror_direction(wi)), vec3(radius * c, radius * s, 1.0f - one_minus_cos));
    return select3((wi.z > 0.0f) & (wo.z > 0.0f), wo, vec3_all(ZERO));
}

#endif
