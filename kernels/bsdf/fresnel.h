// Fresnel equations for unpolarized light at a smooth interface.
#ifndef WAVELOBE_BSDF_FRESNEL_H
#define WAVELOBE_BSDF_FRESNEL_H

#include "core/vector.h"

typedef struct {
    Float reflectance;
    Float transmittance; // 1 - reflectance, without its cancellation towards grazing incidence
    Float cos_t;         // of the refracted direction against the same normal, signed; 0 under total reflection
    Float eta_it;        // index behind the interface over index before it, seen from the incident side
    Float eta_ti;        // its reciprocal: scales the tangential part of a refracted direction
} DielectricFresnel;

// `eta` is the index below the surface (cos_i < 0) over the index above it.
//
// With C the cosine above the interface and G = eta times the cosine below it, Snell's law reads G^2 - C^2 = eta^2 - 1,
// and the amplitudes of both polarizations follow without differences of nearly equal numbers:
//   r_s = (1 - eta^2) / (C + G)^2
//   r_p = (eta^2 - 1) (eta^2 C^2 - (1 - C^2)) / (eta^2 C + G)^2
// Born, Wolf 1999, "Principles of Optics", section 1.5.2, rationalized.
INLINE DielectricFresnel fresnel_dielectric(Float cos_i, Float eta) {
    Int above = cos_i >= 0.0f;
    Float inverse_eta = 1.0f / eta;
    Float eta_squared = eta * eta;
    Float contrast = (eta - 1.0f) * (eta + 1.0f); // eta^2 - 1

    Float c = fabs(cos_i);
    Float cos_squared = c * c;
    Float sin_squared = (1.0f - c) * (1.0f + c);
    Float known = SELECT(above, c, eta * c);
    // By Snell's law from the sine or from the cosine, whichever is small.
    Float of_sine = SELECT(above, eta_squared - sin_squared, madd(-eta_squared, sin_squared, ONE));
    Float of_cosine = difference_of_products(known, known, SELECT(above, 1.0f - eta, eta - 1.0f), eta + 1.0f);
    Float other_squared = SELECT(cos_squared > 0.5f, of_sine, of_cosine);
    Int refracts = other_squared > 0.0f;
    Float other = sqrt(SELECT(refracts, other_squared, ZERO));
    Float C = SELECT(above, known, other);
    Float G = SELECT(above, other, known);

    Float sum_s = C + G;
    Float sum_p = madd(eta_squared, C, G);
    Float squared_s = sum_s * sum_s;
    Float squared_p = sum_p * sum_p;
    Float inverse = 1.0f / (squared_s * squared_p);
    Float over_s = inverse * squared_p;
    Float over_p = inverse * squared_s;
    Float r_s = contrast * over_s;
    // eta^2 C^2 - (1 - C^2), from below in terms of the cosine there.
    Float brewster = SELECT(above, madd(eta_squared, cos_squared, -sin_squared),
                            eta_squared * madd(-eta_squared, sin_squared, cos_squared));
    Float r_p = contrast * brewster * over_p;
    Float reflectance = LESSER(0.5f * madd(r_s, r_s, r_p * r_p), ONE);
    Float transmittance = LESSER(2.0f * C * G * madd(eta_squared, over_p, over_s), ONE);

    // Matched indices: the formulas are 0 / 0 at grazing incidence.
    Int matched = contrast == 0.0f;
    DielectricFresnel f;
    f.reflectance = SELECT(matched, ZERO, SELECT(refracts, reflectance, ONE));
    f.transmittance = SELECT(matched, ONE, SELECT(refracts, transmittance, ZERO));
    Float cos_t = SELECT(above, -(G * inverse_eta), C);
    f.cos_t = SELECT(matched, -cos_i, SELECT(refracts, cos_t, ZERO));
    f.eta_it = SELECT(above, eta, inverse_eta);
    f.eta_ti = SELECT(above, inverse_eta, eta);
    return f;
}

// Reflectance of a conductor with complex index eta + i k relative to the medium above it; cos_i >= 0.
//
// With (a + i b)^2 = (eta + i k)^2 - sin^2 (Born, Wolf 1999, "Principles of Optics", section 14.2):
//   R_s = ((a - cos)^2 + b^2) / ((a + cos)^2 + b^2)
//   R_p = R_s (t - 2 a cos sin^2) / (t + 2 a cos sin^2),  t = (a^2 + b^2) cos^2 + sin^4
// and a - cos = (eta^2 - 1 - k^2 + b^2) / (a + cos), which keeps its digits where the two are close.
INLINE Float fresnel_conductor(Float cos_i, Float eta, Float k) {
    Float c = LESSER(cos_i, ONE);
    Float cos_squared = c * c;
    Float sin_squared = (1.0f - c) * (1.0f + c);
    Float contrast = difference_of_products(eta - 1.0f, eta + 1.0f, k, k); // eta^2 - 1 - k^2
    // eta^2 - k^2 - sin^2, the small one of sine and cosine subtracted or added.
    Float real = SELECT(cos_squared > 0.5f, difference_of_products(eta, eta, k, k) - sin_squared, cos_squared + contrast);
    Float half_imaginary = eta * k;
    Float modulus = sqrt(madd(real, real, 4.0f * half_imaginary * half_imaginary)); // a^2 + b^2

    // The larger of a and b has no cancellation, the other follows from a b = eta k.
    Float larger = sqrt(0.5f * (modulus + fabs(real)));
    Float smaller = SELECT(larger > 0.0f, half_imaginary / larger, ZERO);
    Float a = SELECT(real >= 0.0f, larger, smaller);
    Float b = SELECT(real >= 0.0f, smaller, larger);

    Float b_squared = b * b;
    Float sum = a + c;
    Float difference = a - c;
    difference = SELECT(fabs(difference) > 0.5f * c, difference, madd(b, b, contrast) / GREATER(sum, (Float)1e-30f));
    Float t = madd(modulus, cos_squared, sin_squared * sin_squared);
    Float numerator = madd(difference, difference, b_squared) * t;
    Float denominator = madd(sum, sum, b_squared) * madd(2.0f * a * c, sin_squared, t);
    // The denominator vanishes only where a vanishing index meets normal incidence: all is reflected there.
    return SELECT(denominator > 0.0f, LESSER(numerator / denominator, ONE), ONE);
}

INLINE Rgb fresnel_conductor_rgb(Float cos_i, Rgb eta, Rgb k) {
    return vec3(fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
                fresnel_conductor(cos_i, eta.z, k.z));
}

INLINE Vec3 mirror_direction(Vec3 wi) { return vec3(-wi.x, -wi.y, wi.z); }

// (1 - |cos|)^5: Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering".
INLINE Float schlick_weight(Float cosine) {
    Float x = GREATER(1.0f - fabs(cosine), ZERO);
    Float square = x * x;
    return square * square * x;
}

// Its complement for a cosine in [0, 1], without a difference of nearly equal numbers towards grazing incidence.
INLINE Float schlick_rest(Float c) {
    return c * madd(c, madd(c, madd(c, c - 5.0f, (Float)10.0f), (Float)-10.0f), (Float)5.0f);
}

#endif
