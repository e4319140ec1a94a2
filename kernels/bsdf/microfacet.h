// Microfacet surfaces: distribution of normals, Smith masking, sampling of visible normals.
//
// Directions and normals are unit and above the surface (z > 0; callers turn them over). GGX: Trowbridge, Reitz 1975,
// "Average irregularity representation of a rough surface for ray reflection", and Walter et al. 2007, "Microfacet Models
// for Refraction through Rough Surfaces". Beckmann, Spizzichino 1963. Both anisotropic: Heitz 2014, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs".
#ifndef WAVELOBE_BSDF_MICROFACET_H
#define WAVELOBE_BSDF_MICROFACET_H

#include "bsdf/lobe.h"
#include "core/erf.h"
#include "core/rounding.h"

// Which distributions the scene holds.
#ifndef HAS_GGX
#define HAS_GGX 1
#endif
#ifndef HAS_BECKMANN
#define HAS_BECKMANN 1
#endif

// Smoother surfaces than this have lobes below the resolution of a float direction; Mitsuba 3 stops at the same slope.
#define MIN_ALPHA 1e-4f

typedef struct {
    Float alpha_u, alpha_v; // root mean square slope, times sqrt(2) for Beckmann
    Int beckmann;
} Microfacets;

INLINE Microfacets load_microfacets(MaterialInput in) {
    Microfacets d;
    d.alpha_u = GREATER(load_float(in, alpha_u), (Float)MIN_ALPHA);
    d.alpha_v = GREATER(load_float(in, alpha_v), (Float)MIN_ALPHA);
    d.beckmann = (load_flags(in) & (UInt)MATERIAL_BECKMANN) != (UInt)0u;
    return d;
}

// Length of the direction's horizontal part after stretching the surface to unit roughness.
INLINE Float stretched_sine(Microfacets d, Vec3 v) {
    Float x = d.alpha_u * v.x;
    Float y = d.alpha_v * v.y;
    return sqrt(madd(x, x, y * y));
}

// Area of microfacets with normals about m, over surface area and solid angle.
INLINE Float microfacet_density(Microfacets d, Vec3 m) {
    Float x = m.x / d.alpha_u;
    Float y = m.y / d.alpha_v;
    Float horizontal = madd(x, x, y * y);
    Float cos_squared = m.z * m.z;
    Float area = PI_F * d.alpha_u * d.alpha_v;
    Float density = ZERO;
#if HAS_GGX
    if (any_lane(!d.beckmann)) {
        Float s = horizontal + cos_squared;
        density = 1.0f / (area * s * s);
    }
#endif
#if HAS_BECKMANN
    if (any_lane(d.beckmann)) {
        // Where the bound acts the exponential is zero for every roughness below 10^7; the bound's square is finite.
        Float inverse = LESSER(1.0f / cos_squared, (Float)1e18f);
        Float beckmann = lane_exp(-horizontal * inverse) * inverse * inverse / area;
        density = SELECT(d.beckmann, beckmann, density);
    }
#endif
    return density;
}

// Masking of the incident direction, and of both, over the incident cosine: finite at the horizon.
typedef struct {
    Float visible; // G1(wi) / cos wi, exact: it normalizes the density of visible normals
    Float both;    // G1(wi) G1(wo) / cos wi
} Masking;

// G1(v) / cos v of Beckmann by the rational fit of Walter et al. 2007 (relative error below 0.0035).
INLINE Float beckmann_masking_over_cos(Float stretched, Float cosine) {
    Int unmasked = cosine >= 1.6f * stretched;
    Float numerator = madd((Float)3.535f, stretched, 2.181f * cosine);
    Float denominator = madd(stretched, madd((Float)2.276f, cosine, stretched), 2.577f * cosine * cosine);
    return SELECT(unmasked, ONE, numerator) / SELECT(unmasked, cosine, denominator);
}

