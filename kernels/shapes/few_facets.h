// LANES rays against a small scene by way of its facets: the parallelograms that two triangles make, and triangles left over. A facet
// is met where the ray meets its plane: twice as fast as two triangles tested one by one, but not watertight. So each answer is yes,
// no or too close to say, and rays of which one answer is too close are traced through shapes/few_triangles.h, which is.
//
// What is too close. Let u be half an ulp of one, q the distance from the ray's origin to the farthest point of the set, r the
// reciprocal of the product of direction and normal. Products of a plane's normal with the origin and with the direction are off by
// 11 u q and 6 u: three roundings of sums no larger than 1.8 q, of the normal, the offset and the origin one each, and corners off the
// plane by four at the most. If the ray does meet the facet, at a distance of no more than q, what is computed for that distance is off by
// (11 + 6) u q |r| + 2 u q; how far inside an edge the point lies, by as much and 18 u q, for the point's own rounding, the product with the row of
// u or v, and its data. So beyond 40 u q |r| a no is right. And so is a yes: it says that the point is inside by more than that, so that
// |r| is less than 1 / 40 u and the product that r stands for is not of the wrong sign. The watertight test may decide otherwise within
// its own error, 108 u q |r|; both agree beyond 128.
#ifndef WAVELOBE_SHAPES_FEW_FACETS_H
#define WAVELOBE_SHAPES_FEW_FACETS_H

#include "shapes/few_triangles.h"
#if !HAS_MASKS
#include "core/rows.h"
#include "shapes/few_pencil.h"

#define FACET_ERROR GAMMA(128)

// The rays as the test of one facet needs them, relative to the center of the set and in its unit.
typedef struct {
    Vec3 origin, direction;
    Float error; // of distances, for rays that meet the facet at a right angle
    UInt from;   // facet that a ray leaves
} FacetRay;

INLINE UInt facet_of(FewTriangles g, UInt number) {
    Int known = number < (UInt)g.summary->number_count;
    return SELECT(known, gather_uint(g.numbers, SELECT(known, number, (UInt)0u)), (UInt)FACET_NONE);
}

INLINE FacetRay facet_ray(FewTriangles g, const LaneRay *ray) {
    FacetRay r = {ray->off_center, ray->direction, FACET_ERROR * ray->farthest, facet_of(g, ray->from)};
    return r;
}

// Facets of the lanes, or one for all of them.
typedef struct {
    Vec3 normal, u, v;
    Float offset, u0, v0, height_u, height_v, height_w;
} Facet;

#define FACET_VECTOR(name) vec3(FACET_WORD(name, 0u), FACET_WORD(name, 1u), FACET_WORD(name, 2u))
#define FACET_FIELDS                                                                                                             \
    {FACET_VECTOR(normal), FACET_VECTOR(u), FACET_VECTOR(v), FACET_WORD(offset, 0u), FACET_WORD(u, 3u), FACET_WORD(v, 3u), \
     FACET_WORD(height_u, 0u), FACET_WORD(height_v, 0u), FACET_WORD(height_w, 0u)}

INLINE Facet one_facet(FewTriangles g, uint i) {
    global const float *words = (global const float *)(g.facets + i);
#define FACET_WORD(name, k) ((Float)words[WORD_OFFSET(FewFacet, name) + (k)])
    Facet f = FACET_FIELDS;
#undef FACET_WORD
    return f;
}

INLINE Facet facets_of_lanes(FewTriangles g, UInt i) {
    Rows r;
    gather_rows((global const float *)g.facets, i * RECORD_WORDS(FewFacet), &r);
#define FACET_WORD(name, k) r.word[WORD_OFFSET(FewFacet, name) + (k)]
    Facet f = FACET_FIELDS;
#undef FACET_WORD
    return f;
}

typedef struct {
    Float t, u, v;
    Float inside; // how far inside the nearest edge
    Float error;
} FacetPoint;

// Where the ray meets the plane. A triangle's third edge is left to the caller.
INLINE FacetPoint meet_plane(const FacetRay *r, Facet f) {
    Float approach = dot3(f.normal, r->direction), inverse = 1.0f / approach;
    Float away = madd(-f.normal.x, r->origin.x, madd(-f.normal.y, r->origin.y, madd(-f.normal.z, r->origin.z, f.offset)));
    FacetPoint p;
    p.t = away * inverse;
    Vec3 at = scale_add(r->direction, p.t, r->origin);
    p.u = madd(f.u.x, at.x, madd(f.u.y, at.y, madd(f.u.z, at.z, f.u0)));
    p.v = madd(f.v.x, at.x, madd(f.v.y, at.y, madd(f.v.z, at.z, f.v0)));
    p.inside = LESSER(madd(-f.height_u, fabs(p.u), f.height_u), madd(-f.height_v, fabs(p.v), f.height_v));
    p.error = fabs(inverse) * r->error;
    return p;
}

