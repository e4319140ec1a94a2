// Glossy lobes: light sample, and a direction from the glossy lobe.
#ifndef WAVELOBE_STAGES_SCATTER_GLOSSY_H
#define WAVELOBE_STAGES_SCATTER_GLOSSY_H

#include "stages/scatter_smooth.h"

INLINE uint run_scatter_glossy(Block block, const SceneView *scene) {
    return scatter_smooth(LOBE_CLASS_GLOSSY, block, QUEUE(block, GLOSSY), scene);
}

#endif
