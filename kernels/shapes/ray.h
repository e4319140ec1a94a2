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
} Ray;

typedef struct {
    float t;
    float u, v;    // barycentric weights of the second and third vertex
    uint primitive; // HIT_NONE, a triangle slot, or HIT_ANALYTIC | index
} Hit;

#endif
