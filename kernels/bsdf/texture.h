// Texture look-ups, and material parameters that may be textured. Included by bsdf/lobe.h.
//
// Texture coordinates run over [0, 1] from the first row and column of texels to the last; texel centres lie at half
// steps. Texels are stored row by row, red, green, blue.
#ifndef WAVELOBE_BSDF_TEXTURE_H
#define WAVELOBE_BSDF_TEXTURE_H

#include "core/vector.h"
#include "shared/materials.h"

typedef struct {
    global const struct Texture *textures;
    global const float *texels;
} TextureBuffers;

#define texture_field(buffers, i, name) GATHER_FIELD((buffers).textures, Texture, i, name)
#define texture_word(buffers, i, offset) \
    gather((global const float *)(buffers).textures + (offset), (i) * RECORD_WORDS(Texture))

// The texel index that index i (an integer, any) stands for among n.
INLINE Float wrap_texel(Float i, Float n, UInt kind) {
    Float period = floor(i / n);
    Float remainder = madd(-n, period, i);
    Int odd = period != 2.0f * floor(0.5f * period);
    Int mirrored = ((kind & (UInt)TEXTURE_WRAP_MIRROR) != (UInt)0u) & odd;
    Int clamped = (kind & (UInt)TEXTURE_WRAP_CLAMP) != (UInt)0u;
    Float wrapped = SELECT(clamped, i, SELECT(mirrored, n - 1.0f - remainder, remainder));
    // Bounds indices too large for exact remainders, NaN, and textures without texels.
    return GREATER(LESSER(wrapped, n - 1.0f), ZERO);
}

// Offset of a texel's red, in floats.
INLINE UInt texel_offset(UInt first, Float width, Float column, Float row) {
    UInt index = as_UInt(convert_Int(row)) * as_UInt(convert_Int(width)) + as_UInt(convert_Int(column));
    return first + index * (UInt)3u;
}

typedef struct {
    Float u, v; // after the texture's own transform
} TextureCoordinates;

INLINE TextureCoordinates texture_coordinates(TextureBuffers b, UInt i, Float u, Float v) {
#define TO_UV(row, column) texture_word(b, i, WORD_OFFSET(Texture, to_uv) + (row) * 3u + (column))
    TextureCoordinates t;
    t.u = madd(TO_UV(0u, 0u), u, madd(TO_UV(0u, 1u), v, TO_UV(0u, 2u)));
    t.v = madd(TO_UV(1u, 0u), u, madd(TO_UV(1u, 1u), v, TO_UV(1u, 2u)));
#undef TO_UV
    return t;
}

// The four texels around a point and their weights; with the nearest-neighbour filter all weight is on the first.
typedef struct {
    UInt offset[4]; // of red: (0, 0), (1, 0), (0, 1), (1, 1) in steps of column and row
    Float u, v;     // share of the second column and row
    Int filtered;
} TexelQuad;

INLINE TexelQuad texel_quad(TextureBuffers b, UInt i, UInt kind, TextureCoordinates t) {
    TexelQuad q;
    UInt first = as_UInt(texture_field(b, i, first_texel));
    Float width = convert_Float(as_Int(texture_field(b, i, width)));
    Float height = convert_Float(as_Int(texture_field(b, i, height)));
    q.filtered = (kind & (UInt)TEXTURE_NEAREST) == (UInt)0u;
    Float half_texel = SELECT(q.filtered, (Float)-0.5f, ZERO);
    Float x = madd(t.u, width, half_texel);
    Float y = madd(t.v, height, half_texel);
    Float column = floor(x);
    Float row = floor(y);
    q.u = SELECT(q.filtered, x - column, ZERO);
    q.v = SELECT(q.filtered, y - row, ZERO);
    Float column0 = wrap_texel(column, width, kind);
    Float column1 = wrap_texel(column + 1.0f, width, kind);
    UInt row_kind = SELECT((kind & (UInt)TEXTURE_OTHER_ROWS) != (UInt)0u, kind >> TEXTURE_ROW_SHIFT, kind);
    Float row0 = wrap_texel(row, height, row_kind);
    Float row1 = wrap_texel(row + 1.0f, height, row_kind);
    q.offset[0] = texel_offset(first, width, column0, row0);
    q.offset[1] = texel_offset(first, width, column1, row0);
    q.offset[2] = texel_offset(first, width, column0, row1);
    q.offset[3] = texel_offset(first, width, column1, row1);
    return q;
}

