// Spheres, disks and cylinders: where a ray hits them, and the surface there.
//
// The ray test is scalar and in double: a few dozen operations against the whole traversal before them, and then a small
// sphere far away keeps its outline and a ray that leaves a surface never meets it again, both of which cancellation
// breaks in float.  (Haines, Gunther, Akenine-Moller 2019, "Precision Improvements for Ray/Sphere Intersection".)
#ifndef WAVELOBE_SHAPES_ANALYTIC_GEOMETRY_H
#define WAVELOBE_SHAPES_ANALYTIC_GEOMETRY_H

#pragma OPENCL EXTENSION cl_khr_fp64 : enable

#include "core/math.h"
#include "shapes/analytic_map.h"
#include "shapes/ray.h"

// ---- the ray test: one ray, one shape -------------------------------------------------------------------------------

INLINE double dot_double(double ax, double ay, double az, double bx, double by, double bz) {
    return ax * bx + ay * by + az * bz;
}

// Roots of a t^2 + 2 b t + c = 0, near <= far, given the root of a quarter of its discriminant.  Adding magnitudes of
// one sign loses no digits; the other root follows from the product of both.
INLINE void quadratic_roots(double a, double b, double c, double root, double *near, double *far) {
    double q = b < 0.0 ? root - b : -root - b;
    double t0 = c / q, t1 = q / a;
    *near = t0 < t1 ? t0 : t1;
    *far = t0 < t1 ? t1 : t0;
}

// The nearer of two roots that lies strictly between `after` and `limit` as a float, otherwise infinity.
INLINE float nearest_root(double near, int near_valid, double far, int far_valid, float after, float limit) {
    float t0 = (float)near, t1 = (float)far;
    if (near_valid && t0 > after && t0 < limit) return t0;
    return far_valid && t1 > after && t1 < limit ? t1 : INFINITY;
}

INLINE float intersect_sphere(global const struct Analytic *s, double fx, double fy, double fz, const Ray *r, float after,
                              float limit) {
    double dx = r->dx, dy = r->dy, dz = r->dz, r2 = (double)s->radius * (double)s->radius;
    double a = dot_double(dx, dy, dz, dx, dy, dz), b = dot_double(fx, fy, fz, dx, dy, dz);
    double m = -b / a; // where the ray is nearest to the centre
    double lx = fx + m * dx, ly = fy + m * dy, lz = fz + m * dz;
    double below = r2 - dot_double(lx, ly, lz, lx, ly, lz);
    if (!(below >= 0.0)) return INFINITY;
    double near, far;
    quadratic_roots(a, b, dot_double(fx, fy, fz, fx, fy, fz) - r2, sqrt(a * below), &near, &far);
    return nearest_root(near, 1, far, 1, after, limit);
}

INLINE float intersect_disk(double ox, double oy, double oz, double dx, double dy, double dz, float after,
                            float limit) {
    double t = -oz / dz, x = ox + t * dx, y = oy + t * dy;
    return nearest_root(t, x * x + y * y <= 1.0, t, 0, after, limit);
}

INLINE float intersect_cylinder(double ox, double oy, double oz, double dx, double dy, double dz, float after,
                            float limit) {
    double a = dx * dx + dy * dy, b = ox * dx + oy * dy;
    double moment = ox * dy - oy * dx; // distance of the ray from the axis times sqrt(a)
    double below = a - moment * moment;
    if (!(below >= 0.0)) return INFINITY;
    double near, far;
    quadratic_roots(a, b, ox * ox + oy * oy - 1.0, sqrt(below), &near, &far);
    double z0 = oz + near * dz, z1 = oz + far * dz;
    return nearest_root(near, z0 >= 0.0 && z0 <= 1.0, far, z1 >= 0.0 && z1 <= 1.0, after, limit);
}

// Distance to the first hit strictly between `after` and `limit`, otherwise infinity.
INLINE float intersect_analytic(global const struct Analytic *s, const Ray *r, float after, float limit) {
    global const float *w = s->to_world.m, *m = s->to_object.m;
    double fx = (double)r->ox - (double)w[3], fy = (double)r->oy - (double)w[7], fz = (double)r->oz - (double)w[11];
    if (s->kind == ANALYTIC_SPHERE) return intersect_sphere(s, fx, fy, fz, r, after, limit);
    double dx = dot_double(m[0], m[1], m[2], r->dx, r->dy, r->dz), ox = dot_double(m[0], m[1], m[2], fx, fy, fz);
    double dy = dot_double(m[4], m[5], m[6], r->dx, r->dy, r->dz), oy = dot_double(m[4], m[5], m[6], fx, fy, fz);
    double dz = dot_double(m[8], m[9], m[10], r->dx, r->dy, r->dz), oz = dot_double(m[8], m[9], m[10], fx, fy, fz);
    if (s->kind == ANALYTIC_DISK) return intersect_disk(ox, oy, oz, dx, dy, dz, after, limit);
    return intersect_cylinder(ox, oy, oz, dx, dy, dz, after, limit);
}

