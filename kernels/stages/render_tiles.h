// All stages in one launch: each work-item takes a tile after the other from a common queue and runs its block's rounds to
// their end, without ever waiting for another. The same stages over the same blocks as a launch a stage, so the same bits.
//
// The host defines SCENE_STAGES(X), the scene's stages in order, and includes their headers before this one.
#ifndef WAVELOBE_STAGES_RENDER_TILES_H
#define WAVELOBE_STAGES_RENDER_TILES_H

#include "stages/scene_view.h"

INLINE ulong cycle_count(void) {
#ifdef __x86_64__
    return (ulong)__builtin_readcyclecounter();
#else
    return 0ul;
#endif
}

INLINE void count_stage(global struct StageCounters *counters, uint items, ulong start) {
    counters->calls += items != 0u;
    counters->items += items;
    counters->cycles += cycle_count() - start;
}

INLINE void start_tile(Block block, global const struct TileJob *job) {
    global struct BlockHeader *h = block.header;
    h->tile_x = job->tile_x;
    h->tile_y = job->tile_y;
    h->first_sample = job->first_sample;
    h->path_count = job->path_count;
    h->next_path = 0u;
    h->next_emission_ray = 0u;
    h->nonfinite_path = WAVELOBE_NONE;
}

kernel void render_tiles(global struct BlockHeader *headers, global float *blocks, global struct TileQueue *tile_queue,
                         global struct TileJob *tile_jobs, global struct StageCounters *stage_counters,
                         SCENE_PARAMETERS) {
    Block block = block_of(headers, blocks, get_global_id(0));
    SceneView scene = SCENE_VIEW;
    global struct StageCounters *counters = stage_counters + get_global_id(0) * STAGE_COUNT;
    for (;;) {
        uint job = atomic_inc(&tile_queue->next);
        if (job >= tile_queue->count) break;
        start_tile(block, tile_jobs + job);
        while (block.header->path_count != 0u) { // until accumulate frees the block
#define RUN_STAGE(name, NAME)                                      \
    {                                                              \
        ulong start = cycle_count();                               \
        uint items = run_##name(block, &scene);                    \
        count_stage(counters + STAGE_##NAME, items, start);        \
    }
            SCENE_STAGES(RUN_STAGE)
#undef RUN_STAGE
        }
        tile_jobs[job].nonfinite_path = block.header->nonfinite_path;
        tile_jobs[job].nonfinite_stage = block.header->nonfinite_stage;
#if HAS_ERROR_ESTIMATE
        tile_jobs[job].error = block.header->error;
        tile_jobs[job].error_deviation = block.header->error_deviation;
#endif
    }
}

#endif
