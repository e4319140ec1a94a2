// Texture coordinates of a point on a triangle.
#ifndef WAVELOBE_SHAPES_TRIANGLE_UVS_H
#define WAVELOBE_SHAPES_TRIANGLE_UVS_H

#include "core/rows.h"
#include "shared/types.h"

// `first_uv` is the shape's offset into `uvs`, 6 a triangle; without one the barycentric coordinates serve.
INLINE void triangle_uvs(global const float *uvs, UInt first_uv, UInt triangle, Float wa, Float wb, Float wc, Float *u,
                         Float *v) {
    Int textured = first_uv != (UInt)WAVELOBE_NONE;
    UInt at = SELECT(textured, first_uv + triangle * 6u, (UInt)0u);
    Rows r;
    gather_rows(uvs, at, &r);
    *u = SELECT(textured, madd(r.word[0], wa, madd(r.word[2], wb, r.word[4] * wc)), wb);
    *v = SELECT(textured, madd(r.word[1], wa, madd(r.word[3], wb, r.word[5] * wc)), wc);
}

#endif
