// Starts paths: fills the free slots of the ray queue with camera rays of the block's next path ids.
#ifndef WAVELOBE_STAGES_GENERATE_H
#define WAVELOBE_STAGES_GENERATE_H

#include "stages/camera.h"
#include "stages/start_path.h"

// The ids of paths `next` and those after. As many samples of a pixel as there are lanes are started together, or the largest power of
// two that its samples can be divided by: they see more alike than neighbours do.
INLINE UInt started_ids(uint next, uint path_count) {
    UInt started = LANE_INDEX + (UInt)next;
#if LANES > 1
    uint samples = path_count / TILE_PIXELS, digits = samples == 0u ? 0u : min(lowest_bit(samples), lowest_bit(LANES + 0u));
    UInt turn = started >> digits, within = started & ((1u << digits) - 1u);
    return (((turn / TILE_PIXELS) << digits) + within) * TILE_PIXELS + turn % TILE_PIXELS;
#else
    return started;
#endif
}

INLINE uint run_generate(Block block, const SceneView *scene) {
    Queue rays = QUEUE(block, RAYS);
    global const struct RenderParameters *p = scene->parameters;
    uint count = *rays.count, next = block.header->next_path, end = block.header->path_count;
    while (count + LANES <= BLOCK_SLOTS && next < end) {
        UInt id = started_ids(next, end);
        UInt px = path_pixel_x(block, id), py = path_pixel_y(block, id);
        // Tiles at the edge of the window reach beyond it.
        Int inside = (px - (UInt)p->window_x < (UInt)p->window_width) & (py - (UInt)p->window_y < (UInt)p->window_height);
        uint bits = lane_bits(inside);
        next += LANES;
        if (bits == 0u) continue;
        FilmSample at = film_sample(block, scene, id);
        CameraRay r = camera_ray(p, at.id, at.x, at.y);
        count = append_first_rays(rays, count, p, r.origin, r.direction, r.length, id, bits);
    }
    uint started = count - *rays.count;
    block.header->started = started;
    *rays.count = count;
    block.header->next_path = next;
    return started;
}

#endif
