// How position changes with the texture coordinates of a triangle.
#ifndef WAVELOBE_SHAPES_TRIANGLE_TANGENTS_H
#define WAVELOBE_SHAPES_TRIANGLE_TANGENTS_H

#include "core/rows.h"
#include "core/vector.h"
#include "shared/types.h"

INLINE Int is_finite3(Vec3 v) { return (fabs(v.x) < LANE_INFINITY) & (fabs(v.y) < LANE_INFINITY) & (fabs(v.z) < LANE_INFINITY); }

// In: its edges from the first vertex, which are the answer where barycentric coordinates stand for texture coordinates.
// A triangle whose texture coordinates span no area has any two directions in its plane.
INLINE void triangle_tangents(global const float *uvs, UInt first_uv, UInt triangle, Vec3 normal, Vec3 *dp_du, Vec3 *dp_dv) {
    Int textured = first_uv != (UInt)WAVELOBE_NONE;
    UInt at = SELECT(textured, first_uv + triangle * 6u, (UInt)0u);
    Rows r;
    gather_rows(uvs, at, &r);
    Float u0 = r.word[0], v0 = r.word[1];
    Float du1 = r.word[2] - u0, dv1 = r.word[3] - v0, du2 = r.word[4] - u0, dv2 = r.word[5] - v0;
    Float inverse = 1.0f / difference_of_products(du1, dv2, dv1, du2);
    Vec3 along_u = scale(sub(scale(*dp_du, dv2), scale(*dp_dv, dv1)), inverse);
    Vec3 along_v = scale(sub(scale(*dp_dv, du1), scale(*dp_du, du2)), inverse);
    Int sound = is_finite3(along_u) & is_finite3(along_v);
    Frame any = frame_of_normal(normal);
    *dp_du = select3(textured, select3(sound, along_u, any.s), *dp_du);
    *dp_dv = select3(textured, select3(sound, along_v, any.t), *dp_dv);
}

#endif
