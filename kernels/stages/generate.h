// Starts paths: fills the free slots of the ray queue with camera rays of the block's next path ids.
#ifndef WAVELOBE_STAGES_GENERATE_H
#define WAVELOBE_STAGES_GENERATE_H

#include "core/math.h"
#include "sampling/warps.h"
#include "shared/bvh.h"
#include "stages/dimensions.h"
#include "stages/scene_view.h"

INLINE Vec3 transform_vector(global const struct Affine *a, Vec3 v) {
    return vec3(madd(v.x, (Float)a->m[0], madd(v.y, (Float)a->m[1], v.z * a->m[2])),
                madd(v.x, (Float)a->m[4], madd(v.y, (Float)a->m[5], v.z * a->m[6])),
                madd(v.x, (Float)a->m[8], madd(v.y, (Float)a->m[9], v.z * a->m[10])));
}

INLINE uint run_generate(Block block, const SceneView *scene) {
    Queue rays = QUEUE(block, RAYS);
    global const struct RenderParameters *p = scene->parameters;
    uint count = *rays.count, next = block.header->next_path, end = block.header->path_count;
    while (count + LANES <= BLOCK_SLOTS && next < end) {
        UInt id = LANE_INDEX + (UInt)next;
        UInt px = path_pixel_x(block, id), py = path_pixel_y(block, id);
        // Tiles at the edge of the window reach beyond it.
        Int inside = (px - (UInt)p->window_x < (UInt)p->window_width) & (py - (UInt)p->window_y < (UInt)p->window_height);
        uint bits = lane_bits(inside);
        next += LANES;
        if (bits == 0u) continue;
        Float u1, u2;
        sample_2d(path_sample_id(block, id, p->seed), (UInt)PAIR_FILM, &u1, &u2);
        Float film_x = convert_Float(as_Int(px)) + 0.5f + sample_filter(scene->filter_table, u1);
        Float film_y = convert_Float(as_Int(py)) + 0.5f + sample_filter(scene->filter_table, u2);
        Vec3 on_plane = vec3(madd(film_x, (Float)p->x_scale, (Float)p->x_offset),
                          madd(film_y, (Float)p->y_scale, (Float)p->y_offset), ONE);
        Float stretch = sqrt(length_squared(on_plane)); // distance along the ray a unit of depth
        Vec3 direction = normalize3(transform_vector(&p->camera_to_world, on_plane));
        global const float *m = p->camera_to_world.m;
        Vec3 eye = vec3((Float)m[3], (Float)m[7], (Float)m[11]);
        append_vec3(rays, PATH_ORIGIN, count, scale_add(direction, stretch * p->near_clip, eye), bits);
        append_vec3(rays, PATH_DIRECTION, count, direction, bits);
        append_field(rays, PATH_T, count, stretch * (p->far_clip - p->near_clip), bits);
        append_uint(rays, PATH_HIT, count, (UInt)HIT_NONE, bits);
        append_vec3(rays, PATH_THROUGHPUT, count, vec3_all(ONE), bits);
        append_field(rays, PATH_PDF, count, (Float)-1.0f, bits);
        append_uint(rays, PATH_ID, count, id, bits);
        append_uint(rays, PATH_DEPTH, count, (UInt)0u, bits);
#if HAS_MEDIA
        append_uint(rays, PATH_MEDIUM, count, (UInt)p->camera_medium, bits);
#endif
#if HAS_TRANSMISSION
        append_field(rays, PATH_ETA, count, ONE, bits);
#endif
        count += popcount(bits);
    }
    uint started = count - *rays.count;
    block.header->started = started;
    *rays.count = count;
    block.header->next_path = next;
    return started;
}

#endif
