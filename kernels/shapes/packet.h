// Rays of a group whose directions agree in their signs and their largest axis, as a packet: what they have in common, and
// the tests of one box and one triangle against all of them at once (shapes/trace_groups.h has the traversal).
#ifndef WAVELOBE_SHAPES_PACKET_H
#define WAVELOBE_SHAPES_PACKET_H

#include "shapes/traversal.h"

// Only triangles of the scene's own hierarchy are met in packets.
#define HAS_PACKETS (LANES > 1 && !HAS_ANALYTIC && !HAS_INSTANCES && !HAS_MASKS)
#if HAS_PACKETS

#define LEAST_PACKET (LANES / 2u) // fewer rays are not worth the set-up

#define TEST_VALUES Float
#define TEST_MASK Int
#define TEST(name) name##_lanes
#include "shapes/triangle_test.def"
#undef TEST_VALUES
#undef TEST_MASK
#undef TEST

typedef struct {
    float value[LANES] __attribute__((aligned(64)));
} LaneFloats;

typedef struct {
    LaneFloats ox, oy, oz, dx, dy, dz, limit; // unit directions; what lies at the limit or beyond is not seen
    uint from[LANES] __attribute__((aligned(64)));
} RayGroup;

#define LANES_OF(floats) (*(const Float *)(floats).value)

INLINE Ray group_ray(const RayGroup *g, uint i) {
    Ray r = {g->ox.value[i], g->oy.value[i], g->oz.value[i], g->dx.value[i], g->dy.value[i], g->dz.value[i], g->limit.value[i],
             g->from[i]};
    return r;
}

typedef struct {
    LaneFloats t, u, v;
    uint slot[LANES] __attribute__((aligned(64))); // HIT_NONE: nothing, and t is the limit
} GroupHit;

// ---- what the rays of a packet have in common -----------------------------------------------------------

typedef struct {
    uint rays;   // bits of those that are in it
    BoxTest all; // of all of them, by intervals
    Vec3 origin, reciprocal, widened; // of each
    uint kx, ky, kz;                  // byte offsets of the permuted axes in a vertex
    Vec3 permuted;                    // origins, axes permuted
    Float shear_x, shear_y, shear_z;
} Packet;

INLINE float least_lane(Float v) {
#if LANES == 16
    float8 a = LESSER(v.lo, v.hi);
#else
    float8 a = v;
#endif
    float4 b = LESSER(a.lo, a.hi);
    float2 c = LESSER(b.lo, b.hi);
    return LESSER(c.x, c.y);
}

INLINE float greatest_lane(Float v) { return -least_lane(-v); }

// Bounds of an axis for all rays: the nearer and farther end of the origins, and of the reciprocals.
INLINE void bound_axis(Int in, uint negative, Float origin, Float reciprocal, float *near_origin, float *far_origin, float *near,
                       float *far) {
    float low = least_lane(SELECT(in, origin, (Float)INFINITY)), high = greatest_lane(SELECT(in, origin, (Float)-INFINITY));
    float least = least_lane(SELECT(in, fabs(reciprocal), (Float)INFINITY));
    float greatest = greatest_lane(SELECT(in, fabs(reciprocal), ZERO));
    // The distance to a plane ahead is at least that from the origin nearest to it at the greatest speed. (A plane behind
    // gets a wrong, but still negative, distance.)
    *near_origin = negative ? low : high;
    *far_origin = negative ? high : low;
    *near = negative ? -least : least;
    *far = (negative ? -greatest : greatest) * FAR_WIDENING;
}

