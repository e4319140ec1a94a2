// Transcendental functions on lanes: branch-free, because the built-in ones are a scalar call a lane.
//
// Method of all of them: argument reduction after Cody and Waite 1980, "Software Manual for the Elementary Functions",
// then a polynomial fitted to the reduced range for smallest largest relative error by Lawson's iteration (Lawson 1961)
// with its coefficients rounded to float one at a time, lowest first. Errors are the largest ones seen against double
// precision by tests/kernels/test_math.cpp, in units in the last place, with fused multiply-add or without. Denormal
// arguments count as zero where a comment says so; denormal results may be flushed to zero. NaN in gives NaN out.
#ifndef WAVELOBE_CORE_MATH_H
#define WAVELOBE_CORE_MATH_H

#include "core/lanes.h"

#define PI_F 3.14159265358979f
#define TWO_PI_F 6.28318530717959f
#define FOUR_PI_F 12.5663706143592f
#define HALF_PI_F 1.57079632679490f
#define QUARTER_PI_F 0.785398163397448f
#define INV_PI 0.318309886183791f
#define INV_TWO_PI_F 0.159154943091895f
#define INV_FOUR_PI_F 0.0795774715459477f
#define SQRT_PI_F 1.77245385090552f
#define INV_SQRT_PI_F 0.564189583547756f
#define SQRT_TWO_F 1.41421356237310f
#define LN_TWO_F 0.693147180559945f
#define BELOW_ONE 0x1.fffffep-1f // the largest float below one

// What float(pi / 2) lacks.
#define HALF_PI_REST_F -4.37113883e-8f
#define LOG2_E_F 1.44269502f
#define LOG2_E_REST_F 1.92596299e-8f

#define FLOAT_MIN_NORMAL 1.17549435e-38f
#define LANE_NAN as_Float((UInt)0x7fc00000u)
#define LANE_INFINITY as_Float((UInt)0x7f800000u)

// One step of Horner's rule: p x + c.
INLINE Float horner(Float p, Float x, float c) { return madd(p, x, (Float)c); }

// |x| with the sign of s.
INLINE Float copy_sign(Float x, Float s) {
    return as_Float((as_UInt(x) & (UInt)0x7fffffffu) | (as_UInt(s) & (UInt)0x80000000u));
}

// 1.5 * 2^23: adding it rounds |x| < 2^22 to the nearest integer, which stands in the low bits of the sum.
#define ROUNDING_CONSTANT 12582912.0f

// ---- sine and cosine ---------------------------------------------------------------------------------------

// sin and cos of the angle r + q pi / 2 from those of r in [-pi/4, pi/4]; only the two low bits of q count.
INLINE void turn_by_quadrants(Float sin_r, Float cos_r, UInt q, Float *s, Float *c) {
    Int swapped = (q & (UInt)1u) != (UInt)0u;
    UInt sin_sign = (q & (UInt)2u) << 30;
    UInt cos_sign = ((q + (UInt)1u) & (UInt)2u) << 30;
    *s = as_Float(as_UInt(SELECT(swapped, cos_r, sin_r)) ^ sin_sign);
    *c = as_Float(as_UInt(SELECT(swapped, sin_r, cos_r)) ^ cos_sign);
}

// Sine and cosine of x radians. |x| <= 1e4: 1.7 ulp. Precision fades beyond; meaningless above 1e6.
INLINE void lane_sin_cos(Float x, Float *s, Float *c) {
    Float t = madd(x, (Float)(2.0f / PI_F), (Float)ROUNDING_CONSTANT);
    Float n = t - ROUNDING_CONSTANT;
    // pi / 2 in four parts; the first three have 11 bits so that their products with n are exact.
    Float r = madd(n, (Float)-1.5703125f, x);
    r = madd(n, (Float)-0.000483751296997f, r);
    Float r12 = r;
    r = madd(n, (Float)-7.54953362e-8f, r12);
    Float r_rest = madd(n, (Float)-2.56334415e-12f, madd(n, (Float)-7.54953362e-8f, r12 - r));
    Float z = r * r;
    Float p = horner((Float)-0.00019518286f, z, 0.00833218917f);
    p = horner(p, z, -0.166666552f);
    Float sin_r = madd(p, z * r, r_rest) + r;
    p = horner((Float)2.44323273e-05f, z, -0.00138873095f);
    p = horner(p, z, 0.0416666456f);
    Float cos_r = madd(p, z * z, -(r * r_rest)) + madd(z, (Float)-0.5f, ONE);
    turn_by_quadrants(sin_r, cos_r, as_UInt(t), s, c);
}

