// Opacity in the traversal, one ray at a time: which hits of it count.
#ifndef WAVELOBE_SHAPES_MASKS_H
#define WAVELOBE_SHAPES_MASKS_H

#include "shapes/opacity.h"
#include "shapes/triangle_block.h"

// Of the triangles of `mask` those that the ray does not pass; u and v as intersect_triangle_block has them.
INLINE uint not_passed(OpacityView o, global const uchar *block, uint mask, const Ray *r, float8 u, float8 v) {
    uint8 primitives = *(global const uint8 *)(block + BLOCK_PRIMITIVE_BYTES);
    uint masked = mask & lane_bits8(as_int8(primitives) < 0);
    if (masked == 0u) return mask;
    primitives &= ~PRIMITIVE_MASKED;
#if LANES == 1
    uint ids[8] __attribute__((aligned(32))), passed = 0u;
    float us[8] __attribute__((aligned(32))), vs[8] __attribute__((aligned(32)));
    *(uint8 *)ids = primitives, *(float8 *)us = u, *(float8 *)vs = v;
    for (uint left = masked; left; left &= left - 1u) {
        uint i = lowest_bit(left);
        if (passes_triangle(o, r->key, ids[i], us[i], vs[i])) passed |= 1u << i;
    }
#else
    // What does not count must be harmless in the look-up.
    int8 asked = ((uint8)masked & (uint8)(1u, 2u, 4u, 8u, 16u, 32u, 64u, 128u)) != 0u;
    primitives = asked ? primitives : 0u;
    u = asked ? u : 0.0f;
    v = asked ? v : 0.0f;
#if LANES == 16
    Int passing = passes_triangle(o, (UInt)r->key, (UInt)(primitives, primitives), (Float)(u, u), (Float)(v, v));
#else
    Int passing = passes_triangle(o, (UInt)r->key, primitives, u, v);
#endif
    uint passed = lane_bits(passing) & masked;
#endif
    return mask & ~passed;
}

#if HAS_ANALYTIC
// Whether the ray passes analytic shape `index` where it hits it at distance t.
INLINE int passes_analytic(OpacityView o, global const struct Analytic *analytics, uint index, const Ray *r, float t) {
    UInt shape = gather_uint(o.primitive_shapes, (UInt)(o.triangle_count + index));
    Vec3 origin = vec3((Float)r->ox, (Float)r->oy, (Float)r->oz), direction = vec3((Float)r->dx, (Float)r->dy, (Float)r->dz);
    AnalyticHit h = analytic_hit(analytics, (UInt)index, origin, direction, (Float)t);
    // The two hits of a shape are drawn apart: one of them enters it, the other leaves.
    UInt side = SELECT(dot3(h.normal, direction) < 0.0f, (UInt)0u, (UInt)0x80000000u);
    UInt event = (UInt)(o.triangle_count + index) | side;
    return any_lane(passes((UInt)r->key, event, opacity_at(o, shape, h.u, h.v, ONE)));
}

// The first hit that counts of an entry of the analytic order, given its first hit t; `limit` or more: none.
INLINE float first_not_passed(OpacityView o, global const struct Analytic *analytics, uint entry, const Ray *r, float t,
                              float limit) {
    if (!(entry & PRIMITIVE_MASKED)) return t;
    uint index = entry & ~PRIMITIVE_MASKED;
    while (t < limit && passes_analytic(o, analytics, index, r, t)) t = intersect_analytic(analytics + index, r, t, limit);
    return t;
}
#endif

#endif