INLINE Float inside_third_edge(FacetPoint p, Facet f) { return LESSER(p.inside, -f.height_w * (p.u + p.v)); }

INLINE FacetPoint meet_facet(FewTriangles g, const FacetRay *r, uint i) {
    Facet f = one_facet(g, i);
    FacetPoint p = meet_plane(r, f);
    if (i >= g.summary->parallelogram_count) p.inside = inside_third_edge(p, f);
    return p;
}

// How far the point is within the facet's edges, and between the ray's origin and `limit`. What is not a number stays so, in this order of
// operands.
INLINE Float depth_within(FacetPoint p, Float limit) { return LESSER(LESSER(p.inside, p.t), limit - p.t); }

typedef struct {
    Float t, u, v, error;
    UInt facet; // FACET_NONE: nothing
    KeptMask unsure;
} NearestFacet;

// Not a number and infinity are unsure: comparisons say so.
INLINE void nearer_facet(FewTriangles g, const FacetRay *r, uint i, NearestFacet *n) {
    FacetPoint p = meet_facet(g, r, i);
    Float within = depth_within(p, n->t), error = p.error + n->error;
    Int other = r->from != (UInt)i, hit = (within > error) & other;
    n->unsure |= keep_mask(!(fabs(within) > error) & other);
    n->t = SELECT(hit, p.t, n->t);
    n->u = SELECT(hit, p.u, n->u);
    n->v = SELECT(hit, p.v, n->v);
    n->error = SELECT(hit, p.error, n->error);
    n->facet = SELECT(hit, (UInt)i, n->facet);
}

#if HAS_PENCILS
// Those that rays of the pencil may meet, in the order of all.
INLINE void nearer_facets_in_pencil(FewTriangles g, const Pencil *pencil, const FacetRay *r, NearestFacet *n) {
    uint count = g.summary->facet_count;
    for (uint first = 0u; first < count; first += LANES) {
        // By scalars: bits of lanes are dear where there is no instruction for them.
        uint present = (uint)((1ul << min(count - first, LANES + 0u)) - 1ul);
        uint bits = few_in_pencil(g.corners, first, pencil) & present;
        while (bits) {
            POP_LOWEST_BIT(bits, k);
            nearer_facet(g, r, first + k, n);
        }
    }
}
#endif

INLINE NearestFacet nearest_facet(FewTriangles g, const LaneRay *ray, const FacetRay *r, Float limit) {
    NearestFacet n = {limit * g.summary->per_length, ZERO, ZERO, ZERO, (UInt)FACET_NONE, keep_mask(!TRUE_MASK)};
#if HAS_PENCILS
    Pencil pencil;
    if (find_pencil(ray->origin, ray->direction, ray->unsure, &pencil)) {
        nearer_facets_in_pencil(g, &pencil, r, &n);
        return n;
    }
#endif
    for (uint i = 0u; i < g.summary->facet_count; i++) nearer_facet(g, r, i, &n);
    return n;
}

// Of its two triangles the one that is hit, and the weights of that one's second and third corner there.
INLINE LaneHit hit_of_facet(FewTriangles g, const NearestFacet *n, Float limit) {
    Int found = n->facet != (UInt)FACET_NONE, far = n->u + n->v > 0.0f;
    UInt word = SELECT(found, n->facet, (UInt)0u) * RECORD_WORDS(FewFacet) + SELECT(far, (UInt)1u, (UInt)0u);
    UInt part = gather_uint((global const uint *)g.facets + WORD_OFFSET(FewFacet, part), word);
    Float half_turn = SELECT(far, (Float)-0.5f, (Float)0.5f);
    Float of_u = madd(half_turn, n->u, (Float)0.5f), of_v = madd(half_turn, n->v, (Float)0.5f), rest = -half_turn * (n->u + n->v);
    UInt second = part >> 28 & (UInt)3u, third = part >> 30;
#define WEIGHT_OF(corner) SELECT((corner) == (UInt)1u, of_u, SELECT((corner) == (UInt)2u, of_v, rest))
    LaneHit h = {SELECT(found, n->t * (1.0f / g.summary->per_length), limit), WEIGHT_OF(second), WEIGHT_OF(third),
                 SELECT(found, part & (UInt)0xfffffffu, (UInt)HIT_NONE)};
#undef WEIGHT_OF
    return h;
}

// By the watertight test. Where a facet knows by itself that the ray meets it, its numbers are those of the hit, so that they do not depend
// on what other facets were unsure of.
INLINE LaneHit closest_if_unsure(FewTriangles g, const LaneRay *ray, const FacetRay *r, Float limit) {
    NearestTriangle nearest = closest_of_all(g, ray, limit);
    Int found = nearest.index != (UInt)HIT_NONE;
    UInt facet = GATHER_UINT_FIELD(g.triangles, FewTriangle, SELECT(found, nearest.index, (UInt)0u), facet);
    Facet f = facets_of_lanes(g, facet);
    FacetPoint p = meet_plane(r, f);
    Float inside = SELECT(facet >= (UInt)g.summary->parallelogram_count, inside_third_edge(p, f), p.inside);
    Int sure = found & (LESSER(inside, p.t) > p.error);
    LaneHit by_triangle = hit_of_triangle(g, &nearest, limit);
    NearestFacet n = {p.t, p.u, p.v, p.error, SELECT(sure, facet, (UInt)FACET_NONE), keep_mask(!sure)};
    return select_hit(sure, hit_of_facet(g, &n, limit), by_triangle);
}

