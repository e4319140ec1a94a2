// Layers on and in glTF's metallic-roughness material: a clear coat over it (KHR_materials_clearcoat), a share of its base that
// lets light through instead of scattering it (KHR_materials_transmission, thin walls), stretched highlights
// (KHR_materials_anisotropy), and textures of its dielectric's reflectance (KHR_materials_specular). Khronos Group 2020-2023. Both
// lobes of such a material read them.
//
// Deviations, which make the material reciprocal where the coat has no normal of its own: the coat's Fresnel term is taken at the half vector, as that of the
// dielectric below it is, not at the normal.
#ifndef WAVELOBE_BSDF_LAYERED_PARAMETERS_H
#define WAVELOBE_BSDF_LAYERED_PARAMETERS_H

#include "bsdf/metallic_roughness.h"

// Whether some of the scene's materials have sheen.
#ifndef HAS_SHEEN
#define HAS_SHEEN 1
#endif
#if HAS_SHEEN
#include "bsdf/sheen.h"
#endif

// Whether some of the scene's materials have stretched highlights.
#ifndef HAS_ANISOTROPY
#define HAS_ANISOTROPY 1
#endif

typedef struct {
    MetallicRoughness material;
    Microfacets microfacets, coat_microfacets;
#if HAS_ANISOTROPY
    Float along_x, along_y; // unit: where the axis u of the microfacets points
#endif
#if HAS_COAT_NORMALS
    Frame coat_frame; // in the frame of the lobe
#endif
#if HAS_SHEEN
    Sheen sheen;
#endif
    Float coat;         // share of the surface under the coat
    Float transmission; // share of the base that lets light through
    Int two_sided;      // light passes, and both sides are alike
} Layered;

INLINE Microfacets rough_microfacets(Float roughness) {
    Microfacets d;
    d.alpha_u = d.alpha_v = GREATER(roughness * roughness, (Float)MIN_ALPHA);
    d.beckmann = !TRUE_MASK;
    return d;
}

INLINE Float unit_share(Float x) { return LESSER(GREATER(x, ZERO), ONE); }

#if HAS_ANISOTROPY
INLINE void stretch_microfacets(Layered *l, Rgb a) {
    Float x = madd((Float)2.0f, a.x, (Float)-1.0f), y = madd((Float)2.0f, a.y, (Float)-1.0f);
    Float square = madd(x, x, y * y);
    Int pointed = square > 0.0f;
    Float inverse = 1.0f / sqrt(SELECT(pointed, square, ONE));
    l->along_x = SELECT(pointed, x * inverse, ONE);
    l->along_y = SELECT(pointed, y * inverse, ZERO);
    Float strength = unit_share(a.z);
    l->microfacets.alpha_u = madd(strength * strength, 1.0f - l->microfacets.alpha_v, l->microfacets.alpha_v);
}

// To the axes of the microfacets, and back.
INLINE Vec3 to_microfacets(Layered l, Vec3 v) { return vec3(madd(l.along_x, v.x, l.along_y * v.y), madd(l.along_x, v.y, -l.along_y * v.x), v.z); }
INLINE Vec3 from_microfacets(Layered l, Vec3 v) { return vec3(madd(l.along_x, v.x, -l.along_y * v.y), madd(l.along_x, v.y, l.along_y * v.x), v.z); }
#else
#define to_microfacets(l, v) (v)
#define from_microfacets(l, v) (v)
#endif

#if HAS_COAT_NORMALS
// About a normal in the tangent frame before normal maps, stored as (n + 1) / 2; one without a direction is that frame's.
INLINE Frame frame_of_coat(Frame unmapped, Rgb normal) {
    Vec3 n = vec3(madd(normal.x, (Float)2.0f, (Float)-1.0f), madd(normal.y, (Float)2.0f, (Float)-1.0f), madd(normal.z, (Float)2.0f, (Float)-1.0f));
    Float square = length_squared(n);
    Int pointed = (square > 0.0f) & (square < INFINITY);
    n = to_world(unmapped, select3(pointed, n, vec3(ZERO, ZERO, ONE)));
    return frame_of_normal(normalize3(n));
}

