// Rays of a group as a packet: what they have in common, and the tests of one box and one triangle against all of them at
// once (shapes/trace_groups.h has the traversal). They may agree in the signs and in the largest axis of their directions,
// or be mixed, which costs some more.
#ifndef WAVELOBE_SHAPES_PACKET_H
#define WAVELOBE_SHAPES_PACKET_H

#include "shapes/traversal.h"

// Only triangles of the scene's own hierarchy are met in packets.
#define HAS_PACKETS (LANES > 1 && !HAS_ANALYTIC && !HAS_INSTANCES && !HAS_MASKS)
#if HAS_PACKETS

#define LEAST_PACKET (LANES / 2u) // fewer rays are not worth the set-up
#define MOST_SPREAD 1.4f           // rays farther apart have too little in common to be mixed

#define TEST_VALUES Float
#define TEST_MASK Int
#define TEST_FUSED madd
#define TEST(name) name##_lanes
#include "shapes/triangle_test.def"
#undef TEST_VALUES
#undef TEST_MASK
#undef TEST_FUSED
#undef TEST

typedef struct {
    LaneFloats t, u, v;
    uint slot[LANES] __attribute__((aligned(64))); // HIT_NONE: nothing, and t is the limit
} GroupHit;

// ---- what the rays of a packet have in common -----------------------------------------------------------

#define MIXED_X 1u // axes along which some rays go up and others down
#define MIXED_Y 2u
#define MIXED_Z 4u
#define MIXED_SIGNS (MIXED_X | MIXED_Y | MIXED_Z)
#define MIXED_AXES 8u // rays differ in their largest axis

typedef struct {
    uint rays;   // bits of those that are in it
    uint mixed;  // bits as above
    BoxTest all; // of all of them, by intervals
    Vec3 origin, reciprocal;          // of each
    Vec3 far_reciprocal;              // the same, widened for far sides unless rays have yet to find out which those are
    Int x_major, y_major;             // of each
    uint kx, ky, kz;                  // byte offsets of the permuted axes in a vertex, unless axes are mixed
    Vec3 permuted;                    // origins, axes permuted
    Float shear_x, shear_y, shear_z;
} Packet;

INLINE float least_of(uint rays, Float v) { return least_lane(SELECT(mask_of_bits(rays), v, (Float)INFINITY)); }

INLINE float greatest_of(uint rays, Float v) { return -least_of(rays, -v); }

// Bounds of an axis for all rays: the nearer and farther end of the origins, and of the reciprocals. The distance to a plane
// ahead is at least that from the origin nearest to it at the greatest speed. (A plane behind gets a wrong, but still
// negative, distance.)
//
// Along a mixed axis both rows of a node are near ones: that of the lower side for rays that go up, that of the upper side
// for the others. There is no far one, as some ray may hardly move along it.
INLINE void bound_axis(uint rays, uint down, Float origin, Float reciprocal, float *near_origin, float *far_origin, float *near,
                       float *far) {
    float low = least_of(rays, origin), high = greatest_of(rays, origin);
    Float size = fabs(reciprocal);
    if (down == 0u || down == rays) {
        float sign = down ? -1.0f : 1.0f;
        *near_origin = down ? low : high;
        *far_origin = down ? high : low;
        *near = sign * least_of(rays, size);
        *far = sign * greatest_of(rays, size) * FAR_WIDENING;
    } else {
        *near_origin = high;
        *far_origin = low;
        *near = least_of(rays & ~down, size);
        *far = -least_of(down, size);
    }
}

// How triangles are sheared for each ray, as ray_shear does for one.
INLINE void shear_packet(Packet *p, const GroupSetup *s) {
    p->permuted = vec3(LANES_OF(s->ox), LANES_OF(s->oy), LANES_OF(s->oz));
    p->shear_x = LANES_OF(s->sx), p->shear_y = LANES_OF(s->sy), p->shear_z = LANES_OF(s->sz);
    uint first = lowest_bit(p->rays);
    p->kx = s->kx[first], p->ky = s->ky[first], p->kz = s->kz[first];
}

