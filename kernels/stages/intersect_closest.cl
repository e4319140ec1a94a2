// Finds what each ray of the ray queue hits first, and writes it into the path's slot.
#include "shapes/geometry_parameters.h"

#if HAS_FEW_TRIANGLES
// LANES rays at a time against everything.
INLINE void intersect_rays(Geometry geometry, Queue rays) {
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        LaneHit hit = closest_of_few(geometry, read_vec3(rays, PATH_ORIGIN, i), read_vec3(rays, PATH_DIRECTION, i),
                                     read_field(rays, PATH_T, i), read_uint(rays, PATH_HIT, i));
        write_field(rays, PATH_T, i, hit.t);
        write_field(rays, PATH_U, i, hit.u);
        write_field(rays, PATH_V, i, hit.v);
        write_field(rays, PATH_HIT, i, as_Float(hit.slot));
    }
}
#else
// Ray by ray through the hierarchy.
INLINE void intersect_rays(Geometry geometry, Queue rays) {
    uint n = *rays.count;
    for (uint i = 0u; i < n; i++) {
        Ray r = slot_ray(rays, PATH_ORIGIN, PATH_DIRECTION, PATH_T, PATH_HIT, i);
        Hit hit = trace_closest(geometry, &r);
        set_slot(rays, PATH_T, i, hit.t);
        set_slot(rays, PATH_U, i, hit.u);
        set_slot(rays, PATH_V, i, hit.v);
        set_slot(rays, PATH_HIT, i, as_float(hit.primitive));
    }
}
#endif

kernel void intersect_closest(global struct BlockHeader *headers, global float *blocks, GEOMETRY_PARAMETERS) {
    Block block = block_of(headers, blocks, get_global_id(0));
    Geometry geometry = GEOMETRY_VIEW;
    intersect_rays(geometry, QUEUE(block, RAYS));
}
