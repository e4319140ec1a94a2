// Adds the samples of finished blocks to the film: each pixel's in order of sample, in double, so that any division of the
// work gives the same sums. Samples that are not finite are counted and left out.
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#include "core/block.h"
#include "shared/scene.h"

INLINE uint is_finite(float x) { return (as_uint(x) & 0x7f800000u) != 0x7f800000u; }

kernel void accumulate(global struct BlockHeader *headers, global float *blocks,
                       global const struct RenderParameters *parameters, global struct FilmPixel *film) {
    Block block = block_of(headers, blocks, get_global_id(0));
    global struct BlockHeader *h = block.header;
    uint pending = h->count[QUEUE_RAYS] + h->count[QUEUE_SHADOW];
    if (h->path_count == 0u || h->next_path < h->path_count || pending != 0u) return;
    global float *red = radiance_channel(block, 0u), *green = radiance_channel(block, 1u);
    global float *blue = radiance_channel(block, 2u);
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
                nonfinite++;
            }
            red[id] = green[id] = blue[id] = 0.0f;
        }
        out->sum[0] = r, out->sum[1] = g, out->sum[2] = b;
        out->samples += finite;
        out->nonfinite += nonfinite;
    }
    h->path_count = 0u; // free for the next tile
}