// The packet of those of the rays `left` that are like the first of them; the others, and all if the packet came out too
// small, stay out of it.
INLINE Packet make_packet(const RayGroup *g, uint left) {
    Packet p;
    Vec3 d = vec3(LANES_OF(g->dx), LANES_OF(g->dy), LANES_OF(g->dz));
    p.origin = vec3(LANES_OF(g->ox), LANES_OF(g->oy), LANES_OF(g->oz));
    p.reciprocal = vec3(reciprocal_lanes(d.x), reciprocal_lanes(d.y), reciprocal_lanes(d.z));
    Vec3 size = absolute(d);
    // As ray_shear chooses.
    Int x_major = (size.x > size.y) & (size.x > size.z), y_major = !x_major & (size.y > size.z);
    uint xs = lane_bits(p.reciprocal.x < 0.0f), ys = lane_bits(p.reciprocal.y < 0.0f), zs = lane_bits(p.reciprocal.z < 0.0f);
    uint xm = lane_bits(x_major), ym = lane_bits(y_major);
    uint first = lowest_bit(left);
#define LIKE_FIRST(bits) ((((bits) >> first) & 1u) ? (bits) : ~(bits))
    p.rays = left & LIKE_FIRST(xs) & LIKE_FIRST(ys) & LIKE_FIRST(zs) & LIKE_FIRST(xm) & LIKE_FIRST(ym);
#undef LIKE_FIRST
    if (popcount(p.rays) < LEAST_PACKET) return p;
    uint sx = (xs >> first) & 1u, sy = (ys >> first) & 1u, sz = (zs >> first) & 1u;
    Int in = mask_of_bits(p.rays);
    BoxTest *b = &p.all;
    bound_axis(in, sx, p.origin.x, p.reciprocal.x, &b->near_ox, &b->far_ox, &b->near_x, &b->far_x);
    bound_axis(in, sy, p.origin.y, p.reciprocal.y, &b->near_oy, &b->far_oy, &b->near_y, &b->far_y);
    bound_axis(in, sz, p.origin.z, p.reciprocal.z, &b->near_oz, &b->far_oz, &b->near_z, &b->far_z);
    choose_rows(b, sx, sy, sz);
    p.widened = scale(p.reciprocal, (Float)FAR_WIDENING);
    uint x_axis = (xm >> first) & 1u, y_axis = (ym >> first) & 1u;
#define BY_AXIS(if_x, if_y, if_z) (x_axis ? (if_x) : y_axis ? (if_y) : (if_z))
    p.kx = BY_AXIS(1u, 2u, 0u) * BLOCK_ROW_BYTES;
    p.ky = BY_AXIS(2u, 0u, 1u) * BLOCK_ROW_BYTES;
    p.kz = BY_AXIS(0u, 1u, 2u) * BLOCK_ROW_BYTES;
    p.permuted = vec3(BY_AXIS(p.origin.y, p.origin.z, p.origin.x), BY_AXIS(p.origin.z, p.origin.x, p.origin.y),
                      BY_AXIS(p.origin.x, p.origin.y, p.origin.z));
    p.shear_z = 1.0f / BY_AXIS(d.x, d.y, d.z);
    p.shear_x = BY_AXIS(d.y, d.z, d.x) * p.shear_z;
    p.shear_y = BY_AXIS(d.z, d.x, d.y) * p.shear_z;
#undef BY_AXIS
    return p;
}

// ---- one box, one triangle, all rays -----------------------------------------------------------------------

// Bits of the rays that meet child i of the node before their limit; as intersect_children tests one ray.
INLINE uint rays_in_child(global const uchar *node, uint i, const Packet *p, Float limit) {
    const BoxTest *b = &p->all;
    global const uchar *box = node + 4u * i;
#define SIDE(row) ((Float)*(global const float *)(box + (row)))
    Float nx = (SIDE(b->near_row_x) - p->origin.x) * p->reciprocal.x, fx = (SIDE(b->far_row_x) - p->origin.x) * p->widened.x;
    Float ny = (SIDE(b->near_row_y) - p->origin.y) * p->reciprocal.y, fy = (SIDE(b->far_row_y) - p->origin.y) * p->widened.y;
    Float nz = (SIDE(b->near_row_z) - p->origin.z) * p->reciprocal.z, fz = (SIDE(b->far_row_z) - p->origin.z) * p->widened.z;
#undef SIDE
    Float enter = GREATER(GREATER(nx, ny), GREATER(nz, ZERO));
    Float leave = LESSER(LESSER(fx, fy), LESSER(fz, limit));
    return lane_bits(enter <= leave);
}

