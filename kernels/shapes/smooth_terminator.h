// Where light leaves coarse meshes with smooth normals: the curved surface that the normals stand for, not the facet below it. Facets
// then no longer shade each other in steps along the terminator.
// Hanika 2021, "Hacking the Shadow Terminator" (Ray Tracing Gems II).
#ifndef WAVELOBE_SHAPES_SMOOTH_TERMINATOR_H
#define WAVELOBE_SHAPES_SMOOTH_TERMINATOR_H

#include "core/rounding.h"

// The way from a facet to the curved surface, on the side of the normals and on the other one. Where the surface bulges to one
// side it is zero on the other.
typedef struct {
    Vec3 front, behind;
} Rise;

INLINE Rise no_rise(void) {
    Rise none = {vec3_all(ZERO), vec3_all(ZERO)};
    return none;
}

// What a corner adds: the way from the point to the corner's tangent plane. `normal` may have any length.
INLINE void add_corner_rise(Rise *rise, Vec3 point, Vec3 corner, Vec3 normal, Float weight) {
    Float height = dot3(sub(point, corner), normal);
    Float square = length_squared(normal);
    Vec3 way = scale(normal, -weight * height / SELECT(square > 0.0f, square, ONE));
    Vec3 nowhere = vec3_all(ZERO);
    rise->front = add(rise->front, select3(height < 0.0f, way, nowhere));
    rise->behind = add(rise->behind, select3(height > 0.0f, way, nowhere));
}

// Zero where normals that differ wildly would lead below the facet. `normal` is the facet's, `shading` on the side of the corners'.
INLINE Rise rise_above(Rise rise, Vec3 normal, Vec3 shading) {
    Vec3 up = select3(dot3(normal, shading) < 0.0f, negate(normal), normal);
    Vec3 nowhere = vec3_all(ZERO);
    rise.front = select3(dot3(rise.front, up) > 0.0f, rise.front, nowhere);
    rise.behind = select3(dot3(rise.behind, up) < 0.0f, rise.behind, nowhere);
    return rise;
}

// Moves a point known within +-error; the bound stays one.
INLINE void raise_point(Vec3 rise, Vec3 *position, Vec3 *error) {
    *position = add(*position, rise);
    *error = scale_add(absolute(*position), (Float)GAMMA(2), *error);
}

#endif
