// LANES rays against all triangles of a small scene: cheaper than any hierarchy while there are few.
//
// Each vertex is turned once into a frame around the ray, with the ray as its z axis; a triangle is hit where the origin of
// that frame lies inside its projection. Neighbours share the turned vertices and compute the same value, up to sign, for
// their common edge: no ray slips between them.  (The projection of Woop, Benthin, Wald 2013, "Watertight Ray/Triangle
// Intersection", with a rotation in place of their permutation and shear, which differ from lane to lane.)
#ifndef WAVELOBE_SHAPES_FEW_TRIANGLES_H
#define WAVELOBE_SHAPES_FEW_TRIANGLES_H

#include "core/vector.h"
#include "shapes/near_plane.h"
#include "shapes/ray.h"
#include "shared/scene.h"
#if HAS_OPACITY
#include "shapes/opacity.h"
#endif

typedef struct {
    global const float *vertices;              // 3 each
    global const struct FewTriangle *triangles;
    global const struct FewSummary *summary;
#if !HAS_MASKS
    global const struct FewFacet *facets;
    global const float *corners; // of the facets, FEW_CORNER_ROWS
    global const uint *numbers;  // facet of each triangle of the scene, by its number
#endif
#if HAS_ANALYTIC
    global const struct Analytic *analytics;
    global const struct FewAnalytic *few_analytics;
#endif
#if HAS_OPACITY
    OpacityView opacity;
#endif
} FewTriangles;

// Where opacity lets some rays pass, each has a key.
#if HAS_MASKS
#define KEY_PARAMETER , UInt key
#define PASS_KEY , key
#else
#define KEY_PARAMETER
#define PASS_KEY
#endif

// The vertices as the rays see them.
typedef struct {
    Float x[FEW_VERTICES_MAX], y[FEW_VERTICES_MAX], z[FEW_VERTICES_MAX];
} TurnedVertices;

INLINE void turn_vertex(FewTriangles g, uint i, Vec3 origin, Frame around_ray, TurnedVertices *turned) {
    global const float *p = g.vertices + 3u * i;
    Vec3 v = to_local(around_ray, vec3(p[0] - origin.x, p[1] - origin.y, p[2] - origin.z));
    turned->x[i] = v.x;
    turned->y[i] = v.y;
    turned->z[i] = v.z;
}

INLINE void turn_vertices(FewTriangles g, Vec3 origin, Vec3 direction, TurnedVertices *turned) {
    Frame f = frame_of_normal(direction);
    for (uint i = 0u; i < g.summary->vertex_count; i++) turn_vertex(g, i, origin, f, turned);
}

// What the test of one triangle finds: areas opposite to the second and third corner and their sum, all three taken twice and
// turned so that `area` is positive, and `depth`, the distance times `area`.
typedef struct {
    Float wb, wc, area, depth;
    Int inside;
} TriangleTest;

#define SIGN_BIT ((UInt)0x80000000u)

INLINE TriangleTest test_triangle(const TurnedVertices *v, uint a, uint b, uint c) {
    TriangleTest t;
    // Products are rounded one by one, see above.
    Float wa = v->x[c] * v->y[b] - v->y[c] * v->x[b];
    Float wb = v->x[a] * v->y[c] - v->y[a] * v->x[c];
    Float wc = v->x[b] * v->y[a] - v->y[b] * v->x[a];
    Float sum = wa + wb + wc, depth = madd(wa, v->z[a], madd(wb, v->z[b], wc * v->z[c]));
    UInt side = as_UInt(sum) & SIGN_BIT;
    wa = as_Float(as_UInt(wa) ^ side);
    t.wb = as_Float(as_UInt(wb) ^ side);
    t.wc = as_Float(as_UInt(wc) ^ side);
    t.depth = as_Float(as_UInt(depth) ^ side);
    t.area = fabs(sum);
    t.inside = LESSER(LESSER(wa, t.wb), t.wc) >= 0.0f;
    return t;
}