// Sine and cosine of the angle f pi / 2, |f| <= 1/2.
INLINE void sin_cos_of_quarters(Float f, Float *s, Float *c) {
    Float z = f * f;
    Float p = horner((Float)-0.00460251188f, z, 0.0796803609f);
    p = horner(p, z, -0.64596349f);
    p = horner(p, z, -4.8797947e-08f);
    *s = madd(p, f, f * HALF_PI_F);
    p = horner((Float)0.00089448638f, z, -0.0208555963f);
    p = horner(p, z, 0.253668547f);
    p = horner(p, z, -1.23370051f);
    *c = madd(p, z, ONE);
}

// Sine and cosine of the angle 2 pi u. |u| <= 4: 1.7 ulp; exact at multiples of a quarter. The reduction is exact up to
// |u| < 2^20.
INLINE void lane_sin_cos_turns(Float u, Float *s, Float *c) {
    Float t = madd(u, (Float)4.0f, (Float)ROUNDING_CONSTANT);
    Float sin_f, cos_f;
    sin_cos_of_quarters(madd(u, (Float)4.0f, -(t - ROUNDING_CONSTANT)), &sin_f, &cos_f);
    turn_by_quadrants(sin_f, cos_f, as_UInt(t), s, c);
}

// ---- exponentials ---------------------------------------------------------------------------------------------

// p 2^n, p in [0.7, 1.42], n in the low bits of t; 0 where x < lowest, infinity or NaN unless x < limit.
INLINE Float scale_exponential(Float p, Float t, Float x, float lowest, float limit) {
    Float y = as_Float(as_UInt(p) + (as_UInt(t) << 23));
    y = SELECT(x < lowest, ZERO, y);
    return SELECT(x < limit, y, x * LANE_INFINITY);
}

// 2^(x + rest) for a small correction `rest`.
INLINE Float exp2_of_sum(Float x, Float rest) {
    Float t = x + ROUNDING_CONSTANT;
    Float f = x - (t - ROUNDING_CONSTANT) + rest;
    Float p = horner((Float)0.000153264933f, f, 0.00133908121f);
    p = horner(p, f, 0.00961850584f);
    p = horner(p, f, 0.0555035993f);
    p = horner(p, f, 0.240226477f);
    p = horner(p, f, 0.693147182f);
    return scale_exponential(madd(p, f, ONE), t, x, -126.0f, 128.0f);
}

// 2^x. All x: 1.1 ulp; 0 below -126.
INLINE Float lane_exp2(Float x) { return exp2_of_sum(x, ZERO); }

// e^x. All x: 1.1 ulp; 0 below -87.336544, the logarithm of the smallest normal float.
INLINE Float lane_exp(Float x) {
    Float t = madd(x, (Float)LOG2_E_F, (Float)ROUNDING_CONSTANT);
    Float n = t - ROUNDING_CONSTANT;
    Float r = madd(n, (Float)-0.693359375f, x); // 10 bits of ln 2: exact
    r = madd(n, (Float)0.00021219444f, r);
    Float p = horner((Float)0.00138198258f, r, 0.00836868677f);
    p = horner(p, r, 0.0416682772f);
    p = horner(p, r, 0.166665211f);
    p = horner(p, r, 0.49999994f);
    p = madd(p, r * r, r) + ONE;
    return scale_exponential(p, t, x, -87.3365402f, 88.7228394f);
}

// ---- logarithms -----------------------------------------------------------------------------------------------

// x = 2^e m with m in [sqrt(1/2), sqrt(2)); returns m.
INLINE Float split_exponent(Float x, Float *e) {
    Int above = as_Int(as_UInt(x) - (UInt)0x3f3504f3u) >> 23;
    *e = convert_Float(above);
    return as_Float(as_UInt(x) - (as_UInt(above) << 23));
}

