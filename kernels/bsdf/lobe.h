// The contract of a lobe: what every bsdf/<name>.h provides.
//
// Directions are unit, in the local shading frame (normal +z), both pointing away from the surface: `wi`
// towards where the path came from, `wo` the other side. One-sided lobes are seen from +z only: with
// wi.z <= 0 or wo.z <= 0 they are zero. (Two-sided surfaces are turned before lobes see them.)
// Radiance flows against the path: refraction scales by the squared ratio of indices.
//
//   typedef struct { ... } <Name>Lobe;                    parameters of LANES surface points
//   <Name>Lobe <name>_load(MaterialInput in)              fetches them
//   Float <name>_weight(<Name>Lobe l, Vec3 wi)            its relative chance in lobe selection, >= 0
//
// Glossy and diffuse lobes (evaluated, light-sampled):
//   LobeValue <name>_eval(<Name>Lobe l, Vec3 wi, Vec3 wo)       f |cos wo| and pdf, finite everywhere
//   Vec3 <name>_sample(<Name>Lobe l, Vec3 wi, Float u1, Float u2, Float u3)
//         a direction whose density is the pdf of eval; u3 chooses reflection or refraction.
//         A failed sample is the zero vector (its eval is zero).
//
// Delta lobes (followed explicitly, never evaluated, never light-sampled):
//   DeltaSample <name>_sample(<Name>Lobe l, Vec3 wi, Float u)
#ifndef WAVELOBE_BSDF_LOBE_H
#define WAVELOBE_BSDF_LOBE_H

// Whether some coats have normals of their own.
#ifndef HAS_COAT_NORMALS
#define HAS_COAT_NORMALS 0
#endif

#include "core/math.h"
#include "core/vector.h"
#include "shared/materials.h"

// Where lobe parameters come from: the material record of each lane, and texture coordinates.
typedef struct {
    UInt material;
    Float u, v;
#if HAS_SECOND_UVS
    Float second_u, second_v;
#endif
#if HAS_VERTEX_COLORS
    Rgb color; // of the vertices, white where there is none
#endif
    global const struct Material *materials;
    global const struct Texture *textures;
    global const float *texels;
#if HAS_COAT_NORMALS
    Frame unmapped; // the surface's frame before normal maps, on the side that is seen, in the frame of the lobes
#endif
} MaterialInput;

typedef struct {
    Rgb f_cos; // BSDF times |cos wo|, 1 / sr
    Float pdf; // solid angle density of sampling wo
} LobeValue;

typedef struct {
    Vec3 wo;
    Rgb weight; // BSDF |cos wo| over the probability of this choice: throughput is multiplied by it
    Float eta;  // relative index crossed: 1 for reflection, otherwise index behind wo over index before
} DeltaSample;

INLINE LobeValue lobe_value(Rgb f_cos, Float pdf) {
    LobeValue v = {f_cos, pdf};
    return v;
}

// Zero in the lanes outside the mask.
INLINE LobeValue lobe_value_where(Int mask, Rgb f_cos, Float pdf) {
    return lobe_value(select3(mask, f_cos, vec3_all(ZERO)), SELECT(mask, pdf, ZERO));
}

INLINE Float material_word(MaterialInput in, uint offset) {
    return gather((global const float *)in.materials + offset, in.material * RECORD_WORDS(Material));
}

INLINE Float constant_float(MaterialInput in, uint offset) { return material_word(in, offset); }

INLINE Rgb constant_rgb(MaterialInput in, uint offset) {
    return vec3(material_word(in, offset), material_word(in, offset + 1u), material_word(in, offset + 2u));
}

// load_rgb(in, diffuse) and load_float(in, alpha_u): a parameter of each lane, textured or not. The scaled forms are products of
// the constant and the texture, where load_rgb takes the texture in its place. Those of a record read another kind of record than
// Material, which the lanes of `there` have.
#if HAS_TEXTURES
#include "bsdf/texture.h"
#else
#define load_rgb(in, field) constant_rgb(in, WORD_OFFSET(Material, field))
#define load_float(in, field) constant_float(in, WORD_OFFSET(Material, field))
#define load_scaled_rgb(in, field) load_rgb(in, field)
#define load_scaled_float(in, field) load_float(in, field)
#define load_record_rgb(in, there, type, field) constant_rgb(in, WORD_OFFSET(type, field))
#define load_record_float(in, there, type, field) constant_float(in, WORD_OFFSET(type, field))
#define load_scaled_record_rgb(in, there, type, field) load_record_rgb(in, there, type, field)
#define load_scaled_record_float(in, there, type, field) load_record_float(in, there, type, field)
#endif

#define load_flags(in) as_UInt(material_word(in, WORD_OFFSET(Material, flags)))
#define load_constant(in, field) material_word(in, WORD_OFFSET(Material, field))

// The parameters of a material's extension, a struct of shared/materials.h.
INLINE MaterialInput extension_of(MaterialInput in) {
    in.material = as_UInt(load_constant(in, extension));
    return in;
}

#endif
