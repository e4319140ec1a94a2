// A kernel of its own for a stage: each work-item runs the stage over the block it owns.
#ifndef WAVELOBE_STAGES_STAGE_KERNEL_H
#define WAVELOBE_STAGES_STAGE_KERNEL_H

#include "stages/scene_view.h"

#define STAGE_KERNEL(name)                                                                             \
    kernel void name(global struct BlockHeader *headers, global float *blocks, SCENE_PARAMETERS) {     \
        SceneView scene = SCENE_VIEW;                                                                  \
        run_##name(block_of(headers, blocks, get_global_id(0)), &scene);                               \
    }

#endif
