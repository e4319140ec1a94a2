// Diffuse lobes: light sample, and a direction from the diffuse lobe.
#ifndef WAVELOBE_STAGES_SCATTER_DIFFUSE_H
#define WAVELOBE_STAGES_SCATTER_DIFFUSE_H

#include "stages/scatter_smooth.h"

INLINE uint run_scatter_diffuse(Block block, const SceneView *scene) {
    return scatter_smooth(LOBE_CLASS_DIFFUSE, block, QUEUE(block, DIFFUSE), scene);
}

#endif
