// Texture coordinates of a point on a triangle.
#ifndef WAVELOBE_SHAPES_TRIANGLE_UVS_H
#define WAVELOBE_SHAPES_TRIANGLE_UVS_H

#include "core/lanes.h"
#include "shared/types.h"

// `first_uv` is the shape's offset into `uvs`, 6 a triangle; without one the barycentric coordinates serve.
INLINE void triangle_uvs(global const float *uvs, UInt first_uv, UInt triangle, Float wa, Float wb, Float wc, Float *u,
                         Float *v) {
    Int textured = first_uv != (UInt)WAVELOBE_NONE;
    UInt at = SELECT(textured, first_uv + triangle * 6u, (UInt)0u);
    Float u0 = gather(uvs, at), v0 = gather(uvs + 1, at), u1 = gather(uvs + 2, at), v1 = gather(uvs + 3, at);
    Float u2 = gather(uvs + 4, at), v2 = gather(uvs + 5, at);
    *u = SELECT(textured, madd(u0, wa, madd(u1, wb, u2 * wc)), wb);
    *v = SELECT(textured, madd(v0, wa, madd(v1, wb, v2 * wc)), wc);
}

#endif
