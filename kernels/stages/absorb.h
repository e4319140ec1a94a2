// Absorption along rays, and rays that go on through shapes which only part media: these are found by the traversal like any
// other, but they turn nothing, end no path and hide no light.
#ifndef WAVELOBE_STAGES_ABSORB_H
#define WAVELOBE_STAGES_ABSORB_H

#include "stages/scene_view.h"

// Scales a queue's colours by what the media of its rays let through over their lengths.
INLINE void absorb_along(MediaView media, Queue q, uint colour, uint medium, Int live, Float distance, uint i) {
    UInt m = SELECT(live, read_uint(q, medium, i), (UInt)MEDIUM_VACUUM);
    write_vec3(q, colour, i, mul(read_vec3(q, colour, i), transmittance(media, m, distance)));
}

#if HAS_CLEAR_BOUNDARIES

// Each clear boundary takes this off what is left of a ray's length, as a share of the whole: rounding in the sum of its parts
// must not carry a shadow ray into the light it is meant for.
#define BOUNDARY_SLACK (2.0f * GAMMA(16))

// A group of rays. `path` says of each where it starts, up to which distance it looks and what it leaves, and afterwards what it
// hit and how far away from its first origin.
#if HAS_FEW_TRIANGLES
INLINE void trace_lanes(Geometry g, Block block, Vec3 origin, Int wanted, TracedPath *path) {
    LaneHit hit = closest_of_few(g, origin, path->direction, path->t, path->hit KEY_ARGUMENT(g, block, path->id, path->direction));
    path->t = SELECT(wanted, hit.t, path->t);
    path->u = SELECT(wanted, hit.u, path->u);
    path->v = SELECT(wanted, hit.v, path->v);
    path->hit = SELECT(wanted, hit.slot, path->hit);
}
#else
// One ray after the other, through arrays of what they share.
INLINE void trace_lanes(Geometry g, Block block, Vec3 origin, Int wanted, TracedPath *path) {
    float o[3][LANES] __attribute__((aligned(64))), d[3][LANES] __attribute__((aligned(64)));
    float t[LANES] __attribute__((aligned(64))), u[LANES] __attribute__((aligned(64))), v[LANES] __attribute__((aligned(64)));
    uint hit[LANES] __attribute__((aligned(64)));
    *(Float *)o[0] = origin.x, *(Float *)o[1] = origin.y, *(Float *)o[2] = origin.z;
    *(Float *)d[0] = path->direction.x, *(Float *)d[1] = path->direction.y, *(Float *)d[2] = path->direction.z;
    *(Float *)t = path->t, *(Float *)u = path->u, *(Float *)v = path->v;
    *(UInt *)hit = path->hit;
#if HAS_MASKS
    uint key[LANES] __attribute__((aligned(64)));
    *(UInt *)key = ray_key(g.opacity, block, path->id, path->direction);
#endif
#if HAS_INSTANCES
    uint instance[LANES] __attribute__((aligned(64)));
    *(UInt *)instance = path->instance;
#endif
    uint bits = lane_bits(wanted);
    while (bits) {
        POP_LOWEST_BIT(bits, i);
        Ray r = {
            o[0][i], o[1][i], o[2][i], d[0][i], d[1][i], d[2][i], t[i], hit[i],
#if HAS_MASKS
            key[i],
#endif
        };
        Hit found = trace_closest(g, &r);
        t[i] = found.t, u[i] = found.u, v[i] = found.v, hit[i] = found.primitive;
#if HAS_INSTANCES
        instance[i] = found.instance;
#endif
    }
    path->t = *(Float *)t, path->u = *(Float *)u, path->v = *(Float *)v;
    path->hit = *(UInt *)hit;
#if HAS_INSTANCES
    path->instance = *(UInt *)instance;
#endif
}
#endif

// Follows rays through clear boundaries to what they hit behind; the result is the share of light left on the way. `medium` is
// that at the origin, and afterwards that at the hit; `escape`: a ray that hits nothing has no end.
INLINE Rgb follow_rays(Block block, const SceneView *scene, Vec3 origin, TracedPath *path, UInt *medium, int escape) {
    Rgb left = vec3_all(ONE);
    Float limit = path->t, before = ZERO;
    Int walking = path->live;
    while (any_lane(walking)) {
        Float reach = path->t;
        trace_lanes(scene->geometry, block, origin, walking, path);
        Int found = walking & (path->hit != (UInt)HIT_NONE);
        Float way = SELECT(found, path->t, escape ? (Float)INFINITY : reach);
        UInt through = SELECT(walking, *medium, (UInt)MEDIUM_VACUUM);
        left = select3(walking, mul(left, transmittance(scene->media, through, way)), left);
        TracedPath at = *path;
        at.hit = SELECT(found, path->hit, (UInt)0u);
#if HAS_ANALYTIC
        at.origin = origin;
#endif
#if HAS_INSTANCES
        at.instance = SELECT(found, path->instance, (UInt)INSTANCE_NONE);
#endif
        UInt shape = gather_uint(scene->surfaces.primitive_shapes, primitive_of_hit(scene->surfaces, at.hit));
        UInt flags = GATHER_UINT_FIELD(scene->surfaces.shapes, Shape, shape, flags);
        Int clear = found & ((flags & (UInt)SHAPE_CLEAR) != (UInt)0u);
        path->t = SELECT(walking & !clear, before + path->t, path->t);
        walking = clear;
        if (!any_lane(clear)) break;
        at.hit = SELECT(clear, path->hit, (UInt)0u);
        Surface surface = load_surface(scene->surfaces, &at);
        UInt beyond = medium_beyond(scene->media, scene->surfaces, &surface, path->direction, through);
        Vec3 behind = offset_ray_origin(surface.position, surface.error, surface.normal, path->direction);
        *medium = SELECT(clear, beyond, *medium);
        origin = select3(clear, behind, origin);
        before = SELECT(clear, before + path->t, before);
        Float rest = limit - before - SELECT(limit < (Float)INFINITY, limit * BOUNDARY_SLACK, ZERO);
        path->hit = SELECT(clear, surface.primitive, path->hit);
        path->t = SELECT(clear, GREATER(rest, ZERO), path->t);
    }
    return left;
}

// A group of a queue's rays as they are before tracing.
INLINE TracedPath untraced_path(Queue q, uint direction, uint limit, uint from, uint id, uint i) {
    TracedPath p;
    p.live = lanes_below(i, *q.count);
    p.t = read_field(q, limit, i);
    p.u = p.v = ZERO;
    p.hit = SELECT(p.live, read_uint(q, from, i), (UInt)HIT_NONE);
    p.id = SELECT(p.live, read_uint(q, id, i), (UInt)0u);
    p.direction = read_vec3(q, direction, i);
#if HAS_INSTANCES
    p.instance = (UInt)INSTANCE_NONE;
#endif
    return p;
}
#endif

#endif
