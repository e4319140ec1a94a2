// A ray, or a packet of rays, against the eight boxes of a node on float8.
// Boxes are widened on their far side so that a ray that grazes them is never lost to rounding (Ize 2013, "Robust BVH Ray
// Traversal").
#ifndef WAVELOBE_SHAPES_BOX_TEST_H
#define WAVELOBE_SHAPES_BOX_TEST_H

#include "core/rounding.h"
#include "shapes/ray.h"

INLINE float8 row8(global const uchar *base, uint byte_offset) {
    return *(global const float8 *)(base + byte_offset);
}

// Per ray, or per packet of rays: reciprocals, and the byte offsets of the near and far rows of a node.
typedef struct {
    float near_ox, near_oy, near_oz; // origin, or bounds of several
    float far_ox, far_oy, far_oz;
    float near_x, near_y, near_z; // reciprocal direction
    float far_x, far_y, far_z;    // the same, widened
    uint near_row_x, near_row_y, near_row_z;
    uint far_row_x, far_row_y, far_row_z;
} BoxTest;

#define NODE_ROW_BYTES 32u
#define NODE_CHILD_BYTES 192u
#define FAR_WIDENING (1.0f + 2.0f * GAMMA(3))
// Boxes are searched a little beyond the limit and the nearest hit: a triangle's distance may round to less than that of its box.
#define REACH(t) ((t) * FAR_WIDENING)

// A component of a unit direction this small moves a ray by less than the smallest step of any coordinate; keeping its
// reciprocal finite avoids 0 * infinity for origins that lie on a box.
INLINE float reciprocal_direction(float d) {
    const float least = 0x1p-60f;
    return 1.0f / (fabs(d) < least ? copysign(least, d) : d);
}

INLINE Float reciprocal_lanes(Float d) {
    const Float least = (Float)0x1p-60f;
    return 1.0f / SELECT(fabs(d) < least, as_Float(as_UInt(least) | (as_UInt(d) & (UInt)0x80000000u)), d);
}

// By the signs of the direction: 1 where negative.
INLINE void choose_rows(BoxTest *b, uint sx, uint sy, uint sz) {
    b->near_row_x = sx * NODE_ROW_BYTES, b->far_row_x = (1u - sx) * NODE_ROW_BYTES;
    b->near_row_y = (2u + sy) * NODE_ROW_BYTES, b->far_row_y = (3u - sy) * NODE_ROW_BYTES;
    b->near_row_z = (4u + sz) * NODE_ROW_BYTES, b->far_row_z = (5u - sz) * NODE_ROW_BYTES;
}

// Of one ray, by its origin and the reciprocal of its direction.
INLINE BoxTest box_test_of(float ox, float oy, float oz, float x, float y, float z) {
    BoxTest b;
    b.near_ox = b.far_ox = ox, b.near_oy = b.far_oy = oy, b.near_oz = b.far_oz = oz;
    b.near_x = x, b.near_y = y, b.near_z = z;
    b.far_x = b.near_x * FAR_WIDENING, b.far_y = b.near_y * FAR_WIDENING, b.far_z = b.near_z * FAR_WIDENING;
    choose_rows(&b, b.near_x < 0.0f ? 1u : 0u, b.near_y < 0.0f ? 1u : 0u, b.near_z < 0.0f ? 1u : 0u);
    return b;
}

INLINE BoxTest box_test(const Ray *r) {
    return box_test_of(r->ox, r->oy, r->oz, reciprocal_direction(r->dx), reciprocal_direction(r->dy), reciprocal_direction(r->dz));
}

// Distances at which the eight boxes of a node are entered and left along each axis.
typedef struct {
    float8 near_x, near_y, near_z, far_x, far_y, far_z;
} Slabs;

INLINE Slabs intersect_slabs(global const uchar *node, const BoxTest *b) {
    Slabs s;
    s.near_x = (row8(node, b->near_row_x) - b->near_ox) * b->near_x, s.far_x = (row8(node, b->far_row_x) - b->far_ox) * b->far_x;
    s.near_y = (row8(node, b->near_row_y) - b->near_oy) * b->near_y, s.far_y = (row8(node, b->far_row_y) - b->far_oy) * b->far_y;
    s.near_z = (row8(node, b->near_row_z) - b->near_oz) * b->near_z, s.far_z = (row8(node, b->far_row_z) - b->far_oz) * b->far_z;
    return s;
}

// Bit i: box i is entered, at distance[i], before it is left and before `limit`.
INLINE uint within_slabs(const Slabs *s, float limit, float8 *distance) {
    float8 enter = GREATER(GREATER(s->near_x, s->near_y), GREATER(s->near_z, (float8)0.0f));
    float8 leave = LESSER(LESSER(s->far_x, s->far_y), LESSER(s->far_z, (float8)limit));
    *distance = enter;
    return lane_bits8(enter <= leave);
}

// Bit i: the ray meets child i before `limit`, entering at distance[i].
INLINE uint intersect_children(global const uchar *node, const BoxTest *b, float limit, float8 *distance) {
    Slabs s = intersect_slabs(node, b);
    return within_slabs(&s, limit, distance);
}

#endif
