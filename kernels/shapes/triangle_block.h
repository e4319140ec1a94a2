// One ray against eight triangles, watertight: neighbours that share an edge leave no gap for a ray to slip through.
// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".
#ifndef WAVELOBE_SHAPES_TRIANGLE_BLOCK_H
#define WAVELOBE_SHAPES_TRIANGLE_BLOCK_H

#include "shapes/near_plane.h"
#include "shapes/ray.h"

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
INLINE RayShear ray_shear(const Ray *r) {
    RayShear s;
    float ax = fabs(r->dx), ay = fabs(r->dy), az = fabs(r->dz);
    int x_major = (ax > ay) & (ax > az), y_major = !x_major & (ay > az);
#define BY_MAJOR_AXIS(if_x, if_y, if_z) (x_major ? (if_x) : y_major ? (if_y) : (if_z))
    s.kx = BY_MAJOR_AXIS(1u, 2u, 0u) * BLOCK_ROW_BYTES;
    s.ky = BY_MAJOR_AXIS(2u, 0u, 1u) * BLOCK_ROW_BYTES;
    s.kz = BY_MAJOR_AXIS(0u, 1u, 2u) * BLOCK_ROW_BYTES;
    s.ox = BY_MAJOR_AXIS(r->oy, r->oz, r->ox);
    s.oy = BY_MAJOR_AXIS(r->oz, r->ox, r->oy);
    s.oz = BY_MAJOR_AXIS(r->ox, r->oy, r->oz);
    s.sz = 1.0f / BY_MAJOR_AXIS(r->dx, r->dy, r->dz);
    s.sx = BY_MAJOR_AXIS(r->dy, r->dz, r->dx) * s.sz;
    s.sy = BY_MAJOR_AXIS(r->dz, r->dx, r->dy) * s.sz;
#undef BY_MAJOR_AXIS
    return s;
}

INLINE float8 row8(global const uchar *base, uint byte_offset) {
    return *(global const float8 *)(base + byte_offset);
}

INLINE float8 madd8(float8 a, float8 b, float8 c) {
#pragma OPENCL FP_CONTRACT ON
    return a * b + c;
}

INLINE float8 largest_of(float8 a, float8 b, float8 c) { return GREATER(GREATER(fabs(a), fabs(b)), fabs(c)); }

// The distance of a hit times the triangle's projected area is off by less than this times p q^2, where p is the largest
// coordinate across the ray and q the largest of all: coordinates are off by at most GAMMA(10) q, areas of at most 2 p^2
// by 44 HALF_ULP p q, and three products of one and the other by 168 HALF_ULP p q^2. (After Pharr, Jakob, Humphreys,
// "Physically Based Rendering", "Managing Rounding Error", bounding triangle intersections.)
#define BLOCK_DISTANCE_ERROR GAMMA(180)

INLINE Point block_corner(global const uchar *block, uint vertex, uint lane) {
    global const float *row = (global const float *)(block + vertex * BLOCK_VERTEX_BYTES) + lane;
    Point p = {row[0], row[8], row[16]};
    return p;
}

// Decides the lanes of `near`: those hit in (0, limit), with their distances.
INLINE uint hits_near_origin(global const uchar *block, uint near, const Ray *r, float limit, float8 *t) {
    float distance[8] __attribute__((aligned(32)));
    *(float8 *)distance = *t;
    uint hits = 0u;
    do {
        POP_LOWEST_BIT(near, i);
        float d = distance_to_plane(block_corner(block, 0u, i), block_corner(block, 1u, i), block_corner(block, 2u, i),
                                    r->ox, r->oy, r->oz, r->dx, r->dy, r->dz);
        distance[i] = d;
        hits |= ((d > 0.0f) & (d < limit)) ? 1u << i : 0u;
    } while (near);
    *t = *(float8 *)distance;
    return hits;
}

// Bit i of the result: triangle i is hit before `limit`; then t, u and v hold its distance and barycentrics. The triangle
// that the ray leaves is not: it is flat.
INLINE uint intersect_triangle_block(global const uchar *block, const RayShear *s, const Ray *r, float limit, float8 *t, float8 *u,
                                     float8 *v) {
    global const uchar *b1 = block + BLOCK_VERTEX_BYTES, *b2 = block + 2u * BLOCK_VERTEX_BYTES;
    float8 az = row8(block, s->kz) - s->oz, bz = row8(b1, s->kz) - s->oz, cz = row8(b2, s->kz) - s->oz;
    float8 ax = row8(block, s->kx) - s->ox, bx = row8(b1, s->kx) - s->ox, cx = row8(b2, s->kx) - s->ox;
    float8 ay = row8(block, s->ky) - s->oy, by = row8(b1, s->ky) - s->oy, cy = row8(b2, s->ky) - s->oy;
    float8 sx = -s->sx, sy = -s->sy;
    ax = madd8(sx, az, ax), ay = madd8(sy, az, ay);
    bx = madd8(sx, bz, bx), by = madd8(sy, bz, by);
    cx = madd8(sx, cz, cx), cy = madd8(sy, cz, cy);
    // Signed areas. The products are rounded one by one so that both triangles at an edge compute the same value for it
    // up to its sign.
    float8 wa = cx * by - cy * bx, wb = ax * cy - ay * cx, wc = bx * ay - by * ax;
    float8 det = wa + wb + wc;
    float8 least = LESSER(LESSER(wa, wb), wc), most = GREATER(GREATER(wa, wb), wc);
    // Most blocks end here, before the division.
    uint inside = lane_bits8(((least >= 0.0f) | (most <= 0.0f)) & (det != 0.0f));
    if (LIKELY(inside == 0u)) return 0u;
    inside &= lane_bits8(TRIANGLE_NUMBERS(*(global const uint8 *)(block + BLOCK_PRIMITIVE_BYTES)) != r->from);
    float8 inverse = 1.0f / det, depth = s->sz * madd8(wa, az, madd8(wb, bz, wc * cz));
    *t = depth * inverse;
    *u = wb * inverse;
    *v = wc * inverse;
    inside &= lane_bits8(*t < limit);
    if (LIKELY(inside == 0u)) return 0u;
    float8 across = GREATER(largest_of(ax, bx, cx), largest_of(ay, by, cy));
    float8 size = GREATER(across, largest_of(az, bz, cz) * fabs(s->sz));
    int8 near = fabs(depth) <= BLOCK_DISTANCE_ERROR * across * size * size;
    uint hits = inside & lane_bits8((*t > 0.0f) & !near);
    uint unsure = inside & lane_bits8(near);
    if (UNLIKELY(unsure)) hits |= hits_near_origin(block, unsure, r, limit, t);
    return hits;
}

#endif
