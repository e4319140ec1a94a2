// A rectangle that emits on the side of its normal, sampled evenly over the solid angle under which it is seen.  Fields as a
// parallelogram's and inverse_length1 and inverse_length2; edge1 and edge2 are perpendicular.
// Urena, Fajardo, King 2013, "An Area-Preserving Parametrization for Spherical Rectangles".
#ifndef WAVELOBE_LIGHTS_RECTANGLE_H
#define WAVELOBE_LIGHTS_RECTANGLE_H

#include "lights/parallelogram.h"

// Seen under a smaller solid angle it is sampled evenly over its area: the two densities hardly differ, and the solid angle, a
// sum of four arcs of up to a quarter turn each of which is off by 2^-24 or so, would not be known to 2^-14.
#define LEAST_SOLID_ANGLE 0.01f

// The rectangle as seen from the reference point: it spans [x0, x1] x [y0, y1] at height z0 <= 0 below it.
typedef struct {
    Float x0, x1, y0, y1, z0;
    Float inverse_width, inverse_height;
    Float b0, b1;      // z of the normals of the planes through the reference and the edges at y0, y1
    Float slant;       // root of 1 - b0^2
    Float first, last; // sums of arcs: at x0 and, negative, at x1
    Float solid_angle;
} SphericalRectangle;

typedef struct {
    Float first, second;
    Float inverse_distance; // of the first
} Slopes;

// x / sqrt(x^2 + z^2) for two x: one division serves both. The roots' product neither overflows nor vanishes where the squares do not.
INLINE Slopes sines_of_slopes(Float x0, Float x1, Float z2) {
    Float d0 = sqrt(madd(x0, x0, z2)), d1 = sqrt(madd(x1, x1, z2));
    Float inverse = 1.0f / (d0 * d1);
    Slopes s = {x0 * (inverse * d1), x1 * (inverse * d0), inverse * d1};
    return s;
}

// Which rounding shall not take beyond 1.
INLINE Float as_sine(Float s) { return LESSER(GREATER(s, -ONE), ONE); }

INLINE SphericalRectangle spherical_rectangle(LightInput in, Vec3 reference) {
    PlanarLight l = planar_light(in);
    Vec3 e1 = l.edge1, e2 = l.edge2, to_corner = sub(l.position, reference);
    SphericalRectangle r;
    r.inverse_width = l.inverse_length1;
    r.inverse_height = l.inverse_length2;
    r.x0 = dot3(to_corner, e1) * r.inverse_width;
    r.y0 = dot3(to_corner, e2) * r.inverse_height;
    r.z0 = -fabs(dot3(to_corner, l.normal));
    r.x1 = madd(length_squared(e1), r.inverse_width, r.x0);
    r.y1 = madd(length_squared(e2), r.inverse_height, r.y0);
    Float z2 = r.z0 * r.z0;
    Slopes y = sines_of_slopes(r.y0, r.y1, z2), x = sines_of_slopes(r.x0, r.x1, z2);
    r.b0 = -as_sine(y.first);
    r.b1 = as_sine(y.second);
    r.slant = -r.z0 * y.inverse_distance;
    Float a0 = -as_sine(x.first), a1 = as_sine(x.second);
    r.first = lane_asin(a0 * r.b0) + lane_asin(a0 * r.b1);
    r.last = lane_asin(a1 * r.b0) + lane_asin(a1 * r.b1);
    r.solid_angle = r.first + r.last;
    return r;
}

// Where the solid angle is what is sampled; not from a point in the plane, where it is zero or not a number or, on the rectangle itself,
// all of a hemisphere that rounding alone tells from the other one.
INLINE Int sampled_by_solid_angle(SphericalRectangle r) { return (r.solid_angle >= LEAST_SOLID_ANGLE) & (r.solid_angle < MOST_SOLID_ANGLE); }

// Shares of the edges at which the sample (u1, u2) lies. With f = (b0 cos + b1) / sin and c = 1 / sqrt(f^2 + b0^2), the paper's x is
// z0 c / sqrt(1 - c^2); multiplied out, nothing cancels but at the edges, and most divisions go.
INLINE Vec2 sample_spherical_rectangle(SphericalRectangle r, Float u1, Float u2) {
    Float sine, cosine;
    lane_sin_cos(madd(u1, r.solid_angle, -r.first), &sine, &cosine);
    Float n = madd(cosine, r.b0, r.b1);
    Float square = madd(-r.slant, sine, n) * madd(r.slant, sine, n);
    Float x = copy_sign(r.z0 * sine, n * sine) / sqrt(GREATER(square, (Float)0x1p-80f));
    x = LESSER(GREATER(x, r.x0), r.x1);
    Float d2 = madd(x, x, r.z0 * r.z0);
    Slopes s = sines_of_slopes(r.y0, r.y1, d2);
    Float h = madd(u2, s.second - s.first, s.first);
    Float y = h * sqrt(d2 / GREATER(madd(-h, h, ONE), (Float)0x1p-40f));
    y = LESSER(GREATER(y, r.y0), r.y1);
    Vec2 at = {LESSER((x - r.x0) * r.inverse_width, ONE), LESSER((y - r.y0) * r.inverse_height, ONE)};
    return at;
}

INLINE LightSample rectangle_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    SphericalRectangle r = spherical_rectangle(in, reference);
    Int even = sampled_by_solid_angle(r);
    Vec2 at = sample_spherical_rectangle(r, u1, u2);
    return planar_light_sample(in, reference, SELECT(even, at.x, u1), SELECT(even, at.y, u2), SELECT(even, r.solid_angle, ZERO));
}

INLINE Float rectangle_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    SphericalRectangle r = spherical_rectangle(in, reference);
    return SELECT(sampled_by_solid_angle(r), 1.0f / r.solid_angle, parallelogram_pdf(in, reference, direction, t, normal));
}

#endif
