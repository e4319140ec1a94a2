// Starts paths: fills the free slots of the ray queue with camera rays of the block's next path ids.
#ifndef WAVELOBE_STAGES_GENERATE_H
#define WAVELOBE_STAGES_GENERATE_H

#include "stages/camera.h"
#include "stages/start_path.h"

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
        count = append_first_rays(rays, count, p, r.origin, r.direction, r.length, id, bits);
    }
    uint started = count - *rays.count;
    block.header->started = started;
    *rays.count = count;
    block.header->next_path = next;
    return started;
}

#endif
