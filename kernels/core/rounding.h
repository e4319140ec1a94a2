// Rounding error bounds and ray origins that clear them: no fixed distance is ever added to a ray.
// Pharr, Jakob, Humphreys, "Physically Based Rendering", section "Managing Rounding Error".
#ifndef WAVELOBE_CORE_ROUNDING_H
#define WAVELOBE_CORE_ROUNDING_H

#include "core/vector.h"

#define HALF_ULP 5.9604644775390625e-8f // 2^-24: largest relative error of one rounding

// Bound on the relative error of n roundings in a row (Higham 2002, "Accuracy and Stability of Numerical Algorithms").
#define GAMMA(n) ((n) * HALF_ULP / (1.0f - (n) * HALF_ULP))

// Moves each coordinate one float further in the direction of `offset`.
INLINE Float round_along(Float x, Float offset) {
    Int grows = (x < 0.0f) == (offset < 0.0f); // the move goes away from zero
    UInt bits = as_UInt(x);
    UInt away = bits + (UInt)1u;
    UInt towards = SELECT((bits & (UInt)0x7fffffffu) == (UInt)0u, bits, bits - (UInt)1u);
    return SELECT(offset == 0.0f, x, as_Float(SELECT(grows, away, towards)));
}

// The origin of a ray that leaves `p` (known within +-error) on the side of the surface that `direction` points to.
// `normal` is the unit geometric normal, on either side.
INLINE Vec3 offset_ray_origin(Vec3 p, Vec3 error, Vec3 normal, Vec3 direction) {
    Float d = dot3(absolute(normal), error);
    d = SELECT(dot3(normal, direction) < 0.0f, -d, d);
    Vec3 offset = scale(normal, d);
    Vec3 o = add(p, offset);
    return vec3(round_along(o.x, offset.x), round_along(o.y, offset.y), round_along(o.z, offset.z));
}

#endif