// Whether rays are close together: how much their directions differ from that of the first, and their origins for its length.
INLINE int are_close(const RayGroup *g, uint rays, uint first) {
    Vec3 d = vec3(LANES_OF(g->dx), LANES_OF(g->dy), LANES_OF(g->dz)), o = vec3(LANES_OF(g->ox), LANES_OF(g->oy), LANES_OF(g->oz));
    Vec3 turn = absolute(sub(d, vec3(g->dx.value[first], g->dy.value[first], g->dz.value[first])));
    Vec3 way = absolute(sub(o, vec3(g->ox.value[first], g->oy.value[first], g->oz.value[first])));
    Float apart = madd(max_component(way), (Float)(1.0f / g->limit.value[first]), max_component(turn));
    return (rays & lane_bits(apart > MOST_SPREAD)) == 0u;
}

// The packet of those of the rays `left` that are like the first of them or, where they may be mixed and are not too far apart,
// of all. The others, and all if the packet came out too small, stay out of it.
INLINE Packet make_packet(const RayGroup *g, const GroupSetup *s, uint left, int may_mix) {
    Packet p;
    p.origin = vec3(LANES_OF(g->ox), LANES_OF(g->oy), LANES_OF(g->oz));
    p.reciprocal = vec3(LANES_OF(s->reciprocal_x), LANES_OF(s->reciprocal_y), LANES_OF(s->reciprocal_z));
    p.x_major = kept_mask(s->x_major), p.y_major = kept_mask(s->y_major);
    uint xs = lane_bits(p.reciprocal.x < 0.0f), ys = lane_bits(p.reciprocal.y < 0.0f), zs = lane_bits(p.reciprocal.z < 0.0f);
    uint xm = lane_bits(p.x_major), ym = lane_bits(p.y_major);
    uint first = lowest_bit(left);
#define LIKE_FIRST(bits) ((((bits) >> first) & 1u) ? (bits) : ~(bits))
    uint alike = LIKE_FIRST(xs) & LIKE_FIRST(ys) & LIKE_FIRST(zs) & LIKE_FIRST(xm) & LIKE_FIRST(ym);
    int mix = may_mix && (left & ~alike) && are_close(g, left, first);
    p.rays = mix ? left : left & alike;
    p.mixed = 0u;
    if (popcount(p.rays) < LEAST_PACKET) return p;
    if (mix) {
        p.mixed = (left & ~LIKE_FIRST(xs) ? MIXED_X : 0u) | (left & ~LIKE_FIRST(ys) ? MIXED_Y : 0u) |
                  (left & ~LIKE_FIRST(zs) ? MIXED_Z : 0u) | (left & ~(LIKE_FIRST(xm) & LIKE_FIRST(ym)) ? MIXED_AXES : 0u);
    }
#undef LIKE_FIRST
    BoxTest *b = &p.all;
    xs &= p.rays, ys &= p.rays, zs &= p.rays;
    bound_axis(p.rays, xs, p.origin.x, p.reciprocal.x, &b->near_ox, &b->far_ox, &b->near_x, &b->far_x);
    bound_axis(p.rays, ys, p.origin.y, p.reciprocal.y, &b->near_oy, &b->far_oy, &b->near_y, &b->far_y);
    bound_axis(p.rays, zs, p.origin.z, p.reciprocal.z, &b->near_oz, &b->far_oz, &b->near_z, &b->far_z);
    choose_rows(b, xs == p.rays, ys == p.rays, zs == p.rays);
    p.far_reciprocal = p.mixed & MIXED_SIGNS ? p.reciprocal : scale(p.reciprocal, (Float)FAR_WIDENING);
    shear_packet(&p, s);
    return p;
}

// ---- one box, one triangle, all rays -----------------------------------------------------------------------

