// LANES rays against all triangles of a small scene: cheaper than any hierarchy while there are few.
//
// Each vertex is turned once into a frame around the ray, with the ray as its z axis; a triangle is hit where the origin of
// that frame lies inside its projection. Neighbours share the turned vertices and compute the same value, up to sign, for
// their common edge: no ray slips between them.  (The projection of Woop, Benthin, Wald 2013, "Watertight Ray/Triangle
// Intersection", with a rotation in place of their permutation and shear, which differ from lane to lane.)
#ifndef WAVELOBE_SHAPES_FEW_TRIANGLES_H
#define WAVELOBE_SHAPES_FEW_TRIANGLES_H

#include "shapes/near_plane.h"
#include "shapes/ray.h"
#include "shared/scene.h"
#if HAS_OPACITY
#include "shapes/opacity.h"
#endif

typedef struct {
    global const float *vertices;              // 3 each
    global const struct FewTriangle *triangles;
    uint vertex_count, triangle_count;
#if HAS_OPACITY
    OpacityView opacity;
#endif
} FewTriangles;

// Where opacity lets some rays pass, each has a key.
#if HAS_MASKS
#define KEY_PARAMETER , UInt key
#else
#define KEY_PARAMETER
#endif

// The vertices as the rays see them.
typedef struct {
    Float x[FEW_VERTICES_MAX], y[FEW_VERTICES_MAX], z[FEW_VERTICES_MAX];
} TurnedVertices;

INLINE void turn_vertices(FewTriangles g, Vec3 origin, Vec3 direction, TurnedVertices *turned) {
    Frame f = frame_of_normal(direction);
    for (uint i = 0u; i < g.vertex_count; i++) {
        global const float *p = g.vertices + 3u * i;
        Vec3 v = to_local(f, vec3(p[0] - origin.x, p[1] - origin.y, p[2] - origin.z));
        turned->x[i] = v.x;
        turned->y[i] = v.y;
        turned->z[i] = v.z;
    }
}

// What the test of one triangle finds: areas opposite to the corners (twice, with the sign of the side), and `depth`, the
// distance times their sum.
typedef struct {
    Float wa, wb, wc, sum, depth;
    Int inside;
} TriangleTest;

INLINE TriangleTest test_triangle(const TurnedVertices *v, uint a, uint b, uint c) {
    TriangleTest t;
    // Products are rounded one by one, see above.
    t.wa = v->x[c] * v->y[b] - v->y[c] * v->x[b];
    t.wb = v->x[a] * v->y[c] - v->y[a] * v->x[c];
    t.wc = v->x[b] * v->y[a] - v->y[b] * v->x[a];
    t.sum = t.wa + t.wb + t.wc;
    t.depth = madd(t.wa, v->z[a], madd(t.wb, v->z[b], t.wc * v->z[c]));
    Float least = LESSER(LESSER(t.wa, t.wb), t.wc), most = GREATER(GREATER(t.wa, t.wb), t.wc);
    t.inside = ((least >= 0.0f) | (most <= 0.0f)) & (t.sum != 0.0f);
    return t;
}

INLINE Float greatest_of(Float a, Float b, Float c) { return GREATER(GREATER(fabs(a), fabs(b)), fabs(c)); }

// As BLOCK_DISTANCE_ERROR of shapes/triangle_block.h with the rotation in place of the shear: each turned coordinate is a
// subtraction and a product of three terms, off by at most GAMMA(5) times the sum of the magnitudes of its terms. These
// are at most sqrt(3) times the length of the vector, and that at most the sum of its turned coordinates, so the error is
// 26 HALF_ULP q, that of the areas 108 HALF_ULP p q, and that of the distance times the area 498 HALF_ULP p q^2.
#define FEW_DISTANCE_ERROR GAMMA(512)

INLINE Point few_corner(FewTriangles g, uint vertex) {
    global const float *p = g.vertices + 3u * vertex;
    Point corner = {p[0], p[1], p[2]};
    return corner;
}

// Decides the lanes of `near`: those hit in (0, limit), with their distances.
INLINE Int few_near_origin(FewTriangles g, global const struct FewTriangle *triangle, Int near, Vec3 origin, Vec3 direction,
                           Float limit, Float *t) {
    Point a = few_corner(g, triangle->corner[0]), b = few_corner(g, triangle->corner[1]), c = few_corner(g, triangle->corner[2]);
    float ray[6][LANES] __attribute__((aligned(64))), distance[LANES] __attribute__((aligned(64)));
    *(Float *)ray[0] = origin.x, *(Float *)ray[1] = origin.y, *(Float *)ray[2] = origin.z;
    *(Float *)ray[3] = direction.x, *(Float *)ray[4] = direction.y, *(Float *)ray[5] = direction.z;
    *(Float *)distance = *t;
    uint bits = lane_bits(near);
    while (bits) {
        POP_LOWEST_BIT(bits, i);
        distance[i] = distance_to_plane(a, b, c, ray[0][i], ray[1][i], ray[2][i], ray[3][i], ray[4][i], ray[5][i]);
    }
    *t = *(Float *)distance;
    return near & (*t > 0.0f) & (*t < limit);
}

