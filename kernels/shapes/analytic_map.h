// The affine map of an analytic shape, and how far rounding can move a point off its surface.
//
// Where the surface is: the points p whose (rows of to_object) * (p - translation of to_world) lie on the unit shape; for
// a sphere, whose distance to the translation is the radius.  The translation of to_object is not used: it would cost
// the digits that a shape far from the origin needs.
#ifndef WAVELOBE_SHAPES_ANALYTIC_MAP_H
#define WAVELOBE_SHAPES_ANALYTIC_MAP_H

#include "core/rounding.h"
#include "shared/lights.h"

typedef struct {
    Vec3 origin;                       // where the unit shape's origin is
    Vec3 column_x, column_y, column_z; // linear part of to_world
    Vec3 row_x, row_y, row_z;          // linear part of to_object
    UInt kind;
    Float flip, radius;
} AnalyticMap;

#define ANALYTIC_WORD(field, k) gather(words + WORD_OFFSET(Analytic, field) + (k), first)

INLINE AnalyticMap analytic_map(global const struct Analytic *analytics, UInt index) {
    global const float *words = (global const float *)analytics;
    UInt first = index * RECORD_WORDS(Analytic);
    AnalyticMap m;
    m.column_x = vec3(ANALYTIC_WORD(to_world, 0u), ANALYTIC_WORD(to_world, 4u), ANALYTIC_WORD(to_world, 8u));
    m.column_y = vec3(ANALYTIC_WORD(to_world, 1u), ANALYTIC_WORD(to_world, 5u), ANALYTIC_WORD(to_world, 9u));
    m.column_z = vec3(ANALYTIC_WORD(to_world, 2u), ANALYTIC_WORD(to_world, 6u), ANALYTIC_WORD(to_world, 10u));
    m.origin = vec3(ANALYTIC_WORD(to_world, 3u), ANALYTIC_WORD(to_world, 7u), ANALYTIC_WORD(to_world, 11u));
    m.row_x = vec3(ANALYTIC_WORD(to_object, 0u), ANALYTIC_WORD(to_object, 1u), ANALYTIC_WORD(to_object, 2u));
    m.row_y = vec3(ANALYTIC_WORD(to_object, 4u), ANALYTIC_WORD(to_object, 5u), ANALYTIC_WORD(to_object, 6u));
    m.row_z = vec3(ANALYTIC_WORD(to_object, 8u), ANALYTIC_WORD(to_object, 9u), ANALYTIC_WORD(to_object, 10u));
    m.kind = as_UInt(ANALYTIC_WORD(kind, 0u));
    m.flip = ANALYTIC_WORD(flip, 0u);
    m.radius = ANALYTIC_WORD(radius, 0u);
    return m;
}

// World to object space, for an offset from the shape's origin.
INLINE Vec3 map_to_object(AnalyticMap m, Vec3 offset) {
    return vec3(dot3(m.row_x, offset), dot3(m.row_y, offset), dot3(m.row_z, offset));
}

// World-space vector of an object-space one.
INLINE Vec3 map_to_world(AnalyticMap m, Vec3 v) {
    return scale_add(m.column_x, v.x, scale_add(m.column_y, v.y, scale(m.column_z, v.z)));
}

// World-space gradient of an object-space level set with gradient `g`; the surface normal's direction.
INLINE Vec3 map_gradient(AnalyticMap m, Vec3 g) {
    return scale_add(m.row_x, g.x, scale_add(m.row_y, g.y, scale(m.row_z, g.z)));
}

// Sum over the products |row| |offset|, weighted with the gradient and taken to world space along the normal: one
// rounding error of map_to_object moves a point by at most this times HALF_ULP.
INLINE Float map_sensitivity(AnalyticMap m, Vec3 offset, Vec3 g, Float gradient_length) {
    Vec3 a = absolute(offset);
    Vec3 sums = vec3(dot3(absolute(m.row_x), a), dot3(absolute(m.row_y), a), dot3(absolute(m.row_z), a));
    return dot3(absolute(g), sums) / gradient_length;
}

typedef struct {
    Vec3 position, error; // world space; bound on the distance to the surface along each axis
    Vec3 normal;          // unit, after the flip
} AnalyticPoint;

// The point of a disk or cylinder at `object` in object space, where the gradient of its level set is `g` (unit).
INLINE AnalyticPoint analytic_point(AnalyticMap m, Vec3 object, Vec3 g) {
    Vec3 offset = map_to_world(m, object);
    Vec3 spread = scale_add(absolute(m.column_x), fabs(object.x),
                            scale_add(absolute(m.column_y), fabs(object.y), scale(absolute(m.column_z), fabs(object.z))));
    Vec3 gradient = map_gradient(m, g);
    Float gradient_length = sqrt(length_squared(gradient));
    AnalyticPoint p;
    p.position = add(m.origin, offset);
    p.normal = scale(gradient, m.flip / gradient_length);
    // Along each axis: one rounding of `object` (two for a sine or cosine), one of the columns, five of products and sums.
    // Along the normal: one of the rows, which are the rounded inverse of the columns.
    Float across = GAMMA(2) * map_sensitivity(m, offset, g, gradient_length);
    p.error = scale_add(absolute(p.normal), across, scale(add(absolute(m.origin), spread), (Float)GAMMA(8)));
    return p;
}

#endif
