// Starts paths: fills the free slots of the ray queue with camera rays of the block's next path ids.
#ifndef WAVELOBE_STAGES_GENERATE_H
#define WAVELOBE_STAGES_GENERATE_H

#include "shared/bvh.h"
#include "stages/camera.h"

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
        FilmSample at = film_sample(block, scene, id);
        CameraRay r = camera_ray(p, at.id, at.x, at.y);
        append_vec3(rays, PATH_ORIGIN, count, r.origin, bits);
        append_vec3(rays, PATH_DIRECTION, count, r.direction, bits);
        append_field(rays, PATH_T, count, r.length, bits);
        append_uint(rays, PATH_HIT, count, (UInt)HIT_NONE, bits);
        append_vec3(rays, PATH_THROUGHPUT, count, vec3_all(ONE), bits);
        append_field(rays, PATH_PDF, count, (Float)-1.0f, bits);
        append_uint(rays, PATH_ID, count, id, bits);
        append_uint(rays, PATH_DEPTH, count, (UInt)0u, bits);
#if HAS_MEDIA
        append_uint(rays, PATH_MEDIUM, count, (UInt)p->camera_medium, bits);
#endif
#if HAS_PATH_ETA
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