INLINE Masking microfacet_masking(Microfacets d, Vec3 wi, Vec3 wo) {
    Float stretched_i = stretched_sine(d, wi);
    Float stretched_o = stretched_sine(d, wo);
    Masking g = {ZERO, ZERO};
#if HAS_GGX
    if (any_lane(!d.beckmann)) {
        // G1(v) = 2 cos / (cos + length of the stretched direction)
        Float sum_i = wi.z + sqrt(madd(wi.z, wi.z, stretched_i * stretched_i));
        Float sum_o = wo.z + sqrt(madd(wo.z, wo.z, stretched_o * stretched_o));
        Float inverse = 2.0f / (sum_i * sum_o);
        g.visible = inverse * sum_o;
        g.both = 2.0f * inverse * wo.z;
    }
#endif
#if HAS_BECKMANN
    if (any_lane(d.beckmann)) {
        // erf(10) is one, and the exponential is zero
        Float cotangent = LESSER(wi.z / stretched_i, (Float)10.0f);
        Float visible_area = madd(wi.z, 1.0f + lane_erf(cotangent),
                                  INV_SQRT_PI_F * stretched_i * lane_exp(-cotangent * cotangent));
        Float both = beckmann_masking_over_cos(stretched_i, wi.z) * beckmann_masking_over_cos(stretched_o, wo.z) * wo.z;
        g.visible = SELECT(d.beckmann, 2.0f / visible_area, g.visible);
        g.both = SELECT(d.beckmann, both, g.both);
    }
#endif
    return g;
}

// Dupuy, Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
INLINE Vec3 sample_visible_ggx(Microfacets d, Vec3 wi, Float u1, Float u2) {
    Vec3 w = normalize3(vec3(d.alpha_u * wi.x, d.alpha_v * wi.y, wi.z));
    Float s, c;
    lane_sin_cos_turns(u1, &s, &c);
    // The cap point has height 1 - drop, above -w.z; the half vector's height is their sum.
    Float drop = u2 * (1.0f + w.z);
    Float sine = sqrt(drop * (2.0f - drop));
    Float height = (1.0f - u2) * (1.0f + w.z);
    return normalize3(vec3(d.alpha_u * madd(sine, c, w.x), d.alpha_v * madd(sine, s, w.y), height));
}

// Slopes of visible normals of Beckmann at unit roughness, by inversion: Heitz, d'Eon 2014, "Importance Sampling
// Microfacet-Based BSDFs using the Distribution of Visible Normals". The slope x towards the viewer has the density
// (cos - x sin) exp(-x^2), so y = erf(x) solves
//   cos (1 + y) + sin exp(-x^2) / sqrt(pi) = u (cos (1 + erf(cot)) + sin exp(-cot^2) / sqrt(pi)),  x <= cot
// by Halley steps from the solution at grazing incidence (Jakob 2014, "An Improved Visible Normal Sampling Routine for the
// Beckmann Distribution"). Three reach rounding error (3e-7 in u) for all angles.
INLINE Vec3 sample_visible_beckmann(Microfacets d, Vec3 wi, Float u1, Float u2) {
    Float lowest = (Float)(HALF_ULP - 1.0f); // bounds of y: erf of the largest slopes told from infinity
    Float x_stretched = d.alpha_u * wi.x;
    Float y_stretched = d.alpha_v * wi.y;
    Float stretched = stretched_sine(d, wi);
    Float inverse_length = 1.0f / sqrt(madd(stretched, stretched, wi.z * wi.z));
    Float cosine = wi.z * inverse_length;
    Float sine = stretched * inverse_length;

    Float cotangent = LESSER(wi.z / stretched, (Float)10.0f);
    Float erf_cot = lane_erf(cotangent);
    Float highest = LESSER(erf_cot, -lowest);
    Float sine_over_root = sine * INV_SQRT_PI_F;
    Float u = GREATER(u1, (Float)HALF_ULP);
    Float target = u * madd(cosine, 1.0f + erf_cot, sine_over_root * lane_exp(-cotangent * cotangent));
    Float y = erf_cot - (1.0f + erf_cot) * lane_erf(sqrt(-lane_log(u)));
    Float slope, exponential, previous;
#pragma unroll
    for (int step = 0; step < 3; ++step) {
        previous = LESSER(GREATER(y, lowest), highest);
        slope = lane_erf_inverse(previous);
        exponential = lane_exp(-slope * slope);
        Float value = madd(cosine, 1.0f + previous, madd(sine_over_root, exponential, -target));
        // The derivative vanishes at the largest slope, where the bound on y stops the step.
        Float derivative = GREATER(madd(-slope, sine, cosine), sine * (2.0f * HALF_ULP));
        // Halley's, times the exponential; the second derivative is -sine sqrt(pi) / (2 exponential). A step twice as long
        // as Newton's is not trusted.
        Float scaled = derivative * exponential;
        Float denominator = madd(scaled, derivative, 0.25f * SQRT_PI_F * sine * value);
        y = previous - value * scaled / GREATER(denominator, 0.5f * scaled * derivative);
    }
    // The last step is short: erf_inverse by its Taylor polynomial.
    Float change = (0.5f * SQRT_PI_F) * (LESSER(GREATER(y, lowest), highest) - previous) / exponential;
    Float third = madd(slope * slope, (Float)(4.0f / 3.0f), (Float)(1.0f / 3.0f));
    slope = madd(change, madd(change, madd(change, third, slope), ONE), slope);
    Float across = lane_erf_inverse(LESSER(GREATER(madd((Float)2.0f, u2, (Float)-1.0f), lowest), -lowest));

    // Back to the direction of the viewer; straight above any will do.
    Int tilted = stretched > 0.0f;
    Float inverse_stretched = 1.0f / SELECT(tilted, stretched, ONE);
    Float c = SELECT(tilted, x_stretched * inverse_stretched, ONE);
    Float s = y_stretched * inverse_stretched;
    return normalize3(vec3(-d.alpha_u * difference_of_products(c, slope, s, across),
                           -d.alpha_v * madd(s, slope, c * across), ONE));
}

