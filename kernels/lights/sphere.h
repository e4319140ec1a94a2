// A sphere that emits outwards or, flipped, inwards.  Fields: radiance, analytic, inverse_area.
//
// One that shines outwards is sampled evenly over the cone of directions under which it is seen.  One that shines inwards
// is sampled evenly over its area, which from a point near its wall is close to the cosine density: on the wall itself,
// distance^2 / (|cos| area) = cos / pi.  The side alone decides, never whether the reference point looks inside or
// outside: for a point on the surface rounding would decide that.
#ifndef WAVELOBE_LIGHTS_SPHERE_H
#define WAVELOBE_LIGHTS_SPHERE_H

#include "lights/analytic.h"
#include "sampling/warps.h"

// The cone of directions from the reference point to a sphere.
typedef struct {
    Vec3 axis;            // unit, to the centre
    Float sin2, cosine;   // of the half angle
    Float versine;        // 1 - cosine, without cancellation
    Float pdf;            // 1 over the solid angle; zero from inside, where an outward sphere is dark
} SphereCone;

INLINE SphereCone sphere_cone(AnalyticMap m, Vec3 reference) {
    Vec3 to_center = sub(m.origin, reference);
    Float d2 = length_squared(to_center), r2 = m.radius * m.radius;
    SphereCone c;
    c.axis = select3(d2 > 0.0f, scale(to_center, 1.0f / sqrt(d2)), vec3(ZERO, ZERO, ONE));
    c.sin2 = LESSER(r2 / d2, ONE);
    c.cosine = sqrt(1.0f - c.sin2);
    c.versine = c.sin2 / (1.0f + c.cosine);
    c.pdf = SELECT(d2 > r2, INV_TWO_PI_F / c.versine, ZERO);
    return c;
}

// The sphere's point in direction `n` of its centre.
INLINE AnalyticPoint sphere_point(AnalyticMap m, Vec3 n) {
    n = normalize3(n);
    AnalyticPoint p;
    p.position = scale_add(n, m.radius, m.origin);
    // Off the sphere by five roundings of the length of `n` and one of the product; along each axis by that of the sum.
    p.error = scale_add(absolute(n), GAMMA(6) * m.radius, scale(absolute(p.position), (Float)GAMMA(2)));
    p.normal = scale(n, m.flip);
    return p;
}

INLINE LightSample sphere_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    AnalyticMap m = light_analytic_map(in);
    SphereCone c = sphere_cone(m, reference);
    Int outward = m.flip > 0.0f;

    // A direction of the cone: an angle theta from its axis, and the azimuth.
    Float versine = u1 * c.versine;
    Float cos_theta = 1.0f - versine;
    Float sin_theta = sqrt(versine * (2.0f - versine));
    Float sin_phi, cos_phi;
    lane_sin_cos_turns(u2, &sin_phi, &cos_phi);
    Frame frame = frame_of_normal(c.axis);
    Vec3 around = scale_add(frame.s, cos_phi, scale(frame.t, sin_phi));
    Vec3 direction = scale_add(around, sin_theta, scale(c.axis, cos_theta));

    // Its point on the sphere: at the hit the ray makes an angle beta with the normal, with sin(beta) the ratio of
    // sin(theta) to that of the half angle, and as seen from the centre the hit is beta - theta off the axis.  Both
    // squares below are written so that nothing cancels, for spheres that are far and for rays that graze.
    Float widest = 1.0f + c.cosine;
    Float sin2_beta = u1 * (2.0f - versine) / widest;
    Float cos2_beta = (1.0f - u1) * (widest - versine) / widest;
    Float sin_beta = sqrt(sin2_beta), cos_beta = sqrt(cos2_beta), sin_half = sqrt(c.sin2);
    Float sin_alpha = sin_beta * (cos_theta - sin_half * cos_beta);
    Float cos_alpha = madd(sin2_beta, sin_half, cos_theta * cos_beta);
    Vec3 facing = scale_add(around, sin_alpha, scale(c.axis, -cos_alpha));

    AnalyticPoint p = sphere_point(m, select3(outward, facing, square_to_uniform_sphere(u1, u2)));
    Float u = ZERO, v = ZERO;
#if HAS_TEXTURED_EMITTERS
    analytic_uv(m.kind, map_to_object(m, sub(p.position, m.origin)), &u, &v);
#endif
    LightSample s = area_light_sample(in, reference, p.position, p.error, p.normal, u, v, ZERO);
    s.direction = select3(outward, direction, s.direction);
    s.radiance = select3(outward, select3(c.pdf > 0.0f, light_radiance(in, u, v), vec3_all(ZERO)), s.radiance);
    s.pdf = SELECT(outward, c.pdf, s.pdf);
    return s;
}

INLINE Float sphere_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    AnalyticMap m = light_analytic_map(in);
    Float even = area_light_hit_pdf(in, direction, t, normal);
    return SELECT(m.flip > 0.0f, sphere_cone(m, reference).pdf, even);
}

#endif