// As BLOCK_DISTANCE_ERROR of shapes/triangle_block.h with the rotation in place of the shear: each turned coordinate is a
// subtraction and a product of three terms, off by at most GAMMA(5) times the sum of the magnitudes of its terms. These
// are at most sqrt(3) times the length of the vector, and that at most the sum of its turned coordinates, so the error is
// 26 HALF_ULP q, that of the areas 108 HALF_ULP p q, and that of the distance times the area 498 HALF_ULP p q^2. For p and q
// stands the distance to the farthest point of a sphere around all triangles.
#define FEW_DISTANCE_ERROR GAMMA(512)

// The rays as the test of one triangle needs them; lengths are in units of the set (FewSummary).
typedef struct {
    Vec3 origin, direction;
    UInt from;       // number of the triangle that the ray leaves and cannot meet, or HIT_NONE
    Vec3 off_center; // origin relative to the center of the set
    Float farthest;  // no point of the set is farther from the origin
    Float unsure;    // a depth this small or smaller says nothing about the side on which the triangle lies
} LaneRay;

INLINE LaneRay lane_ray(FewTriangles g, Vec3 origin, Vec3 direction, UInt from) {
    global const struct FewSummary *s = g.summary;
    LaneRay r;
    r.origin = scale(origin, (Float)s->per_length);
    r.direction = direction;
    r.from = from;
    r.off_center = sub(r.origin, vec3((Float)s->center[0], (Float)s->center[1], (Float)s->center[2]));
    r.farthest = sqrt(length_squared(r.off_center)) * (1.0f + GAMMA(4)) + s->radius;
    r.unsure = FEW_DISTANCE_ERROR * r.farthest * r.farthest * r.farthest;
    return r;
}

INLINE Point few_corner(FewTriangles g, uint vertex) {
    global const float *p = g.vertices + 3u * vertex;
    Point corner = {p[0], p[1], p[2]};
    return corner;
}

// Distances to the triangle's plane in the lanes of `near`, 0 in those whose ray does not come to it; decided in double.
INLINE Float few_near_origin(FewTriangles g, global const struct FewTriangle *triangle, Int near, const LaneRay *r) {
    Point a = few_corner(g, triangle->corner[0]), b = few_corner(g, triangle->corner[1]), c = few_corner(g, triangle->corner[2]);
    float ray[6][LANES] __attribute__((aligned(64))), distance[LANES] __attribute__((aligned(64)));
    *(Float *)ray[0] = r->origin.x, *(Float *)ray[1] = r->origin.y, *(Float *)ray[2] = r->origin.z;
    *(Float *)ray[3] = r->direction.x, *(Float *)ray[4] = r->direction.y, *(Float *)ray[5] = r->direction.z;
    *(Float *)distance = ZERO;
    uint bits = lane_bits(near);
    while (bits) {
        POP_LOWEST_BIT(bits, i);
        distance[i] = distance_to_plane(a, b, c, ray[0][i], ray[1][i], ray[2][i], ray[3][i], ray[4][i], ray[5][i]);
    }
    return *(Float *)distance;
}

#if HAS_MASKS
// Lanes whose ray passes triangle `index` where it hits it.
INLINE Int passes_few(FewTriangles g, uint index, UInt key, const TriangleTest *t) {
    uint primitive = g.triangles[index].primitive;
    if (!(primitive & PRIMITIVE_MASKED)) return !TRUE_MASK;
    return passes_triangle(g.opacity, key, (UInt)(primitive & ~PRIMITIVE_MASKED), t->wb / t->area, t->wc / t->area);
}
#endif

