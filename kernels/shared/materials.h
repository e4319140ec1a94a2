// A material as the kernels see it: which lobes it has, and their parameters.
#ifndef WAVELOBE_SHARED_MATERIALS_H
#define WAVELOBE_SHARED_MATERIALS_H

#include "shared/types.h"

// Classes of lobes, and with them queues. A material's delta lobes are followed explicitly; its glossy and
// diffuse ones share next-event estimation and one mixture density.
#define LOBE_CLASS_DELTA 0u
#define LOBE_CLASS_GLOSSY 1u
#define LOBE_CLASS_DIFFUSE 2u

#define MATERIAL_TRANSMISSIVE 1u // light passes through
#define MATERIAL_BECKMANN 2u     // microfacets follow Beckmann, otherwise GGX
#define MATERIAL_NONLINEAR 4u    // plastic: colour shifts of internal scattering
// Kinds of materials that hold others (struct Nesting); a surface goes through them to one with lobes.
#define MATERIAL_NORMAL_MAP 8u
#define MATERIAL_BUMP_MAP 16u
#define MATERIAL_SIDES 32u       // another on each side
#define MATERIAL_BLEND 64u
#define MATERIAL_NESTS (MATERIAL_NORMAL_MAP | MATERIAL_BUMP_MAP | MATERIAL_SIDES | MATERIAL_BLEND)
#define MATERIAL_KEEPS_FRAME (MATERIAL_TRANSMISSIVE | MATERIAL_NESTS) // is not turned over when seen from behind
#define MATERIAL_FLIPS_NORMALS 128u    // maps: normals that face away from the viewer are mirrored
#define MATERIAL_WARD_CLASSIC 512u     // Ward's normalization: by the root of both cosines
#define MATERIAL_WARD_DUER 1024u       // ... by both cosines; otherwise that of bounded albedo
#define MATERIAL_SHADES_TERMINATOR 256u // maps: softens the edge where the mapped normal sees light and the surface does not
#define MATERIAL_THIN 2048u            // transmissive: the media on both sides are the same

// A parameter: a constant, scaled by nothing, or a texture (index) that replaces it.
struct TexturedRgb {
    struct Packed3 value;
    Uint32 texture; // WAVELOBE_NONE: constant
};

struct TexturedFloat {
    float value;
    Uint32 texture;
};

// How much of a shape is there: rays pass it with probability 1 - opacity. One record a shape, in scenes with such shapes.
struct Opacity {
    struct TexturedFloat value;
    float scale;  // of a texture's value
    float cutoff; // at least 0: all there from this value on, and not at all below it; negative: none
    Uint32 first_uv;    // offset into `uvs` of the coordinates that its texture uses; WAVELOBE_NONE: barycentric ones
    Uint32 first_alpha; // offset into `uvs` of three factors a triangle; WAVELOBE_NONE: one
};
WAVELOBE_CHECK_SIZE(Opacity, 24);

struct Material {
    Uint32 lobes; // bit LOBE_x of bsdf/lobes.def for each lobe it has
    Uint32 flags;
    struct TexturedRgb diffuse;      // Lambert, Phong's and plastic's base
    struct TexturedRgb specular;     // scale of every reflecting specular or glossy lobe
    struct TexturedRgb transmission; // scale of refraction
    struct Packed3 eta;              // conductor: index of refraction; dielectric: eta.x, inside over outside
    struct Packed3 k;                // conductor: extinction
    struct TexturedFloat alpha_u;    // microfacet roughness
    struct TexturedFloat alpha_v;
    struct TexturedFloat exponent;   // Phong
    struct TexturedFloat metallic;   // glTF
    float diffuse_fresnel_internal;  // plastic: mean Fresnel reflectance from inside, cosine weighted
    float specular_weight;           // plastic: share of the specular lobe in lobe selection; glTF: reflectance at grazing incidence
    Uint32 extension;                // record from which on the parameters lie that few materials have
};
WAVELOBE_CHECK_SIZE(Material, 124);

