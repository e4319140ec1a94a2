// A ray and what it hits, one at a time: traversal is scalar in rays and vectorised over children and triangles.
#ifndef WAVELOBE_SHAPES_RAY_H
#define WAVELOBE_SHAPES_RAY_H

#include "core/lanes.h"
#include "shared/bvh.h"

// Hits lie strictly between 0 and `limit`.
typedef struct {
    float ox, oy, oz;
    float dx, dy, dz; // unit
    float limit;
    uint from; // number of the triangle that the ray leaves and cannot meet; HIT_NONE: it leaves none
#if HAS_MASKS
    uint key; // what is drawn where opacity lets some rays pass (shapes/opacity.h)
#endif
} Ray;

typedef struct {
    float t;
    float u, v;    // barycentric weights of the second and third vertex
    uint primitive; // HIT_NONE, a triangle slot, or HIT_ANALYTIC | index
#if HAS_INSTANCES
    uint instance; // in which the primitive was hit, or INSTANCE_NONE
#endif
} Hit;

// Numbers of triangles from what blocks hold of them.
#if HAS_MASKS
#define TRIANGLE_NUMBERS(entries) ((entries) & ~PRIMITIVE_MASKED)
#else
#define TRIANGLE_NUMBERS(entries) (entries)
#endif

// Rays that are not numbers hit nothing. The box test must not see them: which of its comparisons a NaN passes is chance.
INLINE int is_finite_ray(const Ray *r) {
    return (r->ox - r->ox) + (r->oy - r->oy) + (r->oz - r->oz) + (r->dx - r->dx) + (r->dy - r->dy) + (r->dz - r->dz) == 0.0f;
}

#endif
