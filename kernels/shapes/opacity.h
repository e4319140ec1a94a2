// Opacity: which rays pass a shape that is only partly there.
//
// A ray passes a point with probability 1 - opacity. The draw is a hash of the ray and the primitive: the same whenever the
// traversal meets that point, in whatever order and however often (spatial splits put triangles into several leaves), and
// without effect where the opacity is 0 or 1. Shadow rays draw likewise: the product of all transmittances would vary
// less, but any-hit traversal would then have to count each triangle once and to go on to the last.
//
// Stochastic transparency after Enderton, Sintorn, Shirley, Luebke 2010.
#ifndef WAVELOBE_SHAPES_OPACITY_H
#define WAVELOBE_SHAPES_OPACITY_H

#include "core/block.h"
#include "shapes/triangle_uvs.h"
#include "shared/bvh.h"
#include "shared/materials.h"
#include "shared/scene.h"
#include "stages/dimensions.h"
#if HAS_TEXTURES
#include "bsdf/lobe.h"
#endif

// What shapes with opacity are looked up in.
typedef struct {
    struct SampleSequence sequence;
    global const struct Opacity *opacities; // one a shape
    global const uint *primitive_shapes;
    global const struct Shape *shapes;
    uint triangle_count; // primitives from here on are analytic shapes
#if HAS_UVS
    global const float *uvs;
#endif
#if HAS_TEXTURES
    global const struct Texture *textures;
    global const float *texels;
#endif
} OpacityView;

#if HAS_UVS
#define OPACITY_UVS_ARGUMENT , uvs
#else
#define OPACITY_UVS_ARGUMENT
#endif
#if HAS_TEXTURES
#define OPACITY_TEXTURE_ARGUMENTS , textures, texels
#else
#define OPACITY_TEXTURE_ARGUMENTS
#endif
#define OPACITY_VIEW                                                                                            \
    {parameters->sequence, opacities, primitive_shapes, shapes, parameters->triangle_count OPACITY_UVS_ARGUMENT     \
         OPACITY_TEXTURE_ARGUMENTS}

// Opacity of shapes at texture coordinates, in [0, 1]. `alpha` scales it before the cutoff.
INLINE Float opacity_at(OpacityView o, UInt shape, Float u, Float v, Float alpha) {
    Float opacity = GATHER_FIELD(o.opacities, Opacity, shape, value.value);
#if HAS_TEXTURES
    UInt texture = GATHER_UINT_FIELD(o.opacities, Opacity, shape, value.texture);
    Int textured = texture != (UInt)WAVELOBE_NONE;
    if (any_lane(textured)) {
        TextureBuffers b = {o.textures, o.texels};
        Float found = texture_float(b, SELECT(textured, texture, (UInt)0u), u, v);
        opacity = SELECT(textured, found * GATHER_FIELD(o.opacities, Opacity, shape, scale), opacity);
    }
#endif
    opacity *= alpha;
    Float cutoff = GATHER_FIELD(o.opacities, Opacity, shape, cutoff);
    Float cut = SELECT(opacity >= cutoff, ONE, ZERO);
    return SELECT(cutoff >= 0.0f, cut, LESSER(GREATER(opacity, ZERO), ONE));
}

// A number of the ray's own, from the path it belongs to and its direction.
INLINE UInt ray_key(OpacityView o, Block block, UInt path, Vec3 direction) {
    SampleId sample = path_sample_id(block, path, o.sequence);
    UInt h = mix_bits(sample.square_hash + sample.reversed_index);
    h = mix_bits(h + as_UInt(direction.x));
    h = mix_bits(h + as_UInt(direction.y));
    return mix_bits(h + as_UInt(direction.z));
}

INLINE Int passes(UInt key, UInt event, Float opacity) {
    return !(unit_float(mix_bits(key ^ mix_bits(event + (UInt)0x9e3779b9u))) < opacity);
}

// Lanes whose ray passes the triangle it hits at barycentric weights wb and wc of its second and third vertex.
INLINE Int passes_triangle(OpacityView o, UInt key, UInt primitive, Float wb, Float wc) {
    UInt shape = gather_uint(o.primitive_shapes, primitive);
    Float u = wb, v = wc, alpha = ONE;
#if HAS_UVS
    UInt first_uv = GATHER_UINT_FIELD(o.opacities, Opacity, shape, first_uv);
    UInt triangle = primitive - GATHER_UINT_FIELD(o.shapes, Shape, shape, first_primitive);
    triangle_uvs(o.uvs, first_uv, triangle, 1.0f - wb - wc, wb, wc, &u, &v);
#endif
#if HAS_VERTEX_OPACITY
    UInt first_alpha = GATHER_UINT_FIELD(o.opacities, Opacity, shape, first_alpha);
    Int varies = first_alpha != (UInt)WAVELOBE_NONE;
    if (any_lane(varies)) {
        UInt at = SELECT(varies, first_alpha + triangle * 3u, (UInt)0u);
        Float found = madd(gather(o.uvs, at), 1.0f - wb - wc, madd(gather(o.uvs + 1, at), wb, gather(o.uvs + 2, at) * wc));
        alpha = SELECT(varies, found, ONE);
    }
#endif
    return passes(key, primitive, opacity_at(o, shape, u, v, alpha));
}

#endif