// A material that holds others: a record of this takes the place of Material in the array.
struct Nesting {
    Uint32 lobes; // of all that it holds
    Uint32 flags;
    Uint32 inner[2]; // materials, WAVELOBE_NONE: black; of sides front and back; maps have the first alone
    struct TexturedFloat weight; // blend: share of the second
    struct TexturedRgb normal;   // normal map: the normal in the tangent frame as (n + 1) / 2
    float scale;                 // of a normal's x and y; of a bump map's heights
    Uint32 height;               // bump map: texture, WAVELOBE_NONE: flat
};
WAVELOBE_CHECK_SIZE(Nesting, 48);

// Extensions lie in the array of materials, in whole records; each lobe that has one says what is in it.

// Rough plastic: the share of light that its surface lets through from outside, at cosines in equal steps from 0 to 1.
#define ROUGH_TRANSMITTANCE_STEPS 64u
struct RoughTransmittance {
    float at[ROUGH_TRANSMITTANCE_STEPS];
};
WAVELOBE_CHECK_SIZE(RoughTransmittance, 256);

// glTF's layers: parameters are products of value and texture.
struct MetallicRoughnessLayers {
    struct TexturedFloat coat;           // share of the surface under a clear coat
    struct TexturedFloat coat_roughness; // square root of its microfacets' alpha
    struct TexturedFloat transmission;   // share of the base that lets light through
    struct TexturedFloat specular;       // reflectance of the dielectric at grazing incidence; scales that at normal incidence
    struct TexturedRgb specular_color;   // ... which is this, at most one
    struct TexturedRgb anisotropy;       // direction of its highlights in the tangent frame as (d + 1) / 2, and strength; not scaled
    struct TexturedRgb coat_normal;      // in the tangent frame before normal maps as (n + 1) / 2; not scaled
    struct TexturedRgb sheen_color;
    struct TexturedFloat sheen_roughness; // square root of its fibres' alpha
    Uint32 sheen_albedo;                  // how many records on SheenAlbedo lies, modulo 2^32; in scenes with sheen
};
WAVELOBE_CHECK_SIZE(MetallicRoughnessLayers, 108);

// The directional albedo of white sheen: rows of roughness from the least to 1, columns of the cosine's square root from 0 to 1.
#define SHEEN_ROUGHNESSES 16u
#define SHEEN_COSINES 32u
#define SHEEN_LEAST_ROUGHNESS 0.07f // smoother fibres are seen but for 5 degrees above the horizon
struct SheenAlbedo {
    float at[SHEEN_ROUGHNESSES * SHEEN_COSINES];
};
WAVELOBE_CHECK_SIZE(SheenAlbedo, 2048);

// Principled materials: what Material has no room for.
struct PrincipledParameters {
    struct TexturedFloat anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness;
    struct TexturedFloat clearcoat, clearcoat_gloss; // not of thin ones
    struct TexturedFloat diff_trans, eta;            // thin ones: 0 to 2; index of what they are made of
};
WAVELOBE_CHECK_SIZE(PrincipledParameters, 80);

struct Texture {
    Uint32 kind;         // TEXTURE_x
    Uint32 first_texel;  // bitmap: offset of its rgb texels, in floats
    Uint32 width, height;
    float to_uv[6];      // rows of (u, v, 1)
    struct Packed3 color0, color1; // checkerboard
};
WAVELOBE_CHECK_SIZE(Texture, 64);

#define TEXTURE_CHECKERBOARD 0u
#define TEXTURE_BITMAP 1u
#define TEXTURE_NEAREST 2u   // bit: nearest neighbour, otherwise bilinear
#define TEXTURE_WRAP_MIRROR 4u
#define TEXTURE_WRAP_CLAMP 8u
#define TEXTURE_OTHER_ROWS 16u // bit: rows wrap by their own bits, those above shifted
#define TEXTURE_ROW_SHIFT 3u
#define TEXTURE_SECOND_UVS 128u // bit: looked up by the second set of coordinates

#endif
