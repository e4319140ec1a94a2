// Finds what each ray of the ray queue hits first, and writes it into the path's slot.
#ifndef WAVELOBE_STAGES_INTERSECT_CLOSEST_H
#define WAVELOBE_STAGES_INTERSECT_CLOSEST_H

#include "stages/scene_view.h"
#if HAS_MEDIA
#include "stages/absorb.h"
#endif

#if HAS_CLEAR_BOUNDARIES
// Through what only parts media, taking off what the media absorb.
INLINE void follow_paths(Block block, const SceneView *scene, Queue rays) {
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = untraced_path(rays, PATH_DIRECTION, PATH_T, PATH_HIT, PATH_ID, i);
        UInt medium = read_uint(rays, PATH_MEDIUM, i);
        Rgb left = follow_rays(block, scene, read_vec3(rays, PATH_ORIGIN, i), &path, &medium, 1);
        Rgb throughput = mul(read_vec3(rays, PATH_THROUGHPUT, i), left);
        write_field(rays, PATH_T, i, path.t);
        write_field(rays, PATH_U, i, path.u);
        write_field(rays, PATH_V, i, path.v);
        write_field(rays, PATH_HIT, i, as_Float(path.hit));
        write_field(rays, PATH_MEDIUM, i, as_Float(medium));
        write_vec3(rays, PATH_THROUGHPUT, i, throughput);
#if HAS_INSTANCES
        write_field(rays, PATH_INSTANCE, i, as_Float(path.instance));
#endif
    }
}
#elif HAS_FEW_TRIANGLES
// LANES rays at a time against everything.
INLINE void intersect_rays(Geometry geometry, Block block, Queue rays) {
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        Vec3 direction = read_vec3(rays, PATH_DIRECTION, i);
        LaneHit hit = closest_of_few(geometry, read_vec3(rays, PATH_ORIGIN, i), direction, read_field(rays, PATH_T, i),
                                     read_uint(rays, PATH_HIT, i)
                                     KEY_ARGUMENT(geometry, block, read_uint(rays, PATH_ID, i), direction));
        write_field(rays, PATH_T, i, hit.t);
        write_field(rays, PATH_U, i, hit.u);
        write_field(rays, PATH_V, i, hit.v);
        write_field(rays, PATH_HIT, i, as_Float(hit.slot));
    }
}
#elif HAS_PACKETS
// LANES rays at a time through the hierarchy.
INLINE void intersect_rays(Geometry geometry, Block block, Queue rays) {
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        RayGroup group;
        GroupHit hit;
        load_group(&group, geometry, block, rays, PATH_ORIGIN, PATH_DIRECTION, PATH_T, PATH_HIT, PATH_ID, i);
        trace_closest_group(geometry, &group, lane_bits(lanes_below(i, n)), &hit);
        write_field(rays, PATH_T, i, LANES_OF(hit.t));
        write_field(rays, PATH_U, i, LANES_OF(hit.u));
        write_field(rays, PATH_V, i, LANES_OF(hit.v));
        write_field(rays, PATH_HIT, i, as_Float(*(const UInt *)hit.slot));
    }
}
#else
// Ray by ray through the hierarchy.
INLINE void intersect_rays(Geometry geometry, Block block, Queue rays) {
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        RayGroup group;
        GroupSetup setup;
        load_group(&group, geometry, block, rays, PATH_ORIGIN, PATH_DIRECTION, PATH_T, PATH_HIT, PATH_ID, i);
        uint live = min(LANES + 0u, n - i), sound = set_up_group(&group, lane_bits(lanes_below(i, n)), &setup);
        for (uint k = 0u; k < live; k++) {
            Hit hit = trace_closest_of_group(geometry, &group, &setup, sound, k);
            set_slot(rays, PATH_T, i + k, hit.t);
            set_slot(rays, PATH_U, i + k, hit.u);
            set_slot(rays, PATH_V, i + k, hit.v);
            set_slot(rays, PATH_HIT, i + k, as_float(hit.primitive));
#if HAS_INSTANCES
            set_slot(rays, PATH_INSTANCE, i + k, as_float(hit.instance));
#endif
        }
    }
}
#endif

INLINE uint run_intersect_closest(Block block, const SceneView *scene) {
    Queue rays = QUEUE(block, RAYS);
#if HAS_CLEAR_BOUNDARIES
    follow_paths(block, scene, rays);
#else
    intersect_rays(scene->geometry, block, rays);
#if HAS_MEDIA
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        // What escapes has no end.
        Float escaped = SELECT(read_uint(rays, PATH_HIT, i) == (UInt)HIT_NONE, (Float)INFINITY, read_field(rays, PATH_T, i));
        absorb_along(scene->media, rays, PATH_THROUGHPUT, PATH_MEDIUM, lanes_below(i, n), escaped, i);
    }
#endif
#endif
    return *rays.count;
}

#endif
