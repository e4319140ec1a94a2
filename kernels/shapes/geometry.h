// What rays are traced through: the hierarchy and, where the scene has them, what lies in its leaves beside triangles.
#ifndef WAVELOBE_SHAPES_GEOMETRY_H
#define WAVELOBE_SHAPES_GEOMETRY_H

#include "core/lanes.h"
#include "shared/bvh.h"
#if HAS_OPACITY
#include "shapes/opacity.h"
#endif

typedef struct {
    global const uchar *nodes;  // BvhNode
    global const uchar *blocks; // TriangleBlock
#if HAS_ANALYTIC
    global const struct Analytic *analytics;
    global const uint *analytic_order;
#endif
#if HAS_OPACITY
    OpacityView opacity;
#endif
#if HAS_INSTANCES
    global const struct Instance *instances;
#endif
} Geometry;

#define NODE_SHIFT 8u // nodes are 256 bytes

// Asks for the node or the block that a reference names, to have it in the cache when its turn comes. (What else lies in
// leaves is small and few: asking for the wrong thing does no harm.)
INLINE void fetch_ahead(Geometry g, uint reference) {
    int leaf = (reference & BVH_LEAF) != 0u;
    ulong block = (ulong)g.blocks + (ulong)(reference & ~BVH_LEAF) * sizeof(struct TriangleBlock);
    ulong start = leaf ? block : (ulong)g.nodes + ((ulong)reference << NODE_SHIFT);
    fetch_line(start);
    fetch_line(start + 64ul);
    fetch_line(start + 128ul);
    fetch_line(start + 192ul);
    fetch_line(start + (leaf ? 256ul : 0ul)); // blocks are longer than nodes
}

#endif
