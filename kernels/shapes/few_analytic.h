// LANES rays against the spheres, disks and cylinders of a small scene: all rays against the box of each, then one by one
// those that meet it. Included by shapes/few_triangles.h.
#ifndef WAVELOBE_SHAPES_FEW_ANALYTIC_H
#define WAVELOBE_SHAPES_FEW_ANALYTIC_H

#include "shapes/analytic_geometry.h"
#include "shapes/box_test.h"
#if HAS_MASKS
#include "shapes/masks.h"
#endif

// A group of rays as boxes see them, and where each ray can be picked out.
typedef struct {
    Vec3 origin, reciprocal;
    float part[6][LANES] __attribute__((aligned(64)));
#if HAS_MASKS
    uint key[LANES] __attribute__((aligned(64)));
#endif
} BoxedRays;

INLINE void box_rays(Vec3 origin, Vec3 direction, BoxedRays *r KEY_PARAMETER) {
    r->origin = origin;
    r->reciprocal = vec3(reciprocal_lanes(direction.x), reciprocal_lanes(direction.y), reciprocal_lanes(direction.z));
    *(Float *)r->part[0] = origin.x, *(Float *)r->part[1] = origin.y, *(Float *)r->part[2] = origin.z;
    *(Float *)r->part[3] = direction.x, *(Float *)r->part[4] = direction.y, *(Float *)r->part[5] = direction.z;
#if HAS_MASKS
    *(UInt *)r->key = key;
#endif
}

// Bits of the rays that meet the box of `a` before `limit`; as intersect_children tests one ray.
INLINE uint rays_in_box(global const struct FewAnalytic *a, const BoxedRays *r, Float limit) {
    Float enter = ZERO, leave = REACH(limit);
#define WITHIN_SLAB(axis, k)                                                                                  \
    {                                                                                                         \
        Float lower = ((Float)a->lower[k] - r->origin.axis) * r->reciprocal.axis;                             \
        Float upper = ((Float)a->upper[k] - r->origin.axis) * r->reciprocal.axis;                             \
        enter = GREATER(enter, LESSER(lower, upper));                                                         \
        leave = LESSER(leave, GREATER(lower, upper) * FAR_WIDENING);                                          \
    }
    WITHIN_SLAB(x, 0)
    WITHIN_SLAB(y, 1)
    WITHIN_SLAB(z, 2)
#undef WITHIN_SLAB
    return lane_bits(enter <= leave);
}

// Distance at which ray k hits the shape, `limit` or more: not below it.
INLINE float meet_few_analytic(FewTriangles g, uint entry, const BoxedRays *rays, uint k, float limit) {
    Ray r = {rays->part[0][k], rays->part[1][k], rays->part[2][k], rays->part[3][k], rays->part[4][k], rays->part[5][k],
             limit, HIT_NONE,
#if HAS_MASKS
             rays->key[k],
#endif
    };
    float t = intersect_analytic(g.analytics + TRIANGLE_NUMBERS(entry), &r, 0.0f, limit);
#if HAS_MASKS
    t = first_not_passed(g.opacity, g.analytics, entry, &r, t, limit);
#endif
    return t;
}

// What is nearer than *hit.
INLINE void closest_few_analytic(FewTriangles g, Vec3 origin, Vec3 direction, LaneHit *hit KEY_PARAMETER) {
    BoxedRays rays;
    box_rays(origin, direction, &rays PASS_KEY);
    float nearest[LANES] __attribute__((aligned(64)));
    uint slot[LANES] __attribute__((aligned(64)));
    *(Float *)nearest = hit->t;
    *(UInt *)slot = hit->slot;
    for (uint i = 0u; i < g.summary->analytic_count; i++) {
        uint met = rays_in_box(g.few_analytics + i, &rays, *(Float *)nearest), entry = g.few_analytics[i].entry;
        while (met) {
            POP_LOWEST_BIT(met, k);
            float t = meet_few_analytic(g, entry, &rays, k, nearest[k]);
            if (!(t < nearest[k])) continue;
            nearest[k] = t;
            slot[k] = HIT_ANALYTIC | TRIANGLE_NUMBERS(entry);
        }
    }
    hit->t = *(Float *)nearest;
    hit->slot = *(UInt *)slot;
}

// Lanes of `wanted` whose ray hits any of the shapes in (0, limit).
INLINE Int any_few_analytic(FewTriangles g, Vec3 origin, Vec3 direction, Float limit, Int wanted KEY_PARAMETER) {
    BoxedRays rays;
    box_rays(origin, direction, &rays PASS_KEY);
    float reach[LANES] __attribute__((aligned(64)));
    *(Float *)reach = limit;
    uint asked = lane_bits(wanted), blocked = 0u;
    for (uint i = 0u; i < g.summary->analytic_count && asked != 0u; i++) {
        uint met = asked & rays_in_box(g.few_analytics + i, &rays, limit), entry = g.few_analytics[i].entry;
        while (met) {
            POP_LOWEST_BIT(met, k);
            blocked |= meet_few_analytic(g, entry, &rays, k, reach[k]) < reach[k] ? 1u << k : 0u;
        }
        asked &= ~blocked;
    }
    return mask_of_bits(blocked);
}

#endif
