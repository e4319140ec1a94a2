// The buffers that rays are traced through beside those of SURFACE_PARAMETERS, as kernel parameters, and rays as queues hold
// them.
#ifndef WAVELOBE_SHAPES_GEOMETRY_PARAMETERS_H
#define WAVELOBE_SHAPES_GEOMETRY_PARAMETERS_H

#include "core/block.h"
#include "shared/scene.h"

#if HAS_FEW_TRIANGLES
#include "shapes/few_triangles.h"

typedef FewTriangles Geometry;
#define GEOMETRY_PARAMETERS global const float *few_vertices, global const struct FewTriangle *few_triangles
#define GEOMETRY_VIEW {few_vertices, few_triangles, parameters->few_vertex_count, parameters->few_triangle_count}

#else
#include "shapes/traversal.h"

#if HAS_ANALYTIC
#define GEOMETRY_PARAMETERS global const uchar *bvh_nodes, global const uint *analytic_order
#define GEOMETRY_VIEW {bvh_nodes, (global const uchar *)triangle_blocks, analytics, analytic_order}
#else
#define GEOMETRY_PARAMETERS global const uchar *bvh_nodes
#define GEOMETRY_VIEW {bvh_nodes, (global const uchar *)triangle_blocks}
#endif

INLINE Ray slot_ray(Queue q, uint origin, uint direction, uint limit, uint i) {
    Ray r = {slot_float(q, origin, i),    slot_float(q, origin + 1u, i),    slot_float(q, origin + 2u, i),
             slot_float(q, direction, i), slot_float(q, direction + 1u, i), slot_float(q, direction + 2u, i),
             slot_float(q, limit, i)};
    return r;
}
#endif

#endif
