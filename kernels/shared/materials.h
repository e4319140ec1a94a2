// A material as the kernels see it: which lobes it has, and their parameters.
#ifndef WAVELOBE_SHARED_MATERIALS_H
#define WAVELOBE_SHARED_MATERIALS_H

#include "shared/types.h"

// Classes of lobes, and with them queues. A material's delta lobes are followed explicitly; its glossy and
// diffuse ones share next-event estimation and one mixture density.
#define LOBE_CLASS_DELTA 0u
#define LOBE_CLASS_GLOSSY 1u
#define LOBE_CLASS_DIFFUSE 2u

#define MATERIAL_TRANSMISSIVE 1u // keeps its frame when seen from behind
#define MATERIAL_BECKMANN 2u     // microfacets follow Beckmann, otherwise GGX
#define MATERIAL_NONLINEAR 4u    // plastic: colour shifts of internal scattering

// A parameter: a constant, scaled by nothing, or a texture (index) that replaces it.
struct TexturedRgb {
    struct Packed3 value;
    Uint32 texture; // WAVELOBE_NONE: constant
};

struct TexturedFloat {
    float value;
    Uint32 texture;
};

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
    float specular_weight;           // share of the specular lobe in lobe selection, from mean reflectances
};
WAVELOBE_CHECK_SIZE(Material, 120);

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

#endif
