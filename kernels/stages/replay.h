// Renders one path and writes down what it meets, a record a stage that takes it up. The same stages as in a picture, so the
// same path, bit for bit. At width 1: each queue holds the path or nothing.
//
// The host defines SCENE_STAGES(X) and includes the stages' headers before this one.
#ifndef WAVELOBE_STAGES_REPLAY_H
#define WAVELOBE_STAGES_REPLAY_H

#include "stages/scene_view.h"

// The queue that a stage takes its paths from.
INLINE Queue queue_of_stage(Block block, uint stage) {
    switch (stage) {
        case STAGE_SHADE_ESCAPED: return QUEUE(block, ESCAPED);
        case STAGE_SHADE_EMITTED: return QUEUE(block, EMITTED);
        case STAGE_SCATTER_DELTA: return QUEUE(block, DELTA);
        case STAGE_SCATTER_GLOSSY: return QUEUE(block, GLOSSY);
        case STAGE_SCATTER_DIFFUSE: return QUEUE(block, DIFFUSE);
        case STAGE_INTERSECT_SHADOW: return QUEUE(block, SHADOW);
        default: return QUEUE(block, RAYS);
    }
}

INLINE struct Packed3 packed_vec3(Vec3 v) {
    struct Packed3 p = {v.x, v.y, v.z};
    return p;
}

INLINE struct Packed3 path_radiance(Block block, uint id) {
    global const float *radiance = radiance_channel(block, 0u) + RADIANCE_AT(id);
    struct Packed3 p = {radiance[0], radiance[1], radiance[2]};
    return p;
}

INLINE struct ReplayRecord shadow_record(Queue shadow, global const uint *primitive_shapes) {
    struct ReplayRecord r;
    r.stage = STAGE_INTERSECT_SHADOW;
    r.depth = WAVELOBE_NONE;
    r.primitive = slot_uint(shadow, SHADOW_FROM, 0u);
    r.shape = primitive_shapes[r.primitive];
    r.t = slot_float(shadow, SHADOW_T, 0u);
    r.position = packed_vec3(read_vec3(shadow, SHADOW_ORIGIN, 0u));
    r.direction = packed_vec3(read_vec3(shadow, SHADOW_DIRECTION, 0u));
    r.throughput = packed_vec3(read_vec3(shadow, SHADOW_CONTRIBUTION, 0u));
    r.pdf = 0.0f;
    return r;
}

// `start`: of the ray, before it was traced.
INLINE struct ReplayRecord path_record(uint stage, Queue queue, SurfaceView view, Vec3 start) {
    TracedPath path = read_traced_path(queue, 0u);
    struct ReplayRecord r;
    r.stage = stage;
    r.depth = path.depth;
    r.primitive = r.shape = WAVELOBE_NONE;
    r.t = path.t;
    r.position = packed_vec3(start);
    r.direction = packed_vec3(path.direction);
    r.throughput = packed_vec3(path.throughput);
    r.pdf = path.pdf;
    if (path.hit != HIT_NONE) {
        Surface surface = load_surface(view, &path);
        r.primitive = surface.primitive;
        r.shape = surface.shape;
        r.position = packed_vec3(surface.position);
    }
    return r;
}

// What the stage is about to take up, if anything; the ray that sort_paths is about to send on or to end.
INLINE int record_before(Block block, const SceneView *scene, uint stage, Vec3 *start, struct ReplayRecord *record) {
    Queue queue = queue_of_stage(block, stage);
    if (stage < STAGE_SORT_PATHS || stage == STAGE_ACCUMULATE || *queue.count == 0u) return 0;
    if (stage == STAGE_INTERSECT_SHADOW) {
        *record = shadow_record(queue, scene->surfaces.primitive_shapes);
        return 1;
    }
    if (stage == STAGE_SORT_PATHS) *start = read_vec3(queue, PATH_ORIGIN, 0u);
    *record = path_record(stage, queue, scene->surfaces, *start);
    return 1;
}

// Rays are of interest only where the path ends with them: else the stage that they are sorted to tells of them.
INLINE int is_worth_telling(Block block, uint stage) {
    if (stage != STAGE_SORT_PATHS) return 1;
    global const uint *count = block.header->count;
    return count[QUEUE_RAYS] + count[QUEUE_ESCAPED] + count[QUEUE_EMITTED] + count[QUEUE_DELTA] + count[QUEUE_GLOSSY] +
               count[QUEUE_DIFFUSE] == 0u;
}

kernel void replay_path(global struct BlockHeader *headers, global float *blocks, global struct ReplayLog *replay_log,
                        global struct ReplayRecord *replay_records, SCENE_PARAMETERS) {
    Block block = block_of(headers, blocks, 0);
    SceneView scene = SCENE_VIEW;
    global const uint *count = block.header->count;
    uint id = replay_log->path, written = 0u;
    Vec3 start = vec3_all(ZERO);
    struct ReplayRecord record;
    do {
#define REPLAY_STAGE(name, NAME)                                                                   \
    if (STAGE_##NAME != STAGE_ACCUMULATE) {                                                        \
        int found = record_before(block, &scene, STAGE_##NAME, &start, &record);                   \
        run_##name(block, &scene);                                                                 \
        if (found && is_worth_telling(block, STAGE_##NAME)) {                                      \
            record.radiance = path_radiance(block, id);                                            \
            if (written < REPLAY_RECORDS) replay_records[written] = record;                        \
            written++;                                                                             \
        }                                                                                          \
    }
        SCENE_STAGES(REPLAY_STAGE)
#undef REPLAY_STAGE
    } while (count[QUEUE_RAYS] + count[QUEUE_SHADOW] != 0u || block.header->next_path < block.header->path_count);
    replay_log->count = written;
    replay_log->radiance = path_radiance(block, id);
    replay_log->stage = breaking_stage(radiance_channel(block, 0u)[RADIANCE_AT(id)]);
}

#endif
