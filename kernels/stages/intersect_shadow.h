// Traces the shadow queue; a light that is seen adds its contribution to the path's radiance.
#ifndef WAVELOBE_STAGES_INTERSECT_SHADOW_H
#define WAVELOBE_STAGES_INTERSECT_SHADOW_H

#include "stages/scene_view.h"
#if HAS_MEDIA
#include "stages/absorb.h"
#endif

#if HAS_CLEAR_BOUNDARIES
// Through what only parts media, taking off what the media absorb.
INLINE void follow_shadow_rays(Block block, const SceneView *scene, Queue shadow) {
    uint n = *shadow.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = untraced_path(shadow, SHADOW_DIRECTION, SHADOW_T, SHADOW_FROM, SHADOW_ID, i);
        UInt medium = read_uint(shadow, SHADOW_MEDIUM, i);
        Rgb left = follow_rays(block, scene, read_vec3(shadow, SHADOW_ORIGIN, i), &path, &medium, 0);
        Int seen = path.live & (path.hit == (UInt)HIT_NONE);
        add_radiance(block, path.id, mul(read_vec3(shadow, SHADOW_CONTRIBUTION, i), left), lane_bits(seen));
    }
}
#elif HAS_FEW_TRIANGLES
#if HAS_FACETS
#define SHADOW_AIM(shadow, i) read_uint(shadow, SHADOW_TO, i)
#else
#define SHADOW_AIM(shadow, i) (UInt)HIT_NONE
#endif
// LANES rays at a time against everything. A path has one shadow ray at the most, so no two lanes share an id.
INLINE void intersect_shadow_rays(Geometry geometry, Block block, Queue shadow) {
    uint n = *shadow.count;
    for (uint i = 0u; i < n; i += LANES) {
        Int live = lanes_below(i, n);
        UInt id = SELECT(live, read_uint(shadow, SHADOW_ID, i), (UInt)0u);
        Vec3 direction = read_vec3(shadow, SHADOW_DIRECTION, i);
        Int blocked = any_of_few(geometry, read_vec3(shadow, SHADOW_ORIGIN, i), direction, read_field(shadow, SHADOW_T, i),
                                 read_uint(shadow, SHADOW_FROM, i), SHADOW_AIM(shadow, i), live KEY_ARGUMENT(geometry, block, id, direction));
        add_radiance(block, id, read_vec3(shadow, SHADOW_CONTRIBUTION, i), lane_bits(live & !blocked));
    }
}
#elif HAS_PACKETS
// LANES rays at a time through the hierarchy.
INLINE void intersect_shadow_rays(Geometry geometry, Block block, Queue shadow) {
    uint n = *shadow.count;
    for (uint i = 0u; i < n; i += LANES) {
        RayGroup group;
        load_group(&group, geometry, block, shadow, SHADOW_ORIGIN, SHADOW_DIRECTION, SHADOW_T, SHADOW_FROM, SHADOW_ID, i);
        uint live = lane_bits(lanes_below(i, n));
        uint seen = live & ~trace_any_group(geometry, &group, live);
        UInt id = SELECT(lanes_below(i, n), read_uint(shadow, SHADOW_ID, i), (UInt)0u);
        add_radiance(block, id, read_vec3(shadow, SHADOW_CONTRIBUTION, i), seen);
    }
}
#else
// Ray by ray through the hierarchy.
INLINE void intersect_shadow_rays(Geometry geometry, Block block, Queue shadow) {
    uint n = *shadow.count;
    for (uint i = 0u; i < n; i += LANES) {
        RayGroup group;
        GroupSetup setup;
        load_group(&group, geometry, block, shadow, SHADOW_ORIGIN, SHADOW_DIRECTION, SHADOW_T, SHADOW_FROM, SHADOW_ID, i);
        uint live = lane_bits(lanes_below(i, n));
        uint seen = live & ~any_one_by_one(geometry, 0u, set_up_group(&group, live, &setup), &group, &setup);
        UInt id = SELECT(lanes_below(i, n), read_uint(shadow, SHADOW_ID, i), (UInt)0u);
        add_radiance(block, id, read_vec3(shadow, SHADOW_CONTRIBUTION, i), seen);
    }
}
#endif

INLINE uint run_intersect_shadow(Block block, const SceneView *scene) {
    Queue shadow = QUEUE(block, SHADOW);
    uint n = *shadow.count;
#if HAS_CLEAR_BOUNDARIES
    follow_shadow_rays(block, scene, shadow);
#else
#if HAS_MEDIA
    for (uint i = 0u; i < n; i += LANES) {
        absorb_along(scene->media, shadow, SHADOW_CONTRIBUTION, SHADOW_MEDIUM, lanes_below(i, n), read_field(shadow, SHADOW_T, i), i);
    }
#endif
    intersect_shadow_rays(scene->geometry, block, shadow);
#endif
    *shadow.count = 0u;
    return n;
}

#endif
