// Adds to the picture's layers what the camera rays that were just traced have hit: each pixel's in order of sample, in double.
// Those of this round are the last of the ray queue.
#ifndef WAVELOBE_STAGES_RECORD_LAYERS_H
#define WAVELOBE_STAGES_RECORD_LAYERS_H

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#include "layers/layer.h"

// The sums of a pixel: number of its samples, then each layer's channels, in order of layers.def, then their squares.
INLINE global double *layer_pixel(const SceneView *scene, uint x, uint y) {
    return scene->layer_film + ((size_t)y * scene->parameters->window_width + x) * LAYER_CHANNELS;
}

INLINE float lane_of(const Float *v, uint lane) { return ((const float *)v)[lane]; }

// All layers of LANES camera rays; returns how many channels.
INLINE uint layer_values(Block block, const SceneView *scene, const TracedPath *path, Int seen, Float *values) {
    Surface surface = load_geometry(scene->surfaces, path);
    LayerInput in;
    in.block = block;
    in.scene = scene;
    in.path = path;
    in.surface = &surface;
#if HAS_LAYER_PARTIALS
    in.partials = uv_partials(scene->surfaces, path, &surface);
#endif
    uint count = 0u;
#define LAYER_VALUES(name, NAME, width)    \
    layer_##name(in, values + count);      \
    count += width;
    SCENE_LAYERS(LAYER_VALUES)
#undef LAYER_VALUES
    for (uint c = 0u; c < count; c++) values[c] = SELECT(seen, values[c], ZERO);
#if HAS_LAYER_COVERAGE && HAS_ENVIRONMENT && ENVIRONMENT_COVERS
    values[0] = ONE; // the first of the list: the environment is seen as well
#endif
    return count;
}

INLINE uint run_record_layers(Block block, const SceneView *scene) {
    Queue rays = QUEUE(block, RAYS);
    global const struct RenderParameters *p = scene->parameters;
    uint n = *rays.count, started = block.header->started;
    for (uint i = n - started; i < n; i += LANES) {
        TracedPath path = read_traced_path(rays, i);
        Int seen = path.live & (path.hit != (UInt)HIT_NONE);
        path.hit = SELECT(seen, path.hit, (UInt)0u);
        Float values[LAYER_CHANNELS];
        uint count = layer_values(block, scene, &path, seen, values);
        Float weight = film_sample(block, scene, path.id).weight;
        UInt x = path_pixel_x(block, path.id) - (UInt)p->window_x, y = path_pixel_y(block, path.id) - (UInt)p->window_y;
        for (uint lane = 0u; lane < min((uint)LANES, n - i); lane++) {
            global double *sums = layer_pixel(scene, ((const uint *)&x)[lane], ((const uint *)&y)[lane]);
            double w = lane_of(&weight, lane);
            sums[0] += 1.0;
            for (uint c = 0u; c < count; c++) {
                double value = lane_of(values + c, lane);
                sums[1u + c] += w * value;
#if HAS_LAYER_SQUARES
                sums[1u + count + c] += w * value * value;
#endif
            }
        }
    }
    return started;
}

#endif
