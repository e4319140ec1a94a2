// Traces the shadow queue; a light that is seen adds its contribution to the path's radiance.
#include "core/block.h"
#include "shapes/geometry_parameters.h"

kernel void intersect_shadow(global struct BlockHeader *headers, global float *blocks, GEOMETRY_PARAMETERS) {
    Block block = block_of(headers, blocks, get_global_id(0));
    Geometry geometry = GEOMETRY_VIEW;
    Queue shadow = QUEUE(block, SHADOW);
    uint n = *shadow.count;
    for (uint i = 0u; i < n; i++) {
        Ray r = slot_ray(shadow, SHADOW_ORIGIN, SHADOW_DIRECTION, SHADOW_T, i);
        if (trace_any(geometry, &r)) continue;
        uint id = slot_uint(shadow, SHADOW_ID, i);
        for (uint c = 0u; c < 3u; c++) radiance_channel(block, c)[id] += slot_float(shadow, SHADOW_CONTRIBUTION + c, i);
    }
    *shadow.count = 0u;
}
