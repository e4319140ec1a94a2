// Adds the samples of finished blocks to the film: each pixel's in order of sample, in double, so that any division of the
// work gives the same sums. Samples that are not finite are counted and left out.
#ifndef WAVELOBE_STAGES_ACCUMULATE_H
#define WAVELOBE_STAGES_ACCUMULATE_H

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#include "stages/scene_view.h"
#if HAS_SIGNED_FILTER
#include "sampling/warps.h"
#include "stages/dimensions.h"
#endif
#if HAS_ERROR_ESTIMATE
#include "stages/tile_error.h"
#endif

INLINE uint is_finite(float x) { return (as_uint(x) & 0x7f800000u) != 0x7f800000u; }

#if HAS_SIGNED_FILTER
// Each sample by what its place under the filter counts.
INLINE void weigh_samples(Block block, const SceneView *scene) {
    for (uint first = 0u; first < block.header->path_count; first += LANES) {
        Float u1, u2;
        sample_2d(path_sample_id(block, LANE_INDEX + (UInt)first, scene->parameters->seed), (UInt)PAIR_FILM, &u1, &u2);
        Float weight = filter_weight(scene->filter_table, u1) * filter_weight(scene->filter_table, u2);
        for (uint c = 0u; c < 3u; c++) {
            global float *channel = radiance_channel(block, c) + first;
            store(channel, load(channel) * weight);
        }
    }
}
#endif

INLINE uint run_accumulate(Block block, const SceneView *scene) {
    global const struct RenderParameters *parameters = scene->parameters;
    global struct BlockHeader *h = block.header;
    uint pending = h->count[QUEUE_RAYS] + h->count[QUEUE_SHADOW];
    if (h->path_count == 0u || h->next_path < h->path_count || pending != 0u) return 0u;
#if HAS_SIGNED_FILTER
    weigh_samples(block, scene);
#endif
    global float *red = radiance_channel(block, 0u), *green = radiance_channel(block, 1u);
    global float *blue = radiance_channel(block, 2u);
    global struct FilmPixel *film = scene->film;
#if HAS_ERROR_ESTIMATE
    film += HALF_OF(h->first_sample) * (size_t)parameters->window_width * parameters->window_height;
#endif
    uint samples = 0u;
    for (uint pixel = 0u; pixel < TILE_PIXELS; pixel++) {
        uint x = h->tile_x + TILE_X(pixel) - parameters->window_x;
        uint y = h->tile_y + TILE_Y(pixel) - parameters->window_y;
        if (x >= parameters->window_width || y >= parameters->window_height) continue;
        global struct FilmPixel *out = film + (size_t)y * parameters->window_width + x;
        double r = out->sum[0], g = out->sum[1], b = out->sum[2];
        uint finite = 0u, nonfinite = 0u;
        for (uint id = pixel; id < h->path_count; id += TILE_PIXELS) {
            if (is_finite(red[id]) & is_finite(green[id]) & is_finite(blue[id])) {
                r += red[id];
                g += green[id];
                b += blue[id];
                finite++;
            } else {
                h->nonfinite_path = id;
                h->nonfinite_stage = breaking_stage(red[id]);
                nonfinite++;
            }
            red[id] = green[id] = blue[id] = 0.0f;
        }
        out->sum[0] = r, out->sum[1] = g, out->sum[2] = b;
        out->samples += finite;
        out->nonfinite += nonfinite;
        samples += finite + nonfinite;
    }
#if HAS_ERROR_ESTIMATE
    estimate_tile_error(block, scene);
#endif
    h->path_count = 0u; // free for the next tile
    return samples;
}

#endif
