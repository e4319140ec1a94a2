// Starts paths: fills the free slots of the ray queue with camera rays of the block's next path ids.
#ifndef WAVELOBE_STAGES_GENERATE_H
#define WAVELOBE_STAGES_GENERATE_H

#include "stages/camera.h"
#include "stages/start_path.h"

// Appends the camera's rays of paths `id`, through where `sample` says, of those inside the window; returns the new count.
INLINE uint append_camera_rays(Block block, const SceneView *scene, Queue rays, uint count, UInt id, SampleId sample, Float throughput, uint depth) {
    global const struct RenderParameters *p = scene->parameters;
    UInt px = path_pixel_x(block, id), py = path_pixel_y(block, id);
    // Tiles at the edge of the window reach beyond it.
    Int inside = (px - (UInt)p->window_x < (UInt)p->window_width) & (py - (UInt)p->window_y < (UInt)p->window_height);
    uint bits = lane_bits(inside);
    if (bits == 0u) return count;
    FilmSample at = film_sample_of(block, scene, id, sample);
    CameraRay r = camera_ray(p, at.id, at.x, at.y);
    return append_first_rays(rays, count, p, r.origin, r.direction, r.length, id, throughput, depth, bits);
}

#if EMISSION_RAYS
// What emits and is as small as a pixel is hit by few of the rays that look for it. The light that the camera sees of shapes is therefore
// found by rays of its own, EMISSION_RAYS in place of each sample's one, which are far cheaper than paths. In rounds before those of the block's
// paths: so a path's radiance is summed up in one order, however many slots there are.
INLINE uint start_emission_rays(Block block, const SceneView *scene, Queue rays) {
    uint count = *rays.count, next = block.header->next_emission_ray, end = block.header->path_count * EMISSION_RAYS;
    while (count + LANES <= SLOTS_TO_START && next < end) {
        UInt ray = LANE_INDEX + (UInt)next;
        UInt id = ray / (UInt)EMISSION_RAYS;
        SampleId sample = path_sample_part(block, id, scene->parameters->sequence, ray % (UInt)EMISSION_RAYS, EMISSION_RAYS);
        count = append_camera_rays(block, scene, rays, count, id, sample, (Float)(1.0f / EMISSION_RAYS), EMISSION_DEPTH);
        next += LANES;
    }
    uint started = count - *rays.count;
    *rays.count = count;
    block.header->next_emission_ray = next;
    block.header->started = 0u; // of which layers are recorded
    return started;
}
#endif

INLINE uint run_generate(Block block, const SceneView *scene) {
    Queue rays = QUEUE(block, RAYS);
#if EMISSION_RAYS
    if (block.header->next_emission_ray < block.header->path_count * EMISSION_RAYS) return start_emission_rays(block, scene, rays);
#endif
    uint count = *rays.count, next = block.header->next_path, end = block.header->path_count;
    while (count + LANES <= SLOTS_TO_START && next < end) {
        UInt id = LANE_INDEX + (UInt)next;
        count = append_camera_rays(block, scene, rays, count, id, path_sample_id(block, id, scene->parameters->sequence), ONE, 0u);
        next += LANES;
    }
    uint started = count - *rays.count;
    block.header->started = started;
    *rays.count = count;
    block.header->next_path = next;
    return started;
}

#endif
