// The buffers that rays are traced through, as kernel parameters, and rays as queues hold them.
#ifndef WAVELOBE_SHAPES_GEOMETRY_PARAMETERS_H
#define WAVELOBE_SHAPES_GEOMETRY_PARAMETERS_H

#include "core/block.h"

#if HAS_MASKS
#include "shapes/opacity.h"
#define GEOMETRY_OPACITY_PARAMETERS , OPACITY_PARAMETERS
#define GEOMETRY_OPACITY_VIEW , OPACITY_VIEW
#define KEY_ARGUMENT(geometry, path, direction) , ray_key((geometry).opacity, path, direction)
#else
#define GEOMETRY_OPACITY_PARAMETERS
#define GEOMETRY_OPACITY_VIEW
#define KEY_ARGUMENT(geometry, path, direction)
#endif

#if HAS_FEW_TRIANGLES
#include "shapes/few_triangles.h"

typedef FewTriangles Geometry;
#define GEOMETRY_PARAMETERS                                                                      \
    global const struct RenderParameters *parameters, global const float *few_vertices,          \
        global const struct FewTriangle *few_triangles GEOMETRY_OPACITY_PARAMETERS
#define GEOMETRY_VIEW                                                                                   \
    {few_vertices, few_triangles, parameters->few_vertex_count, parameters->few_triangle_count          \
     GEOMETRY_OPACITY_VIEW}

#else
#include "shapes/traversal.h"

#if HAS_ANALYTIC
#define GEOMETRY_ANALYTIC_PARAMETERS , global const struct Analytic *analytics, global const uint *analytic_order
#define GEOMETRY_ANALYTIC_VIEW , analytics, analytic_order
#else
#define GEOMETRY_ANALYTIC_PARAMETERS
#define GEOMETRY_ANALYTIC_VIEW
#endif
#if HAS_MASKS
#define GEOMETRY_RENDER_PARAMETERS global const struct RenderParameters *parameters,
#else
#define GEOMETRY_RENDER_PARAMETERS
#endif
#define GEOMETRY_PARAMETERS                                                                                         \
    GEOMETRY_RENDER_PARAMETERS global const uchar *bvh_nodes, global const uchar *triangle_blocks                   \
        GEOMETRY_ANALYTIC_PARAMETERS GEOMETRY_OPACITY_PARAMETERS
#define GEOMETRY_VIEW {bvh_nodes, triangle_blocks GEOMETRY_ANALYTIC_VIEW GEOMETRY_OPACITY_VIEW}

#if LANES == 1
#define FIRST_LANE(v) (v)
#else
#define FIRST_LANE(v) (v).s0
#endif

// The ray of slot i; `origin`, `direction`, `limit` and `path` are the queue's fields for them.
INLINE Ray slot_ray(Geometry g, Queue q, uint origin, uint direction, uint limit, uint path, uint i) {
    Ray r = {slot_float(q, origin, i),    slot_float(q, origin + 1u, i),    slot_float(q, origin + 2u, i),
             slot_float(q, direction, i), slot_float(q, direction + 1u, i), slot_float(q, direction + 2u, i),
             slot_float(q, limit, i)};
#if HAS_MASKS
    UInt id = (UInt)slot_uint(q, path, i);
    r.key = FIRST_LANE(ray_key(g.opacity, id, vec3((Float)r.dx, (Float)r.dy, (Float)r.dz)));
#endif
    return r;
}
#endif

#endif
