// Facets that no ray of a pencil, LANES rays from one point, can meet: found LANES facets at a time, so that camera rays are
// tested against a few of the few alone. Nothing is left out that the test of shapes/few_triangles.h would say is hit.
//
// A facet is left out if its corners lie on the outer side of one of the planes around the pencil, by PENCIL_MARGIN at least,
// and the volume V of the tetrahedron that its triangles make with the origin is no less than PENCIL_VOLUME, both in units of the distance q of
// its farthest corner and of its cube. (And no less than what makes depths sure.)
//
// Why none is missed: with the areas w that the test takes from the turned corners v, sum(w v) is the depth times the ray's direction
// d, and the depth is 6 V or -6 V. If the depth is negative it is beyond what is unsure, and no hit. Otherwise take the dot product
// with the plane's normal n, no longer than 2: n d >= -2^-20 for rays within the plane as it is rounded, so
// sum(w (n v)) >= -2^-20 q^3, where n v <= -2^-7 q. A hit has no w below minus the rounding of two products, 2^-22 q^2; so all
// positive w are 2^-12 q^2 together at the most, and the depth no more than 2^-12 q^3.
#ifndef WAVELOBE_SHAPES_FEW_PENCIL_H
#define WAVELOBE_SHAPES_FEW_PENCIL_H

#include "core/vector.h"
#include "shared/bvh.h"

#define HAS_PENCILS (LANES > 1)

#define PENCIL_MARGIN 0x1p-8f
#define PENCIL_VOLUME 0x1p-10f // six times V
#define PENCIL_COSINE 0.5f     // of no ray with the first one is it less

typedef struct {
    Vec3 origin;
    Frame frame; // around the first ray
    Float low_x, high_x, low_y, high_y; // tangents
    Float least_volume;
} Pencil;

#if HAS_PENCILS

INLINE Vec3 first_of_lanes(Vec3 v) { return vec3((Float)FIRST_LANE(v.x), (Float)FIRST_LANE(v.y), (Float)FIRST_LANE(v.z)); }

// Whether the rays are a pencil. Depths no larger than `unsure` say nothing.
INLINE int find_pencil(Vec3 origin, Vec3 direction, Float unsure, Pencil *p) {
    Vec3 from = first_of_lanes(origin);
    if (any_lane((origin.x != from.x) | (origin.y != from.y) | (origin.z != from.z))) return 0;
    p->origin = from;
    p->frame = frame_of_normal(first_of_lanes(direction));
    Vec3 d = to_local(p->frame, direction);
    if (any_lane(!(d.z >= PENCIL_COSINE))) return 0;
    Float x = d.x / d.z, y = d.y / d.z;
    p->low_x = (Float)least_lane(x);
    p->high_x = (Float)-least_lane(-x);
    p->low_y = (Float)least_lane(y);
    p->high_y = (Float)-least_lane(-y);
    p->least_volume = 2.0f * unsure;
    return 1;
}

// Bits of those of the LANES facets from `first` on that rays of the pencil may meet. `corners` holds a row of coordinates
// after the other, FEW_CORNER_ROWS in all.
INLINE uint few_in_pencil(global const float *corners, uint first, const Pencil *p) {
#define FEW_ROW(row) load(corners + (row) * FEW_TRIANGLES_MAX + first)
    Float farthest2 = ZERO;
    // How far the corner nearest to each plane is beyond it.
    Float left = (Float)INFINITY, right = left, below = left, above = left, behind = left;
    Vec3 way = vec3_all(ZERO); // to a corner
    for (uint k = 0u; k < 4u; k++) {
        way = sub(vec3(FEW_ROW(3u * k), FEW_ROW(3u * k + 1u), FEW_ROW(3u * k + 2u)), p->origin);
        Vec3 v = to_local(p->frame, way);
        farthest2 = GREATER(farthest2, length_squared(v));
        left = LESSER(left, madd(p->low_x, v.z, -v.x));
        right = LESSER(right, madd(-p->high_x, v.z, v.x));
        below = LESSER(below, madd(p->low_y, v.z, -v.y));
        above = LESSER(above, madd(-p->high_y, v.z, v.y));
        behind = LESSER(behind, -v.z);
    }
    Float volume = fabs(dot3(vec3(FEW_ROW(12u), FEW_ROW(13u), FEW_ROW(14u)), way));
#undef FEW_ROW
    Float farthest = sqrt(farthest2), beyond = GREATER(GREATER(GREATER(left, right), GREATER(below, above)), behind);
    // Twice the margin: the normals of the planes are not of unit length, but of no more than two.
    Int outside = (beyond > 2.0f * PENCIL_MARGIN * farthest) & (volume >= PENCIL_VOLUME * farthest * farthest2) & (volume >= p->least_volume);
    return lane_bits(!outside);
}

#endif
#endif
