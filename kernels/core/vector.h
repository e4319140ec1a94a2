// Three-vectors and orthonormal frames on lane types.  Colours are vectors too (x, y, z = red, green, blue).
#ifndef WAVELOBE_CORE_VECTOR_H
#define WAVELOBE_CORE_VECTOR_H

#include "core/lanes.h"

typedef struct {
    Float x, y, z;
} Vec3;

typedef Vec3 Rgb;

INLINE Vec3 vec3(Float x, Float y, Float z) {
    Vec3 v = {x, y, z};
    return v;
}

INLINE Vec3 vec3_all(Float a) { return vec3(a, a, a); }
INLINE Vec3 add(Vec3 a, Vec3 b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
INLINE Vec3 sub(Vec3 a, Vec3 b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
INLINE Vec3 mul(Vec3 a, Vec3 b) { return vec3(a.x * b.x, a.y * b.y, a.z * b.z); }
INLINE Vec3 scale(Vec3 a, Float s) { return vec3(a.x * s, a.y * s, a.z * s); }
INLINE Vec3 negate(Vec3 a) { return vec3(-a.x, -a.y, -a.z); }
// s * a + b
INLINE Vec3 scale_add(Vec3 a, Float s, Vec3 b) { return vec3(madd(a.x, s, b.x), madd(a.y, s, b.y), madd(a.z, s, b.z)); }
INLINE Vec3 absolute(Vec3 a) { return vec3(fabs(a.x), fabs(a.y), fabs(a.z)); }
INLINE Float dot3(Vec3 a, Vec3 b) { return madd(a.x, b.x, madd(a.y, b.y, a.z * b.z)); }
INLINE Float length_squared(Vec3 a) { return dot3(a, a); }
INLINE Float max_component(Vec3 a) { return GREATER(a.x, GREATER(a.y, a.z)); }
// Zero where all components are finite, NaN where one is not.
INLINE Float finiteness3(Vec3 a) { return madd(ZERO, a.x, madd(ZERO, a.y, ZERO * a.z)); }
INLINE Vec3 select3(Int mask, Vec3 a, Vec3 b) {
    return vec3(SELECT(mask, a.x, b.x), SELECT(mask, a.y, b.y), SELECT(mask, a.z, b.z));
}

// a.b - c.d with one rounding error where there is a fused multiply-add (Kahan's difference of products).
INLINE Float difference_of_products(Float a, Float b, Float c, Float d) {
    Float cd = c * d;
    return madd(a, b, -cd) + madd(-c, d, cd);
}

INLINE Vec3 cross3(Vec3 a, Vec3 b) {
    return vec3(difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
                difference_of_products(a.x, b.y, a.y, b.x));
}

INLINE Vec3 normalize3(Vec3 a) { return scale(a, 1.0f / sqrt(length_squared(a))); }

// Unit vector, also of vectors so short that their squares underflow.
INLINE Vec3 normalize_any_scale(Vec3 a) {
    Vec3 m = absolute(a);
    Float most = max_component(m);
    return normalize3(scale(a, 1.0f / most));
}

INLINE Float luminance(Rgb c) { return madd(c.x, (Float)0.212671f, madd(c.y, (Float)0.715160f, c.z * 0.072169f)); }

// s, t, n orthonormal and right-handed.
typedef struct {
    Vec3 s, t, n;
} Frame;

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
INLINE Frame frame_of_normal(Vec3 n) {
    Float sign = SELECT(n.z < 0.0f, (Float)-1.0f, ONE);
    Float a = -1.0f / (sign + n.z);
    Float b = n.x * n.y * a;
    Frame f;
    f.s = vec3(madd(sign * n.x * n.x, a, ONE), sign * b, -sign * n.x);
    f.t = vec3(b, madd(n.y * n.y, a, sign), -n.y);
    f.n = n;
    return f;
}

// Turns the frame's tangent to `along` as far as the normal allows.
INLINE Frame frame_along(Vec3 n, Vec3 along) {
    Vec3 s = scale_add(n, -dot3(n, along), along);
    Float square = length_squared(s);
    Frame fallback = frame_of_normal(n);
    Frame f;
    f.n = n;
    f.s = select3((square > 0.0f) & (square < INFINITY), scale(s, 1.0f / sqrt(square)), fallback.s);
    f.t = cross3(n, f.s);
    return f;
}

INLINE Vec3 to_local(Frame f, Vec3 v) { return vec3(dot3(v, f.s), dot3(v, f.t), dot3(v, f.n)); }
INLINE Vec3 to_world(Frame f, Vec3 v) { return scale_add(f.s, v.x, scale_add(f.t, v.y, scale(f.n, v.z))); }

#endif
