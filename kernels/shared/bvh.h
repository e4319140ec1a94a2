// The bounding volume hierarchy as it lies in memory: eight children a node, eight triangles a leaf block.
#ifndef WAVELOBE_SHARED_BVH_H
#define WAVELOBE_SHARED_BVH_H

#include "shared/types.h"

#define BVH_WIDTH 8u

// A reference to a child: an inner node's index, or with BVH_LEAF set a block of triangles (its index), or with both bits
// a run of analytic shapes: (first entry in the analytic order) * 16 + count, or with BVH_LEAF and BVH_INSTANCE set an
// instance (its index), in scenes that have some.
#define BVH_LEAF 0x80000000u
#define BVH_ANALYTIC 0x40000000u
#define BVH_INSTANCE 0x20000000u
#define BVH_RETURN 0xfffffffeu // on the stack: back from an instance
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
    Uint32 facet;     // that it is part of
};
WAVELOBE_CHECK_SIZE(FewTriangle, 24);

// What stages want to know of the triangle that a ray hit, by its slot: one row of words (core/rows.h).
struct FewSlot {
    float corners[9];
    struct Packed3 normal; // unit
    Uint32 primitive, shape;
    Uint32 front_material; // of the shape
    Uint32 unused;
};
WAVELOBE_CHECK_SIZE(FewSlot, 4 * ROW_WORDS);

#define FEW_TRIANGLES_MAX 96u // a multiple of LANES
#define FEW_VERTICES_MAX 128u

// A parallelogram of two of them, or a triangle left over: where u and v are between -1 and 1, and of a triangle u + v is not above
// zero. All in the unit of the set, points relative to its center.
struct FewFacet {
    float normal[3], offset;            // unit; of the points p of the plane normal . p is the offset
    float u[4], v[4];                   // u is the product of the first three with a point, plus the fourth
    float height_u, height_v, height_w; // what u, v and u + v are to be multiplied with to be distances
    Uint32 part[2];                     // triangles on either side of u + v = 0: FACET_PART
    Uint32 plane;                       // the first facet that lies in the same one
};
WAVELOBE_CHECK_SIZE(FewFacet, 72);

// A slot, and what the second and third corner of its triangle are: 0: the one across from u + v = 0; 1: where u, 2: where v is larger
// than in the middle, seen from that one.
#define FACET_PART(slot, second, third) ((slot) | (second) << 28 | (third) << 30)
#define FACET_NONE 0xffffffffu

// Corners of the facets, FEW_TRIANGLES_MAX values a row, to see LANES of them at once: x, y and z of each corner and of the normal,
// as long as twice the area of a triangle. A triangle's last corner is there twice.
#define FEW_CORNER_ROWS 15u

// Their spheres, disks and cylinders, each within its box.
struct FewAnalytic {
    float lower[3], upper[3];
    Uint32 entry; // as in the analytic order
};
WAVELOBE_CHECK_SIZE(FewAnalytic, 28);

#define FEW_ANALYTIC_MAX 16u

// Vertices are kept in a unit of length of their own, a power of two near the size of the set, so that products of several
// lengths neither overflow nor vanish whatever the unit of the scene. A sphere around all of them, in that unit:
struct FewSummary {
    float center[3];
    float radius;
    float per_length; // units in one of the scene's
    Uint32 triangle_count, vertex_count, analytic_count;
    Uint32 facet_count, parallelogram_count; // those come first
    Uint32 number_count;                     // triangle numbers that few_numbers has the facet of
};
WAVELOBE_CHECK_SIZE(FewSummary, 44);

// One place where a group of shapes stands. A point p of the group is at to_world's linear part times p plus its
// translation; rays are taken to the group by the inverse linear part, from that translation on.
struct Instance {
    struct Affine to_world;
    float to_object[9]; // rows of the inverse linear part
    Uint32 root;        // node of the group's own hierarchy
};
WAVELOBE_CHECK_SIZE(Instance, 88);

#define INSTANCE_NONE 0xffffffffu

// What a hit names: block * 8 + lane of a triangle, or HIT_ANALYTIC | index of an analytic shape.
#define HIT_NONE 0xffffffffu
#define HIT_ANALYTIC 0x80000000u

#endif
