// Directions from which caustics arrive, as photons have found them: a share of the samples of diffuse surfaces goes there. A proposal and
// no more: densities are mixtures with those of the lobes, whatever the maps hold.
// After Jensen 1995, "Importance Driven Path Tracing Using the Photon Map".
#ifndef WAVELOBE_CAUSTICS_GUIDE_H
#define WAVELOBE_CAUSTICS_GUIDE_H

#include "core/math.h"
#include "core/vector.h"
#include "shared/caustics.h"

typedef struct {
    global const struct CausticGrid *grid;
    global const uint *cells; // number of each cell's map plus one; 0: it has none
    global const float *maps;
} CausticView;

// What guides a lane's sample: the offset of a map, and the share of samples that follow it.
typedef struct {
    UInt map;
    Float share;
} CausticGuide;

// The whole part of a number of [0, steps); those outside count to the first and the last.
INLINE UInt step_of(Float x, uint steps) { return as_UInt(convert_Int(LESSER(GREATER(x, ZERO), (Float)(steps - 1u)))); }

// Lanes outside of the grid are not `within`; their cell means nothing, but is one.
INLINE UInt caustic_cell(global const struct CausticGrid *g, Vec3 p, Int *within) {
    Float x = (p.x - g->origin[0]) * g->inverse_step, y = (p.y - g->origin[1]) * g->inverse_step, z = (p.z - g->origin[2]) * g->inverse_step;
    *within = (x >= 0.0f) & (x < (float)g->size[0]) & (y >= 0.0f) & (y < (float)g->size[1]) & (z >= 0.0f) & (z < (float)g->size[2]);
    return (step_of(z, g->size[2]) * g->size[1] + step_of(y, g->size[1])) * g->size[0] + step_of(x, g->size[0]);
}

INLINE CausticGuide caustic_guide(CausticView v, Vec3 position, Int wanted) {
    Int within;
    UInt cell = caustic_cell(v.grid, position, &within);
    UInt map = gather_uint(v.cells, cell);
    Int there = wanted & within & (map != (UInt)0u);
    CausticGuide g = {SELECT(there, map - (UInt)1u, (UInt)0u) * CAUSTIC_MAP_FLOATS, ZERO};
    if (any_lane(there)) g.share = SELECT(there, gather(v.maps, g.map + CAUSTIC_SHARE), ZERO);
    return g;
}

INLINE UInt caustic_bin(Vec3 d) {
    Float row = madd(d.z, (Float)(0.5f * CAUSTIC_ROWS), (Float)(0.5f * CAUSTIC_ROWS));
    Float column = madd(lane_atan2(d.y, d.x), (Float)(INV_TWO_PI_F * CAUSTIC_COLUMNS), (Float)(0.5f * CAUSTIC_COLUMNS));
    return step_of(row, CAUSTIC_ROWS) * CAUSTIC_COLUMNS + step_of(column, CAUSTIC_COLUMNS);
}

// Density of `caustic_sample` producing a unit direction, mixed with that of the lobes, `pdf`.
INLINE Float guided_pdf(CausticView v, CausticGuide g, Float pdf, Vec3 direction) {
    if (!any_lane(g.share > 0.0f)) return pdf;
    Float density = gather(v.maps, g.map + CAUSTIC_DENSITIES + caustic_bin(direction));
    return madd(g.share, density - pdf, pdf);
}

// The first of sixteen running sums beyond *u, which becomes the place between it and the sum before. Not at either end: a direction
// whose last bits put it into the next bin would have another density.
INLINE UInt find_sum(global const float *sums, UInt first, Float *u) {
    UInt at = (UInt)0u;
#pragma unroll
    for (uint step = 8u; step != 0u; step >>= 1) at += SELECT(*u >= gather(sums, first + at + (step - 1u)), (UInt)step, (UInt)0u);
    Float upper = gather(sums, first + at);
    Float lower = SELECT(at == (UInt)0u, ZERO, gather(sums, first + at - SELECT(at == (UInt)0u, (UInt)0u, (UInt)1u)));
    *u = LESSER(GREATER((*u - lower) / (upper - lower), (Float)0x1p-18f), (Float)(1.0f - 0x1p-18f));
    return at;
}

INLINE Vec3 caustic_sample(CausticView v, CausticGuide g, Float u1, Float u2) {
    UInt row = find_sum(v.maps, g.map, &u1);
    UInt column = find_sum(v.maps, g.map + CAUSTIC_SUMS_WITHIN + row * CAUSTIC_COLUMNS, &u2);
    Float z = madd(convert_Float(as_Int(row)) + u1, (Float)(2.0f / CAUSTIC_ROWS), (Float)-1.0f);
    Float turns = madd(convert_Float(as_Int(column)) + u2, (Float)(1.0f / CAUSTIC_COLUMNS), (Float)-0.5f);
    Float r = sqrt(GREATER(madd(-z, z, ONE), ZERO)), sine, cosine;
    lane_sin_cos_turns(turns, &sine, &cosine);
    return vec3(r * cosine, r * sine, z);
}

#endif
