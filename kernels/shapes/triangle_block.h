// One ray against eight triangles (shapes/triangle_test.def).
#ifndef WAVELOBE_SHAPES_TRIANGLE_BLOCK_H
#define WAVELOBE_SHAPES_TRIANGLE_BLOCK_H

#include "shapes/box_test.h"
#include "shapes/near_plane.h"

// The shear that turns the ray into the unit z axis, and the byte offsets of the permuted coordinates within a vertex.
typedef struct {
    float sx, sy, sz;
    uint kx, ky, kz;
    float ox, oy, oz;
} RayShear;

#define BLOCK_ROW_BYTES 32u
#define BLOCK_VERTEX_BYTES 96u
#define BLOCK_PRIMITIVE_BYTES 288u

// By selects: which axis is the largest is anyone's guess, and so would be a branch.
#define BY_AXIS(x_major, y_major, if_x, if_y, if_z) ((x_major) ? (if_x) : (y_major) ? (if_y) : (if_z))

INLINE RayShear ray_shear(const Ray *r) {
    RayShear s;
    float ax = fabs(r->dx), ay = fabs(r->dy), az = fabs(r->dz);
    int x_major = (ax > ay) & (ax > az), y_before_z = ay > az;
    s.kx = BY_AXIS(x_major, y_before_z, 1u, 2u, 0u) * BLOCK_ROW_BYTES;
    s.ky = BY_AXIS(x_major, y_before_z, 2u, 0u, 1u) * BLOCK_ROW_BYTES;
    s.kz = BY_AXIS(x_major, y_before_z, 0u, 1u, 2u) * BLOCK_ROW_BYTES;
    s.ox = BY_AXIS(x_major, y_before_z, r->oy, r->oz, r->ox);
    s.oy = BY_AXIS(x_major, y_before_z, r->oz, r->ox, r->oy);
    s.oz = BY_AXIS(x_major, y_before_z, r->ox, r->oy, r->oz);
    s.sz = 1.0f / BY_AXIS(x_major, y_before_z, r->dx, r->dy, r->dz);
    s.sx = BY_AXIS(x_major, y_before_z, r->dy, r->dz, r->dx) * s.sz;
    s.sy = BY_AXIS(x_major, y_before_z, r->dz, r->dx, r->dy) * s.sz;
    return s;
}

#define TEST_VALUES float8
#define TEST_MASK int8
#define TEST_FUSED madd8
#define TEST(name) name##8
#include "shapes/triangle_test.def"
#undef TEST_VALUES
#undef TEST_MASK
#undef TEST_FUSED
#undef TEST

INLINE Point block_corner(global const uchar *block, uint vertex, uint lane) {
    global const float *row = (global const float *)(block + vertex * BLOCK_VERTEX_BYTES) + lane;
    Point p = {row[0], row[8], row[16]};
    return p;
}

// Decides the lanes of `near`: those hit in (0, limit], with their distances.
INLINE uint hits_near_origin(global const uchar *block, uint near, const Ray *r, float limit, float8 *t) {
    float distance[8] __attribute__((aligned(32)));
    *(float8 *)distance = *t;
    uint hits = 0u;
    do {
        POP_LOWEST_BIT(near, i);
        float d = distance_to_plane(block_corner(block, 0u, i), block_corner(block, 1u, i), block_corner(block, 2u, i),
                                    r->ox, r->oy, r->oz, r->dx, r->dy, r->dz);
        distance[i] = d;
        hits |= ((d > 0.0f) & (d <= limit)) ? 1u << i : 0u;
    } while (near);
    *t = *(float8 *)distance;
    return hits;
}

// Bit i of the result: triangle i is hit in (0, limit]; then t, u and v hold its distance and barycentrics. The triangle
// that the ray leaves is not: it is flat.
INLINE uint intersect_triangle_block(global const uchar *block, const RayShear *s, const Ray *r, float limit, float8 *t, float8 *u,
                                     float8 *v) {
    global const uchar *b1 = block + BLOCK_VERTEX_BYTES, *b2 = block + 2u * BLOCK_VERTEX_BYTES;
    Corners8 c = {
        row8(block, s->kx) - s->ox, row8(block, s->ky) - s->oy, row8(block, s->kz) - s->oz,
        row8(b1, s->kx) - s->ox,    row8(b1, s->ky) - s->oy,    row8(b1, s->kz) - s->oz,
        row8(b2, s->kx) - s->ox,    row8(b2, s->ky) - s->oy,    row8(b2, s->kz) - s->oz,
    };
    Areas8 w;
    // Most blocks end here, before the division.
    uint inside = lane_bits8(shear8(&c, &w, s->sx, s->sy));
    if (LIKELY(inside == 0u)) return 0u;
    inside &= lane_bits8(TRIANGLE_NUMBERS(*(global const uint8 *)(block + BLOCK_PRIMITIVE_BYTES)) != r->from);
    float8 inverse = 1.0f / w.sum, depth = depth8(&c, &w, s->sz);
    *t = depth * inverse;
    *u = w.wb * inverse;
    *v = w.wc * inverse;
    inside &= lane_bits8(*t <= limit);
    if (LIKELY(inside == 0u)) return 0u;
    int8 near = unsure8(&c, depth, s->sz);
    uint hits = inside & lane_bits8((*t > 0.0f) & !near);
    uint unsure = inside & lane_bits8(near);
    if (UNLIKELY(unsure)) hits |= hits_near_origin(block, unsure, r, limit, t);
    return hits;
}

#endif
