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

// The rays of the slots from i on; the others are the queue's fields for their parts.
INLINE void load_group(RayGroup *out, Geometry g, Block block, Queue q, uint origin, uint direction, uint limit, uint from, uint path,
                       uint i) {
    *(Float *)out->ox.value = read_field(q, origin, i);
    *(Float *)out->oy.value = read_field(q, origin + 1u, i);
    *(Float *)out->oz.value = read_field(q, origin + 2u, i);
    *(Float *)out->dx.value = read_field(q, direction, i);
    *(Float *)out->dy.value = read_field(q, direction + 1u, i);
    *(Float *)out->dz.value = read_field(q, direction + 2u, i);
    *(Float *)out->limit.value = read_field(q, limit, i);
    *(UInt *)out->from = read_uint(q, from, i);
#if HAS_MASKS
    *(UInt *)out->key = ray_key(g.opacity, block, read_uint(q, path, i), read_vec3(q, direction, i));
#endif
}
#endif

#endif