INLINE Vec3 to_coat(Layered l, Vec3 v) { return to_local(l.coat_frame, v); }
INLINE Vec3 from_coat(Layered l, Vec3 v) { return to_world(l.coat_frame, v); }
#else
#define to_coat(l, v) (v)
#define from_coat(l, v) (v)
#endif

INLINE Layered load_layered(MaterialInput in) {
    Layered l;
    l.material = load_metallic_roughness(in);
    l.microfacets = rough_microfacets(load_scaled_float(in, alpha_u));
    l.two_sided = (load_flags(in) & (UInt)MATERIAL_TRANSMISSIVE) != (UInt)0u;
#if HAS_TEXTURES || HAS_SHEEN
    Int there = (as_UInt(load_constant(in, lobes)) & (UInt)(1u << LOBE_LAYERED_METALLIC_ROUGHNESS)) != (UInt)0u;
#endif
    MaterialInput layers = extension_of(in);
#if HAS_ANISOTROPY
    stretch_microfacets(&l, load_record_rgb(layers, there, MetallicRoughnessLayers, anisotropy));
#endif
#if HAS_COAT_NORMALS
    l.coat_frame = frame_of_coat(in.unmapped, load_record_rgb(layers, there, MetallicRoughnessLayers, coat_normal));
#endif
#if HAS_SHEEN
    Rgb sheen = load_scaled_record_rgb(layers, there, MetallicRoughnessLayers, sheen_color);
    l.sheen.color = vec3(unit_share(sheen.x), unit_share(sheen.y), unit_share(sheen.z));
    // Where there are no layers, so that the table is looked up within the records: its first row.
    Float roughness = load_scaled_record_float(layers, there, MetallicRoughnessLayers, sheen_roughness);
    l.sheen.roughness = SELECT(there, LESSER(GREATER(roughness, (Float)SHEEN_LEAST_ROUGHNESS), ONE), (Float)SHEEN_LEAST_ROUGHNESS);
    l.sheen.words = (global const float *)layers.materials;
    UInt record = layers.material + as_UInt(material_word(layers, WORD_OFFSET(MetallicRoughnessLayers, sheen_albedo)));
    l.sheen.table = SELECT(there, record * RECORD_WORDS(Material), (UInt)0u);
#endif
    l.coat = unit_share(load_scaled_record_float(layers, there, MetallicRoughnessLayers, coat));
    l.coat_microfacets = rough_microfacets(load_scaled_record_float(layers, there, MetallicRoughnessLayers, coat_roughness));
    l.transmission = unit_share(load_scaled_record_float(layers, there, MetallicRoughnessLayers, transmission));
    Float specular = unit_share(load_scaled_record_float(layers, there, MetallicRoughnessLayers, specular));
    Rgb f0 = load_scaled_record_rgb(layers, there, MetallicRoughnessLayers, specular_color);
    l.material.f0 = vec3(LESSER(f0.x, ONE) * specular, LESSER(f0.y, ONE) * specular, LESSER(f0.z, ONE) * specular);
    l.material.f90 = specular;
    return l;
}

// What the coat, of index 1.5, reflects where its microfacets meet the light at that cosine.
INLINE Float coat_reflectance(Layered l, Float cosine) { return l.coat * madd((Float)0.96f, schlick_weight(cosine), (Float)0.04f); }

// What the coat lets through: 1 - coat_reflectance.
INLINE Float coat_transmittance(Layered l, Float cosine) {
    return madd(0.96f * l.coat, schlick_rest(LESSER(fabs(cosine), ONE)), 1.0f - l.coat);
}

// Share of the light that reaches the base of the dielectric, by the cosine on the half vector; towards grazing incidence
// without differences of nearly equal numbers.
INLINE Float base_share(Layered l, Float cosine) {
    Float c = LESSER(fabs(cosine), ONE);
    Float weight = schlick_weight(c);
    Float passed = madd(1.0f - max_component(l.material.f0), schlick_rest(c), (1.0f - l.material.f90) * weight);
    return coat_transmittance(l, cosine) * (1.0f - l.material.metallic) * passed;
}

// Seen from above: a two-sided surface is turned over where `wi` is below it.
INLINE Int turned_over(Layered l, Vec3 wi) { return l.two_sided & (wi.z < 0.0f); }
INLINE Vec3 turn_where(Int turned, Vec3 v) { return vec3(v.x, v.y, SELECT(turned, -v.z, v.z)); }

#endif