// A logarithm's special values: -infinity at zero and denormals, NaN below zero, infinity at infinity.
INLINE Float finish_logarithm(Float x, Float y) {
    y = SELECT(x < FLOAT_MIN_NORMAL, SELECT(x < 0.0f, LANE_NAN, -LANE_INFINITY), y);
    return SELECT(x < LANE_INFINITY, y, x);
}

// Logarithm to base 2. All x: 1.9 ulp; denormal x counts as zero.
INLINE Float lane_log2(Float x) {
    Float e;
    Float f = split_exponent(x, &e) - ONE;
    Float p = horner((Float)-0.109843455f, f, 0.186861113f);
    p = horner(p, f, -0.191440836f);
    p = horner(p, f, 0.204523593f);
    p = horner(p, f, -0.239565954f);
    p = horner(p, f, 0.28856954f);
    p = horner(p, f, -0.36069867f);
    p = horner(p, f, 0.480898231f);
    p = horner(p, f, -0.721347332f);
    p = horner(p, f, 1.92005558e-08f);
    return finish_logarithm(x, madd(f, (Float)LOG2_E_F, f * p) + e);
}

// Natural logarithm. All x: 0.9 ulp; denormal x counts as zero.
INLINE Float lane_log(Float x) {
    Float e;
    Float f = split_exponent(x, &e) - ONE;
    Float p = horner((Float)-0.0763643906f, f, 0.127622172f);
    p = horner(p, f, -0.131596103f);
    p = horner(p, f, 0.1420158f);
    p = horner(p, f, -0.166234091f);
    p = horner(p, f, 0.200012416f);
    p = horner(p, f, -0.250008196f);
    p = horner(p, f, 0.333333313f);
    Float z = f * f;
    Float y = madd(p, z * f, e * -0.00021219444f);
    y = madd(z, (Float)-0.5f, y) + f;
    return finish_logarithm(x, madd(e, (Float)0.693359375f, y));
}

// ---- power -----------------------------------------------------------------------------------------------------

// a b - p exactly, where p is the rounded product a b.
INLINE Float product_error(Float a, Float b, Float p) {
#ifdef __FMA__
    return madd(a, b, -p);
#else
    // Dekker 1971, "A Floating-Point Technique for Extending the Available Precision": factors cut into 12-bit halves.
    Float a1 = as_Float(as_UInt(a) & (UInt)0xfffff000u), a2 = a - a1;
    Float b1 = as_Float(as_UInt(b) & (UInt)0xfffff000u), b2 = b - b1;
    return ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
#endif
}

// log2(x) as the sum of the result and *rest, to 2^-34 of its size or of 1: m = c (1 + s) / (1 - s) with c one of three
// points of [sqrt(1/2), sqrt(2)), log m = log c + 2 artanh s.
INLINE Float log2_extended(Float x, Float *rest) {
    Float e;
    Float m = split_exponent(x, &e);
    Int low = m < 0.890625f, high = m > 1.125f;
    Float c = SELECT(low, (Float)0.79296875f, SELECT(high, (Float)1.26171875f, ONE));
    // log2(c) in two parts, the first a multiple of 2^-16 so that its sum with e is exact.
    e += SELECT(low, (Float)-0.3346710205078125f, SELECT(high, (Float)0.33538818359375f, ZERO));
    Float log_c_rest = SELECT(low, (Float)6.93769299e-06f, SELECT(high, (Float)2.17110017e-06f, ZERO));
    Float d = m + c;
    Float d_rest = m - (d - c);
    Float f = m - c;
    Float inverse = 1.0f / d;
    Float s = f * inverse;
    Float sd = s * d;
    Float s_rest = ((f - sd) - product_error(s, d, sd) - s * d_rest) * inverse;
    Float z = s * s;
    Float p = horner((Float)0.29055649f, z, 0.399980396f);
    p = horner(p, z, 0.666666687f);
    // ln(m / c) = 2 s + tail; times log2(e) in two parts; plus e.
    Float s2 = s + s;
    Float tail = madd(p, z * s, s_rest + s_rest);
    Float product = s2 * LOG2_E_F;
    Float error = product_error(s2, (Float)LOG2_E_F, product);
    error = madd(tail, (Float)LOG2_E_F, madd(s2, (Float)LOG2_E_REST_F, error)) + log_c_rest;
    Float sum = e + product;
    Float product_in_sum = sum - e;
    error += (e - (sum - product_in_sum)) + (product - product_in_sum);
    Float y = sum + error;
    *rest = error - (y - sum);
    return finish_logarithm(x, y);
}