INLINE Float filter_texels(TextureBuffers b, TexelQuad q, uint channel) {
    global const float *texels = b.texels + channel;
    Float value = gather(texels, q.offset[0]);
    if (any_lane(q.filtered)) {
        Float near = madd(1.0f - q.u, value, q.u * gather(texels, q.offset[1]));
        Float far = madd(1.0f - q.u, gather(texels, q.offset[2]), q.u * gather(texels, q.offset[3]));
        value = SELECT(q.filtered, madd(1.0f - q.v, near, q.v * far), value);
    }
    return value;
}

// Whether the point lies in the first colour of a checkerboard: two by two fields over [0, 1], repeating.
INLINE Int first_checker(TextureCoordinates t) {
    Int right = t.u - floor(t.u) > 0.5f;
    Int upper = t.v - floor(t.v) > 0.5f;
    return right == upper;
}

// A component of one of its colours, as an offset in the buffer of textures.
INLINE UInt checker_offset(UInt i, Int first) {
    return i * RECORD_WORDS(Texture) +
           SELECT(first, (UInt)WORD_OFFSET(Texture, color0), (UInt)WORD_OFFSET(Texture, color1));
}

INLINE Rgb texture_rgb(TextureBuffers b, UInt i, Float u, Float v) {
    UInt kind = as_UInt(texture_field(b, i, kind));
    TextureCoordinates t = texture_coordinates(b, i, u, v);
    Int bitmap = (kind & (UInt)TEXTURE_BITMAP) != (UInt)0u;
    Rgb value = vec3_all(ZERO);
    if (any_lane(bitmap)) {
        TexelQuad q = texel_quad(b, i, kind, t);
        value = vec3(filter_texels(b, q, 0u), filter_texels(b, q, 1u), filter_texels(b, q, 2u));
    }
    if (any_lane(!bitmap)) {
        global const float *words = (global const float *)b.textures;
        UInt offset = checker_offset(i, first_checker(t));
        Rgb checker = vec3(gather(words, offset), gather(words + 1, offset), gather(words + 2, offset));
        value = select3(bitmap, value, checker);
    }
    return value;
}

// A scalar: red. (Readers put into it what their format means by a texture's scalar.)
INLINE Float texture_float(TextureBuffers b, UInt i, Float u, Float v) {
    UInt kind = as_UInt(texture_field(b, i, kind));
    TextureCoordinates t = texture_coordinates(b, i, u, v);
    Int bitmap = (kind & (UInt)TEXTURE_BITMAP) != (UInt)0u;
    Float value = ZERO;
    if (any_lane(bitmap)) value = filter_texels(b, texel_quad(b, i, kind, t), 0u);
    if (any_lane(!bitmap)) {
        Float checker = gather((global const float *)b.textures, checker_offset(i, first_checker(t)));
        value = SELECT(bitmap, value, checker);
    }
    return value;
}

// Change of a scalar with (u, v): that of the filter between texel centres. None without a filter, nor on checkerboards.
INLINE void texture_gradient(TextureBuffers b, UInt i, Float u, Float v, Float *along_u, Float *along_v) {
    UInt kind = as_UInt(texture_field(b, i, kind));
    TexelQuad q = texel_quad(b, i, kind, texture_coordinates(b, i, u, v));
    Int smooth = ((kind & (UInt)TEXTURE_BITMAP) != (UInt)0u) & q.filtered;
    Float t00 = gather(b.texels, q.offset[0]), t10 = gather(b.texels, q.offset[1]);
    Float t01 = gather(b.texels, q.offset[2]), t11 = gather(b.texels, q.offset[3]);
    Float width = convert_Float(as_Int(texture_field(b, i, width)));
    Float height = convert_Float(as_Int(texture_field(b, i, height)));
    Float across = SELECT(smooth, madd(1.0f - q.v, t10 - t00, q.v * (t11 - t01)), ZERO); // a texel
    Float down = SELECT(smooth, madd(1.0f - q.u, t01 - t00, q.u * (t11 - t10)), ZERO);
#define TO_UV(row, column) texture_word(b, i, WORD_OFFSET(Texture, to_uv) + (row) * 3u + (column))
    // Width and height after the transform, as in Mitsuba 3: it matters where that turns a texture that is not square.
    *along_u = width * madd(TO_UV(0u, 0u), across, TO_UV(1u, 0u) * down);
    *along_v = height * madd(TO_UV(0u, 1u), across, TO_UV(1u, 1u) * down);
#undef TO_UV
}

