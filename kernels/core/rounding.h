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
    // Zero counts as on the side of the offset, so that it leaves it.
    UInt bits = SELECT(x == 0.0f, as_UInt(offset) & (UInt)0x80000000u, as_UInt(x));
    Int grows = (x == 0.0f) | ((x < 0.0f) == (offset < 0.0f)); // the move goes away from zero
    Float moved = as_Float(SELECT(grows, bits + (UInt)1u, bits - (UInt)1u));
    return SELECT(offset == 0.0f, x, moved);
}

// The origin of a ray that leaves `p` (known within +-error) on the side of the surface that `direction` points to.
// `normal` is the unit geometric normal, on either side.
INLINE Vec3 offset_ray_origin(Vec3 p, Vec3 error, Vec3 normal, Vec3 direction) {
    // Lengthened by its own three roundings, those of the offset, and what the normal may lack of unit length (squared).
    Float d = dot3(absolute(normal), error) * (1.0f + GAMMA(8));
    d = SELECT(dot3(normal, direction) < 0.0f, -d, d);
    Vec3 offset = scale(normal, d);
    Vec3 o = add(p, offset);
    return vec3(round_along(o.x, offset.x), round_along(o.y, offset.y), round_along(o.z, offset.z));
}

#endif
