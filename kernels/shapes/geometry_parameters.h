// The buffers that rays are traced through, as kernel parameters, and rays as queues hold them. The views take what surfaces
// have parameters for already (shapes/surface.h).
#ifndef WAVELOBE_SHAPES_GEOMETRY_PARAMETERS_H
#define WAVELOBE_SHAPES_GEOMETRY_PARAMETERS_H

#include "core/block.h"
#include "shared/scene.h"

#if HAS_OPACITY
#include "shapes/opacity.h"
#define OPACITY_PARAMETER , global const struct Opacity *opacities
#define OPACITY_ARGUMENT , OPACITY_VIEW
#else
#define OPACITY_PARAMETER
#define OPACITY_ARGUMENT
#endif
#if HAS_MASKS
#define KEY_ARGUMENT(geometry, block, path, direction) , ray_key((geometry).opacity, block, path, direction)
#else
#define KEY_ARGUMENT(geometry, block, path, direction)
#endif

#if HAS_FEW_TRIANGLES
#include "shapes/few_facets.h"

typedef FewTriangles Geometry;
#if HAS_ANALYTIC
#define FEW_ANALYTIC_PARAMETER , global const struct FewAnalytic *few_analytics
#define FEW_ANALYTIC_ARGUMENT , analytics, few_analytics
#else
#define FEW_ANALYTIC_PARAMETER
#define FEW_ANALYTIC_ARGUMENT
#endif
#if HAS_MASKS
#define FACET_PARAMETERS
#define FACET_ARGUMENTS
#else
#define FACET_PARAMETERS , global const struct FewFacet *few_facets, global const float *few_corners, global const uint *few_numbers
#define FACET_ARGUMENTS , few_facets, few_corners, few_numbers
#endif
#define GEOMETRY_PARAMETERS                                                               \
    global const float *few_vertices, global const struct FewTriangle *few_triangles FACET_PARAMETERS \
        FEW_ANALYTIC_PARAMETER OPACITY_PARAMETER
#define GEOMETRY_VIEW \
    {few_vertices, few_triangles, &parameters->few FACET_ARGUMENTS FEW_ANALYTIC_ARGUMENT OPACITY_ARGUMENT}

#else
#include "shapes/trace_groups.h"

#if HAS_ANALYTIC
#define ANALYTIC_ORDER_PARAMETER , global const uint *analytic_order
#define ANALYTIC_ORDER_ARGUMENT , analytics, analytic_order
#else
#define ANALYTIC_ORDER_PARAMETER
#define ANALYTIC_ORDER_ARGUMENT
#endif
#define GEOMETRY_PARAMETERS global const uchar *bvh_nodes ANALYTIC_ORDER_PARAMETER OPACITY_PARAMETER
#define GEOMETRY_VIEW \
    {bvh_nodes, (global const uchar *)triangle_blocks ANALYTIC_ORDER_ARGUMENT OPACITY_ARGUMENT INSTANCES_ARGUMENT}

#if HAS_MASKS
INLINE uint slot_key(Geometry g, Block block, Queue q, uint direction, uint path, uint i) {
    Vec3 d = vec3((Float)slot_float(q, direction, i), (Float)slot_float(q, direction + 1u, i),
                  (Float)slot_float(q, direction + 2u, i));
    return FIRST_LANE(ray_key(g.opacity, block, (UInt)slot_uint(q, path, i), d));
}
#endif

// The ray of slot i; the others are the queue's fields for its parts.
INLINE void load_ray(Ray *out, Geometry g, Block block, Queue q, uint origin, uint direction, uint limit, uint from, uint path,
                     uint i) {
    Ray r = {
        slot_float(q, origin, i),    slot_float(q, origin + 1u, i),    slot_float(q, origin + 2u, i),
        slot_float(q, direction, i), slot_float(q, direction + 1u, i), slot_float(q, direction + 2u, i),
        slot_float(q, limit, i),     slot_uint(q, from, i),
#if HAS_MASKS
        slot_key(g, block, q, direction, path, i),
#endif
    };
    *out = r;
}

#if HAS_PACKETS
// The rays of the slots from i on; fields as above.
INLINE void load_group(RayGroup *g, Queue q, uint origin, uint direction, uint limit, uint from, uint i) {
    *(Float *)g->ox.value = read_field(q, origin, i);
    *(Float *)g->oy.value = read_field(q, origin + 1u, i);
    *(Float *)g->oz.value = read_field(q, origin + 2u, i);
    *(Float *)g->dx.value = read_field(q, direction, i);
    *(Float *)g->dy.value = read_field(q, direction + 1u, i);
    *(Float *)g->dz.value = read_field(q, direction + 2u, i);
    *(Float *)g->limit.value = read_field(q, limit, i);
    *(UInt *)g->from = read_uint(q, from, i);
}
#endif
#endif

#endif