// base^exponent, base >= 0 (below: NaN), any exponent: 1.5 ulp. x^0 = 1^y = 1 for all x and y, 0^y = 0 and
// 0^-y = infinity for y > 0. Denormal bases count as zero. Overflows a little early, from (1 - 2^-18) 2^128 on.
INLINE Float lane_pow(Float base, Float exponent) {
    Float rest;
    Float log_base = log2_extended(base, &rest);
    Float y = log_base * exponent;
    Float y_rest = madd(rest, exponent, product_error(log_base, exponent, y));
    Float power = exp2_of_sum(y, y_rest);
    return SELECT((exponent == 0.0f) | (base == 1.0f), ONE, power);
}

// ---- inverse trigonometric functions ----------------------------------------------------------------------------

// asin x - x for |x| <= 1/2, z = x^2.
INLINE Float asin_tail(Float x, Float z) {
    Float p = horner((Float)0.0421583056f, z, 0.0241847783f);
    p = horner(p, z, 0.0454691499f);
    p = horner(p, z, 0.0749530941f);
    p = horner(p, z, 0.166667521f);
    return p * (z * x);
}

// Arc sine in radians. |x| <= 1: 2.1 ulp; NaN outside. Beyond 1/2: asin x = pi/2 - 2 asin sqrt((1 - x) / 2).
INLINE Float lane_asin(Float x) {
    Float a = fabs(x);
    Int near_one = a > 0.5f;
    Float z = SELECT(near_one, madd(a, (Float)-0.5f, (Float)0.5f), a * a);
    Float r = SELECT(near_one, sqrt(z), a);
    Float tail = asin_tail(r, z);
    Float complement = madd(r, (Float)-2.0f, (Float)HALF_PI_F) - madd(tail, (Float)2.0f, (Float)-HALF_PI_REST_F);
    Float y = SELECT(near_one, complement, r + tail);
    return SELECT(y == y, copy_sign(y, x), y);
}

// Arc cosine in radians. |x| <= 1: 1.3 ulp; NaN outside.
INLINE Float lane_acos(Float x) {
    Float a = fabs(x);
    Int near_one = a > 0.5f;
    Float z = SELECT(near_one, madd(a, (Float)-0.5f, (Float)0.5f), a * a);
    Float r = SELECT(near_one, sqrt(z), x);
    Float y = r + asin_tail(r, z);
    Float twice = y + y;
    Float outer = SELECT(x < 0.0f, (2.0f * HALF_PI_F - twice) + 2.0f * HALF_PI_REST_F, twice);
    Float inner = HALF_PI_F - (y - HALF_PI_REST_F);
    return SELECT(near_one, outer, inner);
}

// Angle of (x, y) from the x axis, in [-pi, pi]: 1.6 ulp. Signed zeros and infinities as in C.
INLINE Float lane_atan2(Float y, Float x) {
    Float ax = fabs(x), ay = fabs(y);
    Int steep = ax < ay;
    Float greater = SELECT(steep, ay, ax);
    Float lesser = SELECT(steep, ax, ay);
    Float t = lesser / greater;
    t = SELECT(greater == 0.0f, ZERO, SELECT(lesser == LANE_INFINITY, ONE, t));
    Float z = t * t;
    Float p = horner((Float)0.00113452214f, z, -0.00742536318f);
    p = horner(p, z, 0.022777617f);
    p = horner(p, z, -0.0449832566f);
    p = horner(p, z, 0.0676364899f);
    p = horner(p, z, -0.0882146209f);
    p = horner(p, z, 0.110612333f);
    p = horner(p, z, -0.142803431f);
    p = horner(p, z, 0.199997157f);
    p = horner(p, z, -0.333333284f);
    Float angle = madd(p, z * t, t);
    angle = SELECT(steep, HALF_PI_F - (angle - HALF_PI_REST_F), angle);
    Float obtuse = 2.0f * HALF_PI_F - (angle - 2.0f * HALF_PI_REST_F);
    angle = SELECT(as_Int(x) < (Int)0, obtuse, angle);
    return SELECT((x == x) & (y == y), copy_sign(angle, y), LANE_NAN);
}

#include "core/erf.h"

#endif