// Lanes in which triangle `index` is hit between the origin and the distance depth / area. Distances are compared as
// fractions, crosswise: a division is as dear as half of the test. (No distance is below one where the area is zero.)
INLINE Int hit_triangle(FewTriangles g, const TurnedVertices *v, uint index, const LaneRay *r, Float depth, Float area,
                        TriangleTest *t KEY_PARAMETER) {
    global const struct FewTriangle *triangle = g.triangles + index;
    *t = test_triangle(v, triangle->corner[0], triangle->corner[1], triangle->corner[2]);
    Int inside = t->inside & (r->from != (UInt)TRIANGLE_NUMBERS(triangle->primitive)) & (t->depth >= -r->unsure) &
                 (t->depth * area < depth * t->area);
    KeptMask met = keep_mask(inside);
    Int near = inside & (t->depth <= r->unsure);
    if (UNLIKELY(any_lane(near))) {
        t->depth = SELECT(near, few_near_origin(g, triangle, near, r) * t->area, t->depth);
        met &= keep_mask((t->depth > 0.0f) & (t->depth * area < depth * t->area));
    }
#if HAS_MASKS
    if (any_lane(kept_mask(met))) met &= keep_mask(!passes_few(g, index, key, t));
#endif
    return kept_mask(met);
}

typedef struct {
    Float t, u, v;
    UInt slot; // HIT_NONE: nothing
} LaneHit;

INLINE LaneHit select_hit(Int mask, LaneHit a, LaneHit b) {
    LaneHit h = {SELECT(mask, a.t, b.t), SELECT(mask, a.u, b.u), SELECT(mask, a.v, b.v), SELECT(mask, a.slot, b.slot)};
    return h;
}

#if HAS_ANALYTIC
#include "shapes/few_analytic.h"
#endif

typedef struct {
    TriangleTest test;
    UInt index; // HIT_NONE: nothing
} NearestTriangle;

// The nearest hit of each ray in (0, limit).
INLINE NearestTriangle closest_of_all(FewTriangles g, const LaneRay *ray, Float limit KEY_PARAMETER) {
    TurnedVertices turned;
    turn_vertices(g, ray->origin, ray->direction, &turned);
    NearestTriangle nearest = {{ZERO, ZERO, ONE, limit * g.summary->per_length, TRUE_MASK}, (UInt)HIT_NONE};
    TriangleTest *n = &nearest.test;
    for (uint i = 0u; i < g.summary->triangle_count; i++) {
        TriangleTest t;
        Int hit = hit_triangle(g, &turned, i, ray, n->depth, n->area, &t PASS_KEY);
        n->depth = SELECT(hit, t.depth, n->depth);
        n->area = SELECT(hit, t.area, n->area);
        n->wb = SELECT(hit, t.wb, n->wb);
        n->wc = SELECT(hit, t.wc, n->wc);
        nearest.index = SELECT(hit, (UInt)i, nearest.index);
    }
    return nearest;
}

INLINE LaneHit hit_of_triangle(FewTriangles g, const NearestTriangle *nearest, Float limit) {
    const TriangleTest *n = &nearest->test;
    Int found = nearest->index != (UInt)HIT_NONE;
    UInt slot = GATHER_UINT_FIELD(g.triangles, FewTriangle, SELECT(found, nearest->index, (UInt)0u), slot);
    LaneHit h = {SELECT(found, n->depth / n->area * (1.0f / g.summary->per_length), limit), n->wb / n->area, n->wc / n->area,
                 SELECT(found, slot, (UInt)HIT_NONE)};
    return h;
}

// How many triangles or facets are tested before asking whether all rays are blocked.
#define FEW_BETWEEN_LOOKS 4u

// Lanes of `wanted` whose ray hits any triangle in (0, limit).
INLINE Int any_of_all(FewTriangles g, const LaneRay *ray, Float limit, Int wanted KEY_PARAMETER) {
    TurnedVertices turned;
    turn_vertices(g, ray->origin, ray->direction, &turned);
    Float reach = limit * g.summary->per_length;
    KeptMask left = keep_mask(wanted);
    for (uint i = 0u; i < g.summary->triangle_count; i++) {
        TriangleTest t;
        left &= keep_mask(!hit_triangle(g, &turned, i, ray, reach, ONE, &t PASS_KEY));
        if (i % FEW_BETWEEN_LOOKS == 0u && !any_lane(kept_mask(left))) break;
    }
    return wanted & !kept_mask(left);
}

#endif