#if HAS_SECOND_UVS
INLINE Int uses_second_uvs(TextureBuffers b, UInt i) {
    return (as_UInt(texture_field(b, i, kind)) & (UInt)TEXTURE_SECOND_UVS) != (UInt)0u;
}
#define CHOOSE_UVS(b, i, in)                                 \
    {                                                        \
        Int second = uses_second_uvs(b, i);                  \
        (in).u = SELECT(second, (in).second_u, (in).u);      \
        (in).v = SELECT(second, (in).second_v, (in).v);      \
    }
#else
#define CHOOSE_UVS(b, i, in)
#endif

// Lanes without a texture look up the first.
INLINE Rgb looked_up_rgb(MaterialInput in, UInt texture, Int textured) {
    TextureBuffers b = {in.textures, in.texels};
    UInt i = SELECT(textured, texture, (UInt)0u);
    CHOOSE_UVS(b, i, in)
    return texture_rgb(b, i, in.u, in.v);
}

INLINE Float looked_up_float(MaterialInput in, UInt texture, Int textured) {
    TextureBuffers b = {in.textures, in.texels};
    UInt i = SELECT(textured, texture, (UInt)0u);
    CHOOSE_UVS(b, i, in)
    return texture_float(b, i, in.u, in.v);
}

// Parameters, textured or not, in the lanes of `there`, whose record has them: what lies there of others names no texture.
// `offset` is that of the parameter in the record.
INLINE Rgb parameter_rgb(MaterialInput in, Int there, uint offset, int scaled) {
    Rgb value = constant_rgb(in, offset);
    UInt texture = as_UInt(material_word(in, offset + WORD_OFFSET(TexturedRgb, texture)));
    Int textured = there & (texture != (UInt)WAVELOBE_NONE);
    if (any_lane(textured)) {
        Rgb found = looked_up_rgb(in, texture, textured);
        value = select3(textured, scaled ? mul(value, found) : found, value);
    }
    return value;
}

INLINE Float parameter_float(MaterialInput in, Int there, uint offset, int scaled) {
    Float value = constant_float(in, offset);
    UInt texture = as_UInt(material_word(in, offset + WORD_OFFSET(TexturedFloat, texture)));
    Int textured = there & (texture != (UInt)WAVELOBE_NONE);
    if (any_lane(textured)) {
        Float found = looked_up_float(in, texture, textured);
        value = SELECT(textured, scaled ? value * found : found, value);
    }
    return value;
}

#define load_rgb(in, field) parameter_rgb(in, TRUE_MASK, WORD_OFFSET(Material, field), 0)
#define load_float(in, field) parameter_float(in, TRUE_MASK, WORD_OFFSET(Material, field), 0)
#define load_scaled_rgb(in, field) parameter_rgb(in, TRUE_MASK, WORD_OFFSET(Material, field), 1)
#define load_scaled_float(in, field) parameter_float(in, TRUE_MASK, WORD_OFFSET(Material, field), 1)
#define load_record_rgb(in, there, type, field) parameter_rgb(in, there, WORD_OFFSET(type, field), 0)
#define load_record_float(in, there, type, field) parameter_float(in, there, WORD_OFFSET(type, field), 0)
#define load_scaled_record_rgb(in, there, type, field) parameter_rgb(in, there, WORD_OFFSET(type, field), 1)
#define load_scaled_record_float(in, there, type, field) parameter_float(in, there, WORD_OFFSET(type, field), 1)

#endif