// Bit i: some ray of the packet may meet child i before `limit`; none that does enters it before distance[i].
INLINE uint intersect_packet_children(global const uchar *node, const Packet *p, float limit, float8 *distance) {
    Slabs s = intersect_slabs(node, &p->all);
    if (p->mixed & MIXED_X) s.near_x = GREATER(s.near_x, s.far_x), s.far_x = (float8)INFINITY;
    if (p->mixed & MIXED_Y) s.near_y = GREATER(s.near_y, s.far_y), s.far_y = (float8)INFINITY;
    if (p->mixed & MIXED_Z) s.near_z = GREATER(s.near_z, s.far_z), s.far_z = (float8)INFINITY;
    // Absent children are infinitely far off.
    return within_slabs(&s, LESSER(limit, FLT_MAX), distance);
}

// Bits of the rays that meet child i of the node before their limit; as intersect_children tests one ray.
INLINE uint rays_in_child(global const uchar *node, uint i, const Packet *p, Float limit) {
    const BoxTest *b = &p->all;
    global const uchar *box = node + 4u * i;
#define SIDE(row) ((Float)*(global const float *)(box + (row)))
    Float nx = (SIDE(b->near_row_x) - p->origin.x) * p->reciprocal.x, fx = (SIDE(b->far_row_x) - p->origin.x) * p->far_reciprocal.x;
    Float ny = (SIDE(b->near_row_y) - p->origin.y) * p->reciprocal.y, fy = (SIDE(b->far_row_y) - p->origin.y) * p->far_reciprocal.y;
    Float nz = (SIDE(b->near_row_z) - p->origin.z) * p->reciprocal.z, fz = (SIDE(b->far_row_z) - p->origin.z) * p->far_reciprocal.z;
#undef SIDE
    if (p->mixed & MIXED_SIGNS) {
        // Which side is the near one is for each ray to find out.
        Float ax = GREATER(nx, fx), ay = GREATER(ny, fy), az = GREATER(nz, fz);
        nx = LESSER(nx, fx), ny = LESSER(ny, fy), nz = LESSER(nz, fz);
        fx = ax * FAR_WIDENING, fy = ay * FAR_WIDENING, fz = az * FAR_WIDENING;
    }
    Float enter = GREATER(GREATER(nx, ny), GREATER(nz, ZERO));
    Float leave = LESSER(LESSER(fx, fy), LESSER(fz, limit));
    return lane_bits(enter <= leave);
}

INLINE Corners_lanes corners_in_lanes(global const uchar *block, uint i, const Packet *p) {
    global const uchar *a = block + 4u * i, *b = a + BLOCK_VERTEX_BYTES, *c = b + BLOCK_VERTEX_BYTES;
#define COORDINATE(vertex, k) ((Float)*(global const float *)((vertex) + (k)))
    if (p->mixed & MIXED_AXES) {
        Int x_major = p->x_major, y_major = p->y_major;
#define ROW(vertex, k) COORDINATE(vertex, (k) * BLOCK_ROW_BYTES)
#define PERMUTED(vertex, k0, k1, k2) BY_AXIS(x_major, y_major, ROW(vertex, k0), ROW(vertex, k1), ROW(vertex, k2))
#define CORNER(vertex)                                      \
    PERMUTED(vertex, 1u, 2u, 0u) - p->permuted.x,           \
        PERMUTED(vertex, 2u, 0u, 1u) - p->permuted.y,       \
        PERMUTED(vertex, 0u, 1u, 2u) - p->permuted.z
        Corners_lanes t = {CORNER(a), CORNER(b), CORNER(c)};
#undef CORNER
#undef PERMUTED
#undef ROW
        return t;
    }
#define CORNER(vertex)                              \
    COORDINATE(vertex, p->kx) - p->permuted.x,      \
        COORDINATE(vertex, p->ky) - p->permuted.y,  \
        COORDINATE(vertex, p->kz) - p->permuted.z
    Corners_lanes t = {CORNER(a), CORNER(b), CORNER(c)};
#undef CORNER
#undef COORDINATE
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

#endif
#endif
