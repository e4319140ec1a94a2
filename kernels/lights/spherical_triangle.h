// A triangle that emits on the side of its normal, sampled evenly over the solid angle under which it is seen: worth its price for
// triangles that are large where they shine.  Fields as a triangle's.
// Arvo 1995, "Stratified Sampling of Spherical Triangles"; solid angle after van Oosterom and Strackee 1983, "The Solid Angle of a
// Plane Triangle".
#ifndef WAVELOBE_LIGHTS_SPHERICAL_TRIANGLE_H
#define WAVELOBE_LIGHTS_SPHERICAL_TRIANGLE_H

#include "lights/triangle.h"

// Seen under a smaller solid angle it is sampled evenly over its area: the two densities hardly differ, and what the sampled arc
// takes from differences of cosines would be known to less than 2^-14.
#define LEAST_TRIANGLE_ANGLE 0.002f

// The triangle as seen from the reference point.
typedef struct {
    Vec3 a, b, c; // unit, to its corners
    Float volume; // of the three: positive, zero from a point in its plane
    Float solid_angle;
} SphericalTriangle;

INLINE Vec3 unit_or_zero(Vec3 v, Float *length) {
    Float square = length_squared(v);
    *length = sqrt(square);
    return scale(v, SELECT(square > 0.0f, 1.0f / *length, ZERO));
}

INLINE SphericalTriangle spherical_triangle(LightInput in, Vec3 reference) {
    PlanarLight l = planar_light(in);
    Vec3 e1 = l.edge1, e2 = l.edge2, to_first = sub(l.position, reference);
    Float la, lb, lc;
    SphericalTriangle t;
    t.a = unit_or_zero(to_first, &la);
    t.b = unit_or_zero(add(to_first, e1), &lb);
    t.c = unit_or_zero(add(to_first, e2), &lc);
    // By the edges themselves nothing cancels, however small it is seen.
    Float height = fabs(dot3(to_first, l.normal)), area = 1.0f / l.inverse_area;
    t.volume = 2.0f * (height / la) * (area / lb) / lc;
    Float rest = 1.0f + dot3(t.a, t.b) + dot3(t.b, t.c) + dot3(t.c, t.a);
    t.solid_angle = 2.0f * lane_atan2(t.volume, rest);
    return t;
}

// Not from a point in its plane, or at a corner, where the solid angle is zero or not a number.
INLINE Int samples_solid_angle(SphericalTriangle t) { return (t.solid_angle >= LEAST_TRIANGLE_ANGLE) & (t.solid_angle < MOST_SOLID_ANGLE); }

// The unit vector in the plane of `axis` and `v`, perpendicular to `axis`.
INLINE Vec3 perpendicular_part(Vec3 v, Vec3 axis) { return normalize3(scale_add(axis, -dot3(v, axis), v)); }

// On the arc from `from` towards `to`, at the angle of this cosine.
INLINE Vec3 along_arc(Vec3 from, Vec3 to, Float cosine) {
    Float sine = sqrt(GREATER(madd(-cosine, cosine, ONE), ZERO));
    return scale_add(perpendicular_part(to, from), sine, scale(from, cosine));
}

// The direction of the sample (u1, u2): u1 cuts a smaller triangle off at the arc from a to b, u2 goes along its far side.
INLINE Vec3 sample_spherical_triangle(SphericalTriangle t, Float u1, Float u2) {
    // The angle at corner a, between the planes of its two sides.
    Vec3 ab = cross3(t.a, t.b), ca = cross3(t.c, t.a);
    Float x = -dot3(ab, ca), inverse = 1.0f / sqrt(madd(x, x, t.volume * t.volume));
    Float cos_a = x * inverse, sin_a = t.volume * inverse;
    Float sin_cut, cos_cut;
    lane_sin_cos(u1 * t.solid_angle, &sin_cut, &cos_cut);
    // Sine and cosine of the cut area less the angle.
    Float s = madd(sin_cut, cos_a, -cos_cut * sin_a), k = madd(cos_cut, cos_a, sin_cut * sin_a);
    Float p = k - cos_a, q = madd(sin_a, dot3(t.a, t.b), s);
    Float cosine = madd(madd(q, k, -p * s), cos_a, -q) / (madd(q, s, p * k) * sin_a);
    cosine = LESSER(GREATER(cosine, -ONE), ONE);
    cosine = SELECT(u1 * t.solid_angle > 0.0f, cosine, ONE);
    Vec3 cut = along_arc(t.a, t.c, cosine);
    Float z = madd(-u2, 1.0f - dot3(cut, t.b), ONE);
    return along_arc(t.b, cut, LESSER(GREATER(z, -ONE), ONE));
}

// Barycentric coordinates of where a direction meets the triangle, kept within it.
INLINE Vec2 triangle_along(LightInput in, Vec3 reference, Vec3 direction) {
    PlanarLight l = planar_light(in);
    Vec3 e1 = l.edge1, e2 = l.edge2, from_first = sub(reference, l.position);
    Vec3 p = cross3(direction, e2), q = cross3(from_first, e1);
    Float inverse = 1.0f / dot3(e1, p);
    Vec2 b = {LESSER(GREATER(dot3(from_first, p) * inverse, ZERO), ONE), GREATER(dot3(direction, q) * inverse, ZERO)};
    b.y = LESSER(b.y, 1.0f - b.x);
    return b;
}

INLINE LightSample spherical_triangle_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    SphericalTriangle t = spherical_triangle(in, reference);
    Int even = samples_solid_angle(t);
    Vec2 at = square_to_triangle(u1, u2);
    if (any_lane(even)) {
        Vec2 seen = triangle_along(in, reference, sample_spherical_triangle(t, u1, u2));
        at.x = SELECT(even, seen.x, at.x);
        at.y = SELECT(even, seen.y, at.y);
    }
    return planar_light_sample(in, reference, at.x, at.y, SELECT(even, t.solid_angle, ZERO));
}

INLINE Float spherical_triangle_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    SphericalTriangle seen = spherical_triangle(in, reference);
    return SELECT(samples_solid_angle(seen), 1.0f / seen.solid_angle, triangle_pdf(in, reference, direction, t, normal));
}

#endif
