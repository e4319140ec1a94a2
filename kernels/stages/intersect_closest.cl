// Finds what each ray of the ray queue hits first, and writes it into the path's slot.
#include "core/block.h"
#include "shapes/geometry_parameters.h"

kernel void intersect_closest(global struct BlockHeader *headers, global float *blocks, GEOMETRY_PARAMETERS) {
    Block block = block_of(headers, blocks, get_global_id(0));
    Geometry geometry = GEOMETRY_VIEW;
    Queue rays = QUEUE(block, RAYS);
    uint n = *rays.count;
    for (uint i = 0u; i < n; i++) {
        Ray r = slot_ray(rays, PATH_ORIGIN, PATH_DIRECTION, PATH_T, i);
        Hit hit = trace_closest(geometry, &r);
        set_slot(rays, PATH_T, i, hit.t);
        set_slot(rays, PATH_U, i, hit.u);
        set_slot(rays, PATH_V, i, hit.v);
        set_slot(rays, PATH_HIT, i, as_float(hit.primitive));
    }
}
