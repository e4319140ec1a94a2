// The bounding volume hierarchy as it lies in memory: eight children a node, eight triangles a leaf block.
#ifndef WAVELOBE_SHARED_BVH_H
#define WAVELOBE_SHARED_BVH_H

#include "shared/types.h"

#define BVH_WIDTH 8u

// A reference to a child: an inner node's index, or with BVH_LEAF set a block of triangles (its index), or with both bits
// a run of analytic shapes: (first entry in the analytic order) * 16 + count.
#define BVH_LEAF 0x80000000u
#define BVH_ANALYTIC 0x40000000u
#define BVH_EMPTY 0xffffffffu

// Bounds of an absent child are lo = +infinity, hi = -infinity. Order of the rows: x, y, z, each lo then hi.
struct BvhNode {
    float bounds[6][8];
    Uint32 child[8];
    Uint32 unused[8]; // keeps nodes on cache lines of their own
};
WAVELOBE_CHECK_SIZE(BvhNode, 256);

// Rows: x, y, z of the first, second and third vertex of eight triangles. Absent triangles are all zero, which no ray hits.
struct TriangleBlock {
    float vertex[9][8];
    Uint32 primitive[8]; // with PRIMITIVE_MASKED where rays may pass
};
WAVELOBE_CHECK_SIZE(TriangleBlock, 320);

// Bit of a primitive's id in triangle blocks, few triangles and the analytic order: a ray that hits it asks for its opacity
// (shapes/opacity.h).
#define PRIMITIVE_MASKED 0x80000000u

// Scenes of few triangles have no hierarchy: LANES rays at a time are tested against all of them. Corners are indices of
// distinct vertices.
struct FewTriangle {
    Uint32 corner[3];
    Uint32 slot;      // what a hit names
    Uint32 primitive; // as in its triangle block
};
WAVELOBE_CHECK_SIZE(FewTriangle, 20);

#define FEW_TRIANGLES_MAX 96u
#define FEW_VERTICES_MAX 128u

// What a hit names: block * 8 + lane of a triangle, or HIT_ANALYTIC | index of an analytic shape.
#define HIT_NONE 0xffffffffu
#define HIT_ANALYTIC 0x80000000u

#endif