// A normal seen from wi, with density G1(wi) / cos wi * max(0, wi . m) * microfacet_density(m).
INLINE Vec3 sample_visible_normal(Microfacets d, Vec3 wi, Float u1, Float u2) {
    Vec3 m = vec3(ZERO, ZERO, ONE);
#if HAS_GGX
    if (any_lane(!d.beckmann)) m = sample_visible_ggx(d, wi, u1, u2);
#endif
#if HAS_BECKMANN
    if (any_lane(d.beckmann)) m = select3(d.beckmann, sample_visible_beckmann(d, wi, u1, u2), m);
#endif
    return m;
}

// ---- reflection off microfacets. Cook, Torrance 1982, "A Reflectance Model for Computer Graphics" ----------------------

typedef struct {
    Int visible;  // otherwise the lobe is zero
    Float cos_m;  // between either direction and the microfacets that reflect
    Float value;  // BSDF times |cos wo| of perfectly reflecting microfacets
    Float pdf;    // of sample_microfacet_reflection
} MicrofacetReflection;

INLINE MicrofacetReflection microfacet_reflection(Microfacets d, Vec3 wi, Vec3 wo) {
    MicrofacetReflection r;
    Vec3 m = normalize3(add(wi, wo));
    r.cos_m = dot3(wi, m);
    // The last condition fails where the half vector of two grazing directions underflows.
    r.visible = (wi.z > 0.0f) & (wo.z > 0.0f) & (r.cos_m > 0.0f);
    // Density of normals times the Jacobian 1 / (4 wo . m) of the half vector, whose cosine cancels.
    Float density = 0.25f * microfacet_density(d, m);
    Masking g = microfacet_masking(d, wi, wo);
    r.value = density * g.both;
    r.pdf = density * g.visible;
    return r;
}

INLINE Vec3 sample_microfacet_reflection(Microfacets d, Vec3 wi, Float u1, Float u2) {
    Vec3 m = sample_visible_normal(d, wi, u1, u2);
    Vec3 wo = scale_add(m, 2.0f * dot3(wi, m), negate(wi));
    return select3((wi.z > 0.0f) & (wo.z > 0.0f), wo, vec3_all(ZERO));
}

#endif
