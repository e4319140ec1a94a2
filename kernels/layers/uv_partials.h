// Partial derivatives of a surface's position by its texture coordinates, in world space.
#ifndef WAVELOBE_LAYERS_UV_PARTIALS_H
#define WAVELOBE_LAYERS_UV_PARTIALS_H

#include "core/math.h"
#include "shapes/surface.h"
#include "shapes/triangle_tangents.h"

typedef struct {
    Vec3 dp_du, dp_dv;
} UvPartials;

// In the space of the triangle's vertices. Coordinates that do not span a plane give any two directions along the triangle.
INLINE UvPartials triangle_partials(SurfaceView s, UInt slot, const Surface *surface) {
    Corners corners = triangle_corners(s, slot);
    Vec3 e1 = sub(corners.b, corners.a), e2 = sub(corners.c, corners.a);
    UvPartials p = {e1, e2};
#if HAS_UVS
    UInt first_uv = GATHER_UINT_FIELD(s.shapes, Shape, surface->shape, first_uv);
    UInt triangle = surface->primitive - GATHER_UINT_FIELD(s.shapes, Shape, surface->shape, first_primitive);
    triangle_tangents(s.uvs, first_uv, triangle, normalize_any_scale(cross3(e1, e2)), &p.dp_du, &p.dp_dv);
#endif
    return p;
}

#if HAS_ANALYTIC
// Spheres: u is the azimuth over 2 pi, v the angle from the pole over pi. Disks: u is the radius, v the azimuth; cylinders: u
// is the azimuth, v the height.
INLINE UvPartials analytic_partials(global const struct Analytic *analytics, UInt index, Vec3 position) {
    AnalyticMap m = analytic_map(analytics, index);
    Vec3 o = map_to_object(m, sub(position, m.origin));
    Float radial = sqrt(madd(o.x, o.x, o.y * o.y));
    Int off_axis = radial > 0.0f;
    Float cos_phi = SELECT(off_axis, o.x / radial, ONE), sin_phi = SELECT(off_axis, o.y / radial, ZERO);
    Int sphere = m.kind == ANALYTIC_SPHERE, disk = m.kind == ANALYTIC_DISK;
    Vec3 around = scale(vec3(-o.y, o.x, ZERO), (Float)(2.0f * PI_F));
    Vec3 from_pole = scale(vec3(o.z * cos_phi, o.z * sin_phi, -radial), (Float)PI_F);
    UvPartials p;
    p.dp_du = map_to_world(m, select3(disk, vec3(cos_phi, sin_phi, ZERO), around));
    p.dp_dv = map_to_world(m, select3(sphere, from_pole, select3(disk, around, vec3(ZERO, ZERO, ONE))));
    return p;
}
#endif

INLINE UvPartials uv_partials(SurfaceView s, const TracedPath *path, const Surface *surface) {
#if HAS_ANALYTIC
    Int analytic = (path->hit & (UInt)HIT_ANALYTIC) != (UInt)0u;
    UvPartials p = triangle_partials(s, SELECT(analytic, (UInt)0u, path->hit), surface);
#else
    UvPartials p = triangle_partials(s, path->hit, surface);
#endif
#if HAS_INSTANCES
    InstanceMap m = instance_map(s.instances, path->instance);
#endif
#if HAS_ANALYTIC
    if (any_lane(analytic)) {
        Vec3 position = surface->position;
#if HAS_INSTANCES
        position = select3(m.placed, point_to_instance(&m, position), position);
#endif
        UvPartials of_analytic = analytic_partials(s.analytics, SELECT(analytic, path->hit & (UInt)~HIT_ANALYTIC, (UInt)0u), position);
        p.dp_du = select3(analytic, of_analytic.dp_du, p.dp_du);
        p.dp_dv = select3(analytic, of_analytic.dp_dv, p.dp_dv);
    }
#endif
#if HAS_INSTANCES
    p.dp_du = select3(m.placed, instance_vector(&m, p.dp_du), p.dp_du);
    p.dp_dv = select3(m.placed, instance_vector(&m, p.dp_dv), p.dp_dv);
#endif
    return p;
}

#endif
