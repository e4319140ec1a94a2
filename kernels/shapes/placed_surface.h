// Surfaces of groups that stand in several places. Part of surface.h, which has the types.
#ifndef WAVELOBE_SHAPES_PLACED_SURFACE_H
#define WAVELOBE_SHAPES_PLACED_SURFACE_H

// From the space of a group to the world.
INLINE void place_surface(SurfaceView s, UInt instance, Surface *out) {
    InstanceMap m = instance_map(s.instances, instance);
    if (!any_lane(m.placed)) return;
    Vec3 error = out->error;
    Vec3 position = instance_point(&m, out->position, &error);
    Vec3 normal = normalize_any_scale(instance_normal(&m, out->normal));
    Vec3 n = normalize_any_scale(instance_normal(&m, out->frame.n));
    out->position = select3(m.placed, position, out->position);
    out->error = select3(m.placed, error, out->error);
    out->normal = select3(m.placed, normal, out->normal);
    out->frame.n = select3(m.placed, n, out->frame.n);
#if HAS_SMOOTH_TERMINATOR
    out->rise.front = select3(m.placed, instance_vector(&m, out->rise.front), out->rise.front);
    out->rise.behind = select3(m.placed, instance_vector(&m, out->rise.behind), out->rise.behind);
#endif
#if HAS_TANGENTS
    out->dp_du = select3(m.placed, instance_vector(&m, out->dp_du), out->dp_du);
    out->dp_dv = select3(m.placed, instance_vector(&m, out->dp_dv), out->dp_dv);
#if HAS_VERTEX_TANGENTS
    out->tangent = select3(m.placed, instance_vector(&m, out->tangent), out->tangent);
#endif
#endif
}

#endif