// ---- the surface at a hit, LANES at a time ---------------------------------------------------------------------------

typedef struct {
    Vec3 position, error; // world space; bound on the distance to the surface along each axis
    Vec3 normal;          // unit, after the flip
    Vec3 dp_du, dp_dv;    // change of position with u and v; zero where they have no direction
    Float u, v;
} AnalyticHit;

// Texture coordinates of a point on the unit shape, as Mitsuba has them: sphere (azimuth, polar angle), disk (radius,
// azimuth), cylinder (azimuth, height), each over [0, 1].
INLINE void analytic_uv(UInt kind, Vec3 object, Float *u, Float *v) {
    Int sphere = kind == ANALYTIC_SPHERE, disk = kind == ANALYTIC_DISK;
    Float radius = sqrt(madd(object.x, object.x, object.y * object.y));
    Float azimuth = lane_atan2(object.y, object.x) * INV_TWO_PI_F;
    azimuth = SELECT(azimuth < 0.0f, azimuth + 1.0f, azimuth);
    Float height = SELECT(sphere, lane_atan2(radius, object.z) * INV_PI, object.z);
    *u = SELECT(disk, radius, azimuth);
    *v = SELECT(disk, azimuth, height);
}

// The surface where a ray of unit direction meets shape `index` at distance t.
INLINE AnalyticHit analytic_hit(global const struct Analytic *analytics, UInt index, Vec3 origin, Vec3 direction, Float t) {
    AnalyticMap m = analytic_map(analytics, index);
    Int sphere = m.kind == ANALYTIC_SPHERE, disk = m.kind == ANALYTIC_DISK;
    Vec3 p = scale_add(direction, t, origin);
    Vec3 offset = sub(p, m.origin);
    Vec3 object = map_to_object(m, offset);

    // The unit shape as the level set of zero: radius - 1 or z, with its unit gradient.
    Float radial = sqrt(madd(object.x, object.x, object.y * object.y));
    Vec3 g = select3(disk, vec3(ZERO, ZERO, ONE), vec3(object.x / radial, object.y / radial, ZERO));
    Float value = SELECT(disk, object.z, radial - 1.0f);
    Vec3 gradient = map_gradient(m, g);
    Float gradient_length = sqrt(length_squared(gradient));
    Float distance = sqrt(length_squared(offset));
    Vec3 outward = select3(sphere, scale(offset, 1.0f / distance), scale(gradient, 1.0f / gradient_length));

    // Back onto the surface along its normal: distance along the ray carries the ray's error, this does not.
    AnalyticHit hit;
    hit.position = select3(sphere, scale_add(outward, m.radius, m.origin), scale_add(outward, -value / gradient_length, p));
    hit.normal = scale(outward, m.flip);
    // Along the normal. Sphere: five roundings of the length of `outward`, one of the product. Others: one of the
    // offset, three of the level set's dot products, three of its radius. Along each axis: the last sum.
    Float across = SELECT(sphere, GAMMA(6) * m.radius, GAMMA(8) * map_sensitivity(m, offset, g, gradient_length));
    hit.error = scale_add(absolute(outward), across, scale(absolute(hit.position), (Float)GAMMA(2)));

    analytic_uv(m.kind, object, &hit.u, &hit.v);
    // Azimuth runs from 0 to 1 about the axis, the polar angle from pole to pole.
    Int on_axis = radial == 0.0f;
    Float inverse = SELECT(on_axis, ZERO, 1.0f / radial);
    Vec3 about = scale(vec3(-object.y, object.x, ZERO), (Float)TWO_PI_F);
    Vec3 outwards = vec3(object.x * inverse, object.y * inverse, ZERO);
    Vec3 down = scale(vec3(object.z * SELECT(on_axis, ONE, outwards.x), object.z * outwards.y, -radial), (Float)PI_F);
    hit.dp_du = map_to_world(m, select3(disk, outwards, about));
    hit.dp_dv = map_to_world(m, select3(disk, about, select3(sphere, down, vec3(ZERO, ZERO, ONE))));
    return hit;
}

#endif