INLINE Corners_lanes corners_in_lanes(global const uchar *block, uint i, const Packet *p) {
    global const uchar *a = block + 4u * i, *b = a + BLOCK_VERTEX_BYTES, *c = b + BLOCK_VERTEX_BYTES;
#define CORNER(vertex, k) ((Float)*(global const float *)((vertex) + p->k))
    Corners_lanes t = {
        CORNER(a, kx) - p->permuted.x, CORNER(a, ky) - p->permuted.y, CORNER(a, kz) - p->permuted.z,
        CORNER(b, kx) - p->permuted.x, CORNER(b, ky) - p->permuted.y, CORNER(b, kz) - p->permuted.z,
        CORNER(c, kx) - p->permuted.x, CORNER(c, ky) - p->permuted.y, CORNER(c, kz) - p->permuted.z,
    };
#undef CORNER
    return t;
}

// Those of the rays `near` that meet triangle i of the block in (0, limit], with their distances.
INLINE uint rays_near_triangle(global const uchar *block, uint i, uint near, const RayGroup *g, Float limit, Float *t) {
    LaneFloats distance, limits;
    *(Float *)distance.value = *t;
    *(Float *)limits.value = limit;
    uint hits = 0u;
    do {
        POP_LOWEST_BIT(near, k);
        Ray r = group_ray(g, k);
        float d = distance_to_plane(block_corner(block, 0u, i), block_corner(block, 1u, i), block_corner(block, 2u, i), r.ox, r.oy,
                                    r.oz, r.dx, r.dy, r.dz);
        distance.value[k] = d;
        hits |= ((d > 0.0f) & (d <= limits.value[k])) ? 1u << k : 0u;
    } while (near);
    *t = LANES_OF(distance);
    return hits;
}

// Bits of the `rays` that hit triangle i of a block in (0, limit], as intersect_triangle_block decides for one.
INLINE uint rays_at_triangle(global const uchar *block, uint i, uint number, uint rays, const Packet *p, const RayGroup *g,
                             Float limit, Float *t, Float *u, Float *v) {
    Areas_lanes w;
    Corners_lanes c = corners_in_lanes(block, i, p);
    uint inside = rays & lane_bits(shear_lanes(&c, &w, p->shear_x, p->shear_y));
    if (inside == 0u) return 0u;
    inside &= lane_bits(*(const UInt *)g->from != (UInt)TRIANGLE_NUMBERS(number));
    Float inverse = 1.0f / w.sum, depth = depth_lanes(&c, &w, p->shear_z);
    *t = depth * inverse;
    *u = w.wb * inverse;
    *v = w.wc * inverse;
    inside &= lane_bits(*t <= limit);
    if (inside == 0u) return 0u;
    Int near = unsure_lanes(&c, depth, p->shear_z);
    uint hits = inside & lane_bits((*t > 0.0f) & !near);
    uint unsure = inside & lane_bits(near);
    if (UNLIKELY(unsure)) hits |= rays_near_triangle(block, i, unsure, g, limit, t);
    return hits;
}

// Rays that are not numbers, or have no room for a hit, stay out.
INLINE uint sound_rays(const RayGroup *g, uint live) {
    Float sum = ZERO;
    const LaneFloats *parts[6] = {&g->ox, &g->oy, &g->oz, &g->dx, &g->dy, &g->dz};
#pragma unroll
    for (uint i = 0u; i < 6u; i++) sum += LANES_OF(*parts[i]) - LANES_OF(*parts[i]);
    return live & lane_bits((sum == 0.0f) & (LANES_OF(g->limit) > 0.0f));
}

#endif
#endif
