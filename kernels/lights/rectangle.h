// A rectangle that emits on the side of its normal, sampled evenly over the solid angle under which it is seen.  Fields as a
// parallelogram's; edge1 and edge2 are perpendicular.
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
    Float b0, b1;      // z of the normals of the planes through the reference and the edges at y0, y1
    Float first, last; // sums of arcs: at x0 and, negative, at x1
    Float solid_angle;
} SphericalRectangle;

// x / sqrt(x^2 + z^2), which rounding shall not take beyond 1.
INLINE Float sine_of_slope(Float x, Float z2) {
    Float s = x / sqrt(madd(x, x, z2));
    return LESSER(GREATER(s, -ONE), ONE);
}

INLINE SphericalRectangle spherical_rectangle(LightInput in, Vec3 reference) {
    PlanarLight l = planar_light(in);
    Vec3 e1 = l.edge1, e2 = l.edge2, to_corner = sub(l.position, reference);
    Float width = sqrt(length_squared(e1)), height = sqrt(length_squared(e2));
    SphericalRectangle r;
    r.x0 = dot3(to_corner, e1) / width;
    r.y0 = dot3(to_corner, e2) / height;
    r.z0 = -fabs(dot3(to_corner, l.normal));
    r.x1 = r.x0 + width;
    r.y1 = r.y0 + height;
    Float z2 = r.z0 * r.z0;
    r.b0 = -sine_of_slope(r.y0, z2);
    r.b1 = sine_of_slope(r.y1, z2);
    Float a0 = -sine_of_slope(r.x0, z2), a1 = sine_of_slope(r.x1, z2);
    r.first = lane_asin(a0 * r.b0) + lane_asin(a0 * r.b1);
    r.last = lane_asin(a1 * r.b0) + lane_asin(a1 * r.b1);
    r.solid_angle = r.first + r.last;
    return r;
}

// Where the solid angle is what is sampled; not from a point in the plane, where it is not a number or zero.
INLINE Int sampled_by_solid_angle(SphericalRectangle r) { return r.solid_angle >= LEAST_SOLID_ANGLE; }

// Shares of the edges at which the sample (u1, u2) lies.
INLINE Vec2 sample_spherical_rectangle(SphericalRectangle r, Float u1, Float u2) {
    Float sine, cosine;
    lane_sin_cos(madd(u1, r.solid_angle, -r.first), &sine, &cosine);
    Float f = madd(cosine, r.b0, r.b1) / sine;
    Float c = LESSER(1.0f / sqrt(madd(f, f, r.b0 * r.b0)), ONE);
    Float x = copy_sign(c, f) * -r.z0 / sqrt(GREATER(madd(-c, c, ONE), (Float)0x1p-40f));
    x = LESSER(GREATER(x, r.x0), r.x1);
    Float d2 = madd(x, x, r.z0 * r.z0);
    Float h0 = sine_of_slope(r.y0, d2), h1 = sine_of_slope(r.y1, d2);
    Float h = madd(u2, h1 - h0, h0);
    Float y = h * sqrt(d2 / GREATER(madd(-h, h, ONE), (Float)0x1p-40f));
    y = LESSER(GREATER(y, r.y0), r.y1);
    Vec2 at = {(x - r.x0) / (r.x1 - r.x0), (y - r.y0) / (r.y1 - r.y0)};
    return at;
}

INLINE LightSample rectangle_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    SphericalRectangle r = spherical_rectangle(in, reference);
    Int even = sampled_by_solid_angle(r);
    Vec2 at = sample_spherical_rectangle(r, u1, u2);
    LightSample s = parallelogram_sample_light(in, reference, SELECT(even, at.x, u1), SELECT(even, at.y, u2));
    s.pdf = SELECT(even & (s.pdf > 0.0f), 1.0f / r.solid_angle, s.pdf);
    return s;
}

INLINE Float rectangle_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    SphericalRectangle r = spherical_rectangle(in, reference);
    return SELECT(sampled_by_solid_angle(r), 1.0f / r.solid_angle, parallelogram_pdf(in, reference, direction, t, normal));
}

#endif