// Lanes that are unsure of a facet which is not beyond the nearest one. What was too close to call may lie behind what was found later, or in
// one plane with it: then neither is nearer.
INLINE Int doubts_that_matter(FewTriangles g, const FacetRay *r, const NearestFacet *n) {
    KeptMask not_beyond = keep_mask(!TRUE_MASK);
    Int found = n->facet != (UInt)FACET_NONE;
    UInt plane = SELECT(found, GATHER_UINT_FIELD(g.facets, FewFacet, SELECT(found, n->facet, (UInt)0u), plane), (UInt)FACET_NONE);
    for (uint i = 0u; i < g.summary->facet_count; i++) {
        FacetPoint p = meet_facet(g, r, i);
        Int beyond = depth_within(p, n->t) < -(p.error + n->error);
        not_beyond |= keep_mask(!beyond & (r->from != (UInt)i) & (plane != (UInt)g.facets[i].plane));
    }
    return kept_mask(n->unsure & not_beyond);
}

INLINE LaneHit closest_triangle(FewTriangles g, const LaneRay *ray, Float limit) {
    FacetRay r = facet_ray(g, ray);
    NearestFacet n = nearest_facet(g, ray, &r, limit);
    LaneHit h = hit_of_facet(g, &n, limit);
    Int unsure = kept_mask(n.unsure);
    if (any_lane(unsure)) unsure = doubts_that_matter(g, &r, &n);
    if (UNLIKELY(any_lane(unsure))) h = select_hit(unsure, closest_if_unsure(g, ray, &r, limit), h);
    return h;
}

INLINE Int any_triangle(FewTriangles g, const LaneRay *ray, Float limit, UInt to, Int wanted) {
    FacetRay r = facet_ray(g, ray);
    UInt aim = facet_of(g, to);
    Float reach = limit * g.summary->per_length;
    KeptMask left = keep_mask(wanted), unsure = keep_mask(!TRUE_MASK);
    for (uint i = 0u; i < g.summary->facet_count; i++) {
        FacetPoint p = meet_facet(g, &r, i);
        Float within = depth_within(p, reach);
        Int other = (r.from != (UInt)i) & (aim != (UInt)i);
        left &= keep_mask(!((within > p.error) & other));
        unsure |= keep_mask(!(fabs(within) > p.error) & other);
        if (i % FEW_BETWEEN_LOOKS == 0u && !any_lane(kept_mask(left))) break;
    }
    unsure &= left;
    if (UNLIKELY(any_lane(kept_mask(unsure)))) left &= keep_mask(!any_of_all(g, ray, limit, kept_mask(unsure)));
    return wanted & !kept_mask(left);
}

#else
INLINE LaneHit closest_triangle(FewTriangles g, const LaneRay *ray, Float limit, UInt key) {
    NearestTriangle nearest = closest_of_all(g, ray, limit, key);
    return hit_of_triangle(g, &nearest, limit);
}

INLINE Int any_triangle(FewTriangles g, const LaneRay *ray, Float limit, UInt to, Int wanted, UInt key) {
    return any_of_all(g, ray, limit, wanted, key);
}
#endif

// The nearest hit of each ray in (0, limit). `from` is the number of the triangle that it leaves, or HIT_NONE.
INLINE LaneHit closest_of_few(FewTriangles g, Vec3 origin, Vec3 direction, Float limit, UInt from KEY_PARAMETER) {
    LaneRay ray = lane_ray(g, origin, direction, from);
    LaneHit h = closest_triangle(g, &ray, limit PASS_KEY);
#if HAS_ANALYTIC
    closest_few_analytic(g, origin, direction, &h PASS_KEY);
#endif
    return h;
}

// Lanes of `wanted` whose ray hits anything in (0, limit); `to` is the number of a triangle that it is aimed at, up to `limit`, or HIT_NONE.
INLINE Int any_of_few(FewTriangles g, Vec3 origin, Vec3 direction, Float limit, UInt from, UInt to, Int wanted KEY_PARAMETER) {
    LaneRay ray = lane_ray(g, origin, direction, from);
    Int blocked = any_triangle(g, &ray, limit, to, wanted PASS_KEY);
#if HAS_ANALYTIC
    blocked |= any_few_analytic(g, origin, direction, limit, wanted & !blocked PASS_KEY);
#endif
    return blocked;
}

#endif
