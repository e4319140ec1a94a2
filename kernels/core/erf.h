// The error function and its inverse on lanes; method and measure of error as in core/math.h.
#ifndef WAVELOBE_CORE_ERF_H
#define WAVELOBE_CORE_ERF_H

#include "core/math.h"

// Error function. All x: 1.3 ulp. Below 1 a polynomial, beyond 1 - 2^Q(x).
INLINE Float lane_erf(Float x) {
    Float z = x * x;
    Float p = horner((Float)7.80690316e-05f, z, -0.00079978531f);
    p = horner(p, z, 0.0051871622f);
    p = horner(p, z, -0.0268533472f);
    p = horner(p, z, 0.112835787f);
    p = horner(p, z, -0.37612626f);
    p = horner(p, z, 0.128379166f);
    Float near_zero = madd(p, x, x);
    Float a = fabs(x);
    a = LESSER((Float)4.0f, a); // 1 - erf(4) is below half an ulp of 1
    Float q = horner((Float)0.000267737167f, a, -0.00424103299f);
    q = horner(q, a, 0.0314586423f);
    q = horner(q, a, -0.148651809f);
    q = horner(q, a, -0.920764804f);
    q = horner(q, a, -1.62597513f);
    q = horner(q, a, -0.000510308309f);
    Float far = copy_sign(ONE - lane_exp2(q), x);
    return SELECT(a < 1.0f, near_zero, SELECT(x == x, far, x));
}

// Inverse of the error function. |x| < 1: 3.5 ulp; infinity at 1, NaN beyond. Giles 2010, "Approximating the erfinv
// Function": x times a polynomial in w = -ln(1 - x^2), near 1 in sqrt(w).
INLINE Float lane_erf_inverse(Float x) {
    Float w = -lane_log((ONE - x) * (ONE + x));
    Float t = w - 2.5f;
    Float p = horner((Float)-8.23752977e-09f, t, 2.81904065e-08f);
    p = horner(p, t, 4.59958073e-07f);
    p = horner(p, t, -3.52366942e-06f);
    p = horner(p, t, -4.9435007e-06f);
    p = horner(p, t, 0.000218577217f);
    p = horner(p, t, -0.00125275564f);
    p = horner(p, t, -0.00417766813f);
    p = horner(p, t, 0.24664028f);
    p = horner(p, t, 1.50140941f);
    t = sqrt(w) - 3.0f;
    Float q = horner((Float)-0.000206755343f, t, 0.000101618316f);
    q = horner(q, t, 0.00136201014f);
    q = horner(q, t, -0.00367382169f);
    q = horner(q, t, 0.00573145365f);
    q = horner(q, t, -0.00762264337f);
    q = horner(q, t, 0.00944069959f);
    q = horner(q, t, 1.00167418f);
    q = horner(q, t, 2.83297682f);
    Float y = SELECT(w < 5.0f, p, q) * x;
    return SELECT(fabs(x) == 1.0f, x * LANE_INFINITY, y);
}

#endif
