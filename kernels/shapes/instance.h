// Instances: groups of shapes that stand in several places. Rays go to the group's space, surfaces come back from it.
//
// The ray is moved to the instance's origin first, so that the rounding of the map is relative to the distance from there
// and not to the world's coordinates. Its direction is made unit again. What both maps may round is part of the surface's
// error bound, and a ray that leaves a surface stays on its side in the group's space too. (Pharr, Jakob, Humphreys, "Physically Based Rendering", "Managing Rounding Error".)
#ifndef WAVELOBE_SHAPES_INSTANCE_H
#define WAVELOBE_SHAPES_INSTANCE_H

#include "core/rounding.h"
#include "shapes/ray.h"

// The same ray in the space of the instance's group, where its distances are `stretch` times as long.
INLINE Ray instance_ray(global const struct Instance *instances, uint index, const Ray *r, float *stretch) {
    global const struct Instance *s = instances + index;
    global const float *w = s->to_world.m, *m = s->to_object;
    float fx = r->ox - w[3], fy = r->oy - w[7], fz = r->oz - w[11];
    float dx = m[0] * r->dx + m[1] * r->dy + m[2] * r->dz;
    float dy = m[3] * r->dx + m[4] * r->dy + m[5] * r->dz;
    float dz = m[6] * r->dx + m[7] * r->dy + m[8] * r->dz;
    float length = sqrt(dx * dx + dy * dy + dz * dz), shrink = 1.0f / length;
    Ray moved = *r;
    moved.ox = m[0] * fx + m[1] * fy + m[2] * fz;
    moved.oy = m[3] * fx + m[4] * fy + m[5] * fz;
    moved.oz = m[6] * fx + m[7] * fy + m[8] * fz;
    moved.dx = dx * shrink;
    moved.dy = dy * shrink;
    moved.dz = dz * shrink;
    moved.limit = r->limit * length;
    moved.from = HIT_NONE; // the triangle it leaves may stand in its way elsewhere: error bounds see to the rest
#if HAS_MASKS
    moved.key ^= (index + 1u) * 0x9e3779b9u; // the instances of a shape are passed one by one
#endif
    *stretch = length;
    return moved;
}

// ---- LANES at a time --------------------------------------------------------------------------------------------

typedef struct {
    Vec3 origin;               // of the group's space
    Vec3 row_x, row_y, row_z;  // linear part of to_world
    Vec3 back_x, back_y, back_z; // rows of to_object
    Int placed;                // lanes in an instance
} InstanceMap;

#define INSTANCE_WORD(k) gather(words + (k), first)
#define INSTANCE_ROW(k) vec3(INSTANCE_WORD(k), INSTANCE_WORD((k) + 1u), INSTANCE_WORD((k) + 2u))

// `instance` is INSTANCE_NONE in lanes outside of any.
INLINE InstanceMap instance_map(global const struct Instance *instances, UInt instance) {
    InstanceMap m;
    m.placed = instance != (UInt)INSTANCE_NONE;
    global const float *words = (global const float *)instances;
    UInt first = SELECT(m.placed, instance, (UInt)0u) * RECORD_WORDS(Instance);
    m.row_x = INSTANCE_ROW(0u);
    m.row_y = INSTANCE_ROW(4u);
    m.row_z = INSTANCE_ROW(8u);
    m.origin = vec3(INSTANCE_WORD(3u), INSTANCE_WORD(7u), INSTANCE_WORD(11u));
    uint back = WORD_OFFSET(Instance, to_object);
    m.back_x = INSTANCE_ROW(back);
    m.back_y = INSTANCE_ROW(back + 3u);
    m.back_z = INSTANCE_ROW(back + 6u);
    return m;
}

INLINE Vec3 rows_times(Vec3 x, Vec3 y, Vec3 z, Vec3 v) { return vec3(dot3(x, v), dot3(y, v), dot3(z, v)); }

INLINE Vec3 instance_vector(const InstanceMap *m, Vec3 v) { return rows_times(m->row_x, m->row_y, m->row_z, v); }
INLINE Vec3 vector_to_instance(const InstanceMap *m, Vec3 v) { return rows_times(m->back_x, m->back_y, m->back_z, v); }
INLINE Vec3 point_to_instance(const InstanceMap *m, Vec3 p) { return vector_to_instance(m, sub(p, m->origin)); }

// A normal's direction, of any length: it stays on its side of the surface, mirrored or not.
INLINE Vec3 instance_normal(const InstanceMap *m, Vec3 n) {
    return scale_add(m->back_x, n.x, scale_add(m->back_y, n.y, scale(m->back_z, n.z)));
}

// A point known within +-error in the group's space; the bound becomes one for the world, in which rays that leave the
// point clear its surface after their way back into the group's space.
INLINE Vec3 instance_point(const InstanceMap *m, Vec3 p, Vec3 *error) {
    Vec3 row_x = absolute(m->row_x), row_y = absolute(m->row_y), row_z = absolute(m->row_z);
    Vec3 reach = rows_times(row_x, row_y, row_z, absolute(p));
    // The way back: a subtraction, a rounding of the matrix, a product of three terms; one more for what is summed here.
    Vec3 back = rows_times(absolute(m->back_x), absolute(m->back_y), absolute(m->back_z), reach);
    Vec3 in_group = scale_add(back, (Float)GAMMA(7), *error);
    // The way here: a product of three terms and a sum.
    Vec3 here = scale(add(absolute(m->origin), reach), (Float)GAMMA(6));
    *error = scale(add(rows_times(row_x, row_y, row_z, in_group), here), (Float)(1.0f + GAMMA(8)));
    return add(m->origin, instance_vector(m, p));
}

#endif
