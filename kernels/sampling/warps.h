// Maps from the unit square to the domains that are sampled; each keeps areas, so that stratification survives.
#ifndef WAVELOBE_SAMPLING_WARPS_H
#define WAVELOBE_SAMPLING_WARPS_H

#include "core/math.h"
#include "core/vector.h"
#include "shared/filter_table.h"

typedef struct {
    Float x, y;
} Vec2;

// Evenly over the unit disk; *radius is the distance from the centre. Shirley and Chiu 1997, "A Low Distortion Map
// Between Disk and Square": concentric squares become circles.
INLINE Vec2 square_to_disk_radius(Float u1, Float u2, Float *radius) {
    Float a = madd(u1, (Float)2.0f, (Float)-1.0f);
    Float b = madd(u2, (Float)2.0f, (Float)-1.0f);
    Int flat = fabs(a) > fabs(b);
    Float r = SELECT(flat, a, b);
    Float ratio = SELECT(flat, b, a) / r;
    ratio = SELECT(r == 0.0f, ZERO, ratio);
    Float s, c;
    sin_cos_of_quarters(ratio * 0.5f, &s, &c);
    Vec2 p = {r * SELECT(flat, c, s), r * SELECT(flat, s, c)};
    *radius = fabs(r);
    return p;
}

INLINE Vec2 square_to_disk(Float u1, Float u2) {
    Float radius;
    return square_to_disk_radius(u1, u2, &radius);
}

// About +z, with density cos / pi: a point of the disk lifted to the hemisphere (Malley's method).
INLINE Vec3 sample_cosine_hemisphere(Float u1, Float u2) {
    Float r;
    Vec2 d = square_to_disk_radius(u1, u2, &r);
    return vec3(d.x, d.y, sqrt((ONE - r) * (ONE + r)));
}

// Density of sample_cosine_hemisphere, 1 / sr.
INLINE Float cosine_hemisphere_pdf(Float cos_theta) { return GREATER(cos_theta, ZERO) * INV_PI; }

// Evenly over the unit sphere, density 1 / (4 pi): height is even (Archimedes), so is azimuth.
INLINE Vec3 square_to_uniform_sphere(Float u1, Float u2) {
    Float r = 2.0f * sqrt(u1 * (ONE - u1));
    Float s, c;
    lane_sin_cos_turns(u2, &s, &c);
    return vec3(r * c, r * s, madd(u1, (Float)-2.0f, ONE));
}

// Evenly over a triangle: barycentric coordinates of its second and third vertex, x + y <= 1. Heitz 2019, "A
// Low-Distortion Map Between Triangle and Square".
INLINE Vec2 square_to_triangle(Float u1, Float u2) {
    Float half_lesser = 0.5f * LESSER(u1, u2);
    Int above = u2 > u1;
    Vec2 b = {SELECT(above, half_lesser, u1 - half_lesser), SELECT(above, u2 - half_lesser, half_lesser)};
    return b;
}

// The cell of the filter's table that holds the share `tail`.
INLINE Int filter_cell(Float tail) {
    Int cell = convert_Int(sqrt(tail) * (float)FILTER_TABLE_CELLS);
    return SELECT(cell < (Int)FILTER_TABLE_CELLS, cell, (Int)(FILTER_TABLE_CELLS - 1u));
}

// An offset from the pixel centre, in pixels, with the density of the reconstruction filter along one axis, by inversion
// of its tails (host/tables/filter_table.h). Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling".
INLINE Float sample_filter(global const float *table, Float u) {
    Float v = madd(u, (Float)2.0f, (Float)-1.0f);
    Float tail = ONE - fabs(v); // share of the filter beyond the offset
    Int cell = filter_cell(tail);
    Float i = convert_Float(cell);
    Float far = gather(table, as_UInt(cell));
    Float near = gather(table + 1, as_UInt(cell));
    // The cell holds the shares from i^2 to (i + 1)^2, in units of 1 / FILTER_TABLE_CELLS^2.
    Float position = madd(tail, (Float)((float)FILTER_TABLE_CELLS * (float)FILTER_TABLE_CELLS), -i * i) / madd(i, (Float)2.0f, ONE);
    return copy_sign(madd(position, near - far, far), v);
}

// What the sample that `u` places along one axis counts, for filters that are negative somewhere: their absolute value is
// drawn from. The mean over u is one.
INLINE Float filter_weight(global const float *table, Float u) {
    Float tail = ONE - fabs(madd(u, (Float)2.0f, (Float)-1.0f));
    return gather(table + FILTER_TABLE_WEIGHTS, as_UInt(filter_cell(tail)));
}

#endif