// The rays as the test of one triangle needs them.
typedef struct {
    Vec3 origin, direction;
    UInt from; // number of the triangle that the ray leaves and cannot meet, or HIT_NONE
} LaneRay;

// Lanes in which triangle `index` is hit in (0, limit), and where.
INLINE Int hit_triangle(FewTriangles g, const TurnedVertices *v, uint index, const LaneRay *r, Float limit, TriangleTest *t,
                        Float *distance, Float *inverse) {
    global const struct FewTriangle *triangle = g.triangles + index;
    uint a = triangle->corner[0], b = triangle->corner[1], c = triangle->corner[2];
    *t = test_triangle(v, a, b, c);
    Int inside = t->inside & (r->from != (UInt)TRIANGLE_NUMBERS(triangle->primitive));
    if (!any_lane(inside)) return inside;
    *inverse = 1.0f / t->sum;
    *distance = t->depth * *inverse;
    Float across = GREATER(greatest_of(v->x[a], v->x[b], v->x[c]), greatest_of(v->y[a], v->y[b], v->y[c]));
    Float size = GREATER(across, greatest_of(v->z[a], v->z[b], v->z[c]));
    Int near = fabs(t->depth) <= FEW_DISTANCE_ERROR * across * size * size;
    Int hit = inside & !near & (*distance > 0.0f) & (*distance < limit);
    near &= inside;
    if (UNLIKELY(any_lane(near))) hit |= few_near_origin(g, triangle, near, r->origin, r->direction, limit, distance);
    return hit;
}

#if HAS_MASKS
// Lanes whose ray passes triangle `index` where it hits it.
INLINE Int passes_few(FewTriangles g, uint index, UInt key, const TriangleTest *t, Float inverse) {
    uint primitive = g.triangles[index].primitive;
    if (!(primitive & PRIMITIVE_MASKED)) return !TRUE_MASK;
    return passes_triangle(g.opacity, key, (UInt)(primitive & ~PRIMITIVE_MASKED), t->wb * inverse, t->wc * inverse);
}
#endif

typedef struct {
    Float t, u, v;
    UInt slot; // HIT_NONE: nothing
} LaneHit;

// The nearest hit of each ray in (0, limit).
INLINE LaneHit closest_of_few(FewTriangles g, Vec3 origin, Vec3 direction, Float limit, UInt from KEY_PARAMETER) {
    LaneRay ray = {origin, direction, from};
    TurnedVertices turned;
    turn_vertices(g, origin, direction, &turned);
    LaneHit nearest = {limit, ZERO, ZERO, (UInt)HIT_NONE};
    for (uint i = 0u; i < g.triangle_count; i++) {
        TriangleTest t;
        Float distance, inverse;
        Int hit = hit_triangle(g, &turned, i, &ray, nearest.t, &t, &distance, &inverse);
        if (!any_lane(hit)) continue;
#if HAS_MASKS
        hit &= !passes_few(g, i, key, &t, inverse);
#endif
        nearest.t = SELECT(hit, distance, nearest.t);
        nearest.u = SELECT(hit, t.wb * inverse, nearest.u);
        nearest.v = SELECT(hit, t.wc * inverse, nearest.v);
        nearest.slot = SELECT(hit, (UInt)g.triangles[i].slot, nearest.slot);
    }
    return nearest;
}

// Lanes of `wanted` whose ray hits anything in (0, limit).
INLINE Int any_of_few(FewTriangles g, Vec3 origin, Vec3 direction, Float limit, UInt from, Int wanted KEY_PARAMETER) {
    LaneRay ray = {origin, direction, from};
    TurnedVertices turned;
    turn_vertices(g, origin, direction, &turned);
    Int blocked = !TRUE_MASK;
    for (uint i = 0u; i < g.triangle_count; i++) {
        TriangleTest t;
        Float distance, inverse;
        Int hit = hit_triangle(g, &turned, i, &ray, limit, &t, &distance, &inverse);
#if HAS_MASKS
        if (any_lane(hit)) hit &= !passes_few(g, i, key, &t, inverse);
#endif
        blocked |= hit;
        if (!any_lane(wanted & !blocked)) break;
    }
    return blocked & wanted;
}

#endif
