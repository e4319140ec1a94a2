// Diffuse lobes: light sample, and a direction from the diffuse lobe.
#include "stages/scatter_smooth.h"

kernel void scatter_diffuse(global struct BlockHeader *headers, global float *blocks, SMOOTH_PARAMETERS) {
    Block block = block_of(headers, blocks, get_global_id(0));
    SurfaceView view = SURFACE_VIEW;
    LightInput lights_of_lanes = SMOOTH_LIGHTS;
    scatter_smooth(LOBE_CLASS_DIFFUSE, block, QUEUE(block, DIFFUSE), view, lights_of_lanes, parameters, TEXTURE_ARGUMENTS);
}
