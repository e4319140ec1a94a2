// Estimates a tile's error from two pictures of it that share no random number: their difference is all noise.
#ifndef WAVELOBE_STAGES_TILE_ERROR_H
#define WAVELOBE_STAGES_TILE_ERROR_H

#include "stages/scene_view.h"

// Pixels whose ids share all but the last four bits are a 4 x 4 square.
#define SQUARE_PIXELS 16u

// Both halves' sample means of a pixel, mean of the two and half of their difference, which is as large as the mean's error is
// expected to be.
typedef struct {
    double mean[3], error[3];
    uint seen; // both halves have samples of it
} PixelEstimate;

INLINE PixelEstimate estimate_pixel(Block block, const SceneView *scene, uint pixel) {
    global const struct RenderParameters *p = scene->parameters;
    PixelEstimate e = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0u};
    uint x = block.header->tile_x + TILE_X(pixel) - p->window_x, y = block.header->tile_y + TILE_Y(pixel) - p->window_y;
    if (x >= p->window_width || y >= p->window_height) return e;
    global const struct FilmPixel *a = scene->film + (size_t)y * p->window_width + x;
    global const struct FilmPixel *b = a + (size_t)p->window_width * p->window_height;
    if (a->samples == 0u || b->samples == 0u) return e;
    e.seen = 1u;
    for (uint c = 0u; c < 3u; c++) {
        double of_a = a->sum[c] / a->samples, of_b = b->sum[c] / b->samples;
        e.mean[c] = 0.5 * (of_a + of_b);
        e.error[c] = 0.5 * (of_a - of_b);
    }
    return e;
}

// Relative squared errors as relMSE has them, x^2 / (reference^2 + 0.01), of one square of pixels: sum, and sum of squares. The
// square of the unknown reference is taken as the pixel's own mean times that of its square: a pixel's own alone is large
// just where its error is, the other alone is wrong at edges.
INLINE uint square_error(Block block, const SceneView *scene, uint first, double *sum, double *squares) {
    PixelEstimate pixels[SQUARE_PIXELS];
    double mean[3] = {0.0, 0.0, 0.0};
    uint seen = 0u;
    for (uint i = 0u; i < SQUARE_PIXELS; i++) {
        pixels[i] = estimate_pixel(block, scene, first + i);
        for (uint c = 0u; c < 3u; c++) mean[c] += pixels[i].mean[c];
        seen += pixels[i].seen;
    }
    for (uint i = 0u; i < SQUARE_PIXELS; i++) {
        double error = 0.0;
        for (uint c = 0u; c < 3u; c++) {
            double reference2 = pixels[i].mean[c] * mean[c] / max(seen, 1u);
            error += pixels[i].error[c] * pixels[i].error[c] / (reference2 + 0.01) / 3.0;
        }
        *sum += error;
        *squares += error * error;
    }
    return seen;
}

// Leaves in the block's header an estimate of its tile's relMSE and of the estimate's own standard error.
INLINE void estimate_tile_error(Block block, const SceneView *scene) {
    double sum = 0.0, squares = 0.0;
    uint seen = 0u;
    for (uint first = 0u; first < TILE_PIXELS; first += SQUARE_PIXELS) {
        seen += square_error(block, scene, first, &sum, &squares);
    }
    double count = max(seen, 1u), mean = sum / count;
    block.header->error = (float)mean;
    block.header->error_deviation = (float)sqrt(max(squares / count - mean * mean, 0.0) / count);
}

#endif
