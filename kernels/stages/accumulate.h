// Adds the samples of finished blocks to the film: each pixel's in order of sample, in double, so that any division of the
// work gives the same sums. Samples that are not finite are counted and left out.
#ifndef WAVELOBE_STAGES_ACCUMULATE_H
#define WAVELOBE_STAGES_ACCUMULATE_H

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#include "stages/scene_view.h"
#if HAS_SIGNED_FILTER || HAS_MOMENTS
#include "stages/camera.h"
#endif
#if HAS_ERROR_ESTIMATE
#include "stages/tile_error.h"
#endif

INLINE uint is_finite(float x) { return (as_uint(x) & 0x7f800000u) != 0x7f800000u; }

#if HAS_MOMENTS
// Adds the squares of each finite sample's RGB and XYZ to those of its pixel.
INLINE void add_moments(Block block, const SceneView *scene) {
    global const struct RenderParameters *p = scene->parameters;
    for (uint id = 0u; id < block.header->path_count; id += LANES) {
        FilmSample at = film_sample(block, scene, LANE_INDEX + (UInt)id);
        for (uint lane = 0u; lane < LANES; lane++) {
            uint pixel = PATH_PIXEL(id + lane, path_digits(block));
            uint x = block.header->tile_x + TILE_X(pixel) - p->window_x;
            uint y = block.header->tile_y + TILE_Y(pixel) - p->window_y;
            if (x >= p->window_width || y >= p->window_height) continue;
            global const float *radiance = radiance_channel(block, 0u) + RADIANCE_AT(id + lane);
            float r = radiance[0], g = radiance[1], b = radiance[2];
            if (!(is_finite(r) & is_finite(g) & is_finite(b))) continue;
            double values[MOMENT_CHANNELS] = {r, g, b, 0.412453 * r + 0.357580 * g + 0.180423 * b,
                                              0.212671 * r + 0.715160 * g + 0.072169 * b,
                                              0.019334 * r + 0.119193 * g + 0.950227 * b};
            global double *sums = scene->moment_film + ((size_t)y * p->window_width + x) * MOMENT_CHANNELS;
            for (uint c = 0u; c < MOMENT_CHANNELS; c++) sums[c] += ((const float *)&at.weight)[lane] * values[c] * values[c];
        }
    }
}
#endif

#if HAS_SIGNED_FILTER
// Each sample by what its place under the filter counts.
INLINE void weigh_samples(Block block, const SceneView *scene) {
    for (uint first = 0u; first < block.header->path_count; first += LANES) {
        Float weight = film_sample(block, scene, LANE_INDEX + (UInt)first).weight;
        for (uint c = 0u; c < 3u; c++) {
            global float *channel = radiance_channel(block, c);
            UInt at = RADIANCE_AT(LANE_INDEX + (UInt)first);
            scatter(channel, at, gather(channel, at) * weight, lane_bits(TRUE_MASK));
        }
    }
}
#endif

INLINE uint run_accumulate(Block block, const SceneView *scene) {
    global const struct RenderParameters *parameters = scene->parameters;
    global struct BlockHeader *h = block.header;
    uint pending = h->count[QUEUE_RAYS] + h->count[QUEUE_SHADOW];
    if (h->path_count == 0u || h->next_path < h->path_count || pending != 0u) return 0u;
#if HAS_MOMENTS
    add_moments(block, scene);
#endif
#if HAS_SIGNED_FILTER
    weigh_samples(block, scene);
#endif
    global struct FilmPixel *film = scene->film;
#if HAS_ERROR_ESTIMATE
    film += HALF_OF(h->first_sample) * (size_t)parameters->window_width * parameters->window_height;
#endif
    uint samples = 0u, digits = path_digits(block), of_pixel = h->path_count / TILE_PIXELS;
    for (uint pixel = 0u; pixel < TILE_PIXELS; pixel++) {
        uint x = h->tile_x + TILE_X(pixel) - parameters->window_x;
        uint y = h->tile_y + TILE_Y(pixel) - parameters->window_y;
        if (x >= parameters->window_width || y >= parameters->window_height) continue;
        global struct FilmPixel *out = film + (size_t)y * parameters->window_width + x;
        double r = out->sum[0], g = out->sum[1], b = out->sum[2];
        uint finite = 0u, nonfinite = 0u;
        for (uint sample = 0u; sample < of_pixel; sample++) {
            uint id = ID_OF_PATH(pixel, sample, digits);
            global float *radiance = radiance_channel(block, 0u) + RADIANCE_AT(id);
            if (is_finite(radiance[0]) & is_finite(radiance[1]) & is_finite(radiance[2])) {
                r += radiance[0];
                g += radiance[1];
                b += radiance[2];
                finite++;
            } else {
                h->nonfinite_path = id;
                h->nonfinite_stage = breaking_stage(radiance[0]);
                nonfinite++;
            }
            radiance[0] = radiance[1] = radiance[2] = 0.0f;
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
