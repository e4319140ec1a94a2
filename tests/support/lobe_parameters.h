// Parameter sets for the generic tests of lobes. Every lobe of bsdf/lobes.def needs some.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "support/lobe_reference.h"

namespace wavelobe::test {

struct LobeParameters {
    std::string name;
    Material material;
    double width = 1.0;  // angular scale of the lobe in radians: narrow ones are binned about their axes
    bool reciprocal = true;  // the thin principled material is not: a microfacet transmits behind itself alone; nor are mapped normals
    double rounding = 32;    // of values, in units of the last place: some thirty operations in a row
};

// A white material: all of it that a lobe does not set is neutral.
inline Material white_material() {
    Material m{};
    m.diffuse = {{1.0F, 1.0F, 1.0F}, WAVELOBE_NONE};
    m.specular = {{1.0F, 1.0F, 1.0F}, WAVELOBE_NONE};
    m.transmission = {{1.0F, 1.0F, 1.0F}, WAVELOBE_NONE};
    m.eta = {0.0F, 0.0F, 0.0F};
    m.k = {1.0F, 1.0F, 1.0F};
    m.alpha_u = {0.1F, WAVELOBE_NONE};
    m.alpha_v = {0.1F, WAVELOBE_NONE};
    m.exponent = {30.0F, WAVELOBE_NONE};
    m.metallic = {0.0F, WAVELOBE_NONE};
    return m;
}

inline Material coloured_material() {
    Material m = white_material();
    m.diffuse.value = {0.8F, 0.5F, 0.1F};
    m.specular.value = {0.9F, 0.4F, 0.2F};
    m.transmission.value = {0.3F, 0.7F, 0.6F};
    return m;
}

inline Material conductor(Material m, Packed3 eta, Packed3 k) {
    m.eta = eta;
    m.k = k;
    return m;
}

inline Material dielectric(Material m, float eta, Uint32 flags = MATERIAL_TRANSMISSIVE) {
    m.eta = {eta, eta, eta};
    m.flags |= flags;
    return m;
}

inline Material rough(Material m, float alpha_u, float alpha_v, Uint32 flags = 0) {
    m.alpha_u.value = alpha_u;
    m.alpha_v.value = alpha_v;
    m.flags |= flags;
    return m;
}

inline Material phong(Material m, float exponent) {
    m.exponent.value = exponent;
    return m;
}

inline Material metallic_roughness(Material m, float metallic, float roughness, float f0 = 0.04F, float f90 = 1.0F) {
    m.metallic.value = metallic;
    m.alpha_u.value = roughness;
    m.specular.value = {f0, f0, f0};
    m.specular_weight = f90;
    return m;
}

// Lobes read layers where a material has this one.
inline Uint32 layered_bit() {
    enum {
#define LOBE(name, NAME, class) LOBE_##NAME,
#include "bsdf/lobes.def"
#undef LOBE
    };
    return 1U << LOBE_LAYERED_METALLIC_ROUGHNESS;
}

// With a set of layer_sets(); those that let light through have two sides alike.
inline Material layered(Material m, std::size_t set) {
    m.extension = layers_record(set);
    m.lobes = layered_bit();
    m.eta = {1.0F, 1.0F, 1.0F};
    if (layer_sets()[set].transmission.value > 0.0F) m.flags |= MATERIAL_TRANSMISSIVE | MATERIAL_THIN;
    return m;
}

// With the parameters of one of principled_extensions().
inline Material principled(Material m, Uint32 extension, float metallic, float roughness, float eta, Uint32 flags = 0) {
    m = dielectric(m, eta, flags);
    m.metallic.value = metallic;
    m.alpha_u.value = roughness;
    m.extension = first_principled_extension + extension;
    return m;
}

// Cosine-weighted mean Fresnel reflectance from inside, by the midpoint rule over squared cosines.
inline float internal_reflectance(float eta) {
    constexpr int steps = 10000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += reference_fresnel_dielectric(-std::sqrt((i + 0.5) / steps), eta);
    return static_cast<float>(sum / steps);
}

inline Material plastic(Material m, float eta, Uint32 flags = 0) {
    m = dielectric(m, eta, flags);
    m.diffuse_fresnel_internal = internal_reflectance(eta);
    m.specular_weight = 0.6F;
    return m;
}

// By the name of the lobe.
inline const std::map<std::string, std::vector<LobeParameters>>& lobe_parameters() {
    const Packed3 gold_eta{0.143F, 0.375F, 1.442F};
    const Packed3 gold_k{3.983F, 2.386F, 1.603F};
    const Material white = white_material();
    const Material coloured = coloured_material();
    Material faint = coloured;
    faint.specular.value = {1e-3F, 5e-4F, 2e-4F};
    const Material gold = conductor(coloured, gold_eta, gold_k);
    static const std::map<std::string, std::vector<LobeParameters>> sets{
        {"mirror", {{"ideal", white}, {"gold", gold}}},
        {"dielectric",
         {{"glass", dielectric(white, 1.5F)},
          {"bubble", dielectric(coloured, 1.0F / 1.5F)},
          {"faint", dielectric(white, 1.0001F)},
          {"matched", dielectric(white, 1.0F)},
          {"diamond", dielectric(coloured, 2.4F)}}},
        {"thin_dielectric",
         {{"glass", dielectric(white, 1.5F)},
          {"bubble", dielectric(coloured, 1.0F / 1.5F)},
          {"matched", dielectric(white, 1.0F)}}},
        {"plastic_coat",
         {{"white", plastic(white, 1.5F)}, {"coloured", plastic(coloured, 1.3F)}}},
        {"rough_conductor",
         {{"ggx", rough(white, 0.3F, 0.3F)},
          {"ggx_stretched", rough(gold, 0.05F, 0.6F)},
          {"ggx_roughest", rough(white, 1.0F, 1.0F)},
          {"ggx_smoothest", rough(white, 1e-4F, 1e-4F), 1e-4},
          {"beckmann", rough(white, 0.3F, 0.3F, MATERIAL_BECKMANN)},
          {"beckmann_stretched", rough(gold, 0.6F, 0.05F, MATERIAL_BECKMANN)},
          {"beckmann_roughest", rough(white, 1.0F, 1.0F, MATERIAL_BECKMANN)},
          {"beckmann_smoothest", rough(white, 1e-4F, 1e-4F, MATERIAL_BECKMANN), 1e-4}}},
        {"rough_dielectric",
         {{"ggx_glass", rough(dielectric(white, 1.5F), 0.3F, 0.3F)},
          {"ggx_bubble", rough(dielectric(coloured, 1.0F / 1.5F), 0.2F, 0.7F)},
          {"ggx_roughest_diamond", rough(dielectric(white, 2.4F), 1.0F, 1.0F)},
          {"ggx_smoothest", rough(dielectric(white, 1.5F), 1e-4F, 1e-4F), 1e-4},
          {"beckmann_glass", rough(dielectric(white, 1.5F), 0.3F, 0.3F, MATERIAL_BECKMANN)},
          {"beckmann_bubble", rough(dielectric(coloured, 1.0F / 1.5F), 0.7F, 0.2F, MATERIAL_BECKMANN)},
          {"beckmann_smoothest", rough(dielectric(white, 1.5F), 1e-4F, 1e-4F, MATERIAL_BECKMANN), 1e-4}}},
        {"rough_plastic_coat",
         {{"ggx", rough(plastic(white, 1.5F), 0.3F, 0.3F)},
          {"ggx_smoothest", rough(plastic(white, 1.5F), 1e-4F, 1e-4F), 1e-4},
          {"beckmann", rough(plastic(coloured, 1.3F), 0.2F, 0.2F, MATERIAL_BECKMANN)},
          {"beckmann_roughest", rough(plastic(white, 2.4F), 1.0F, 1.0F, MATERIAL_BECKMANN)}}},
        {"phong",
         {{"broadest", phong(white, 0.0F)},
          {"broad", phong(coloured, 1.0F)},
          {"glossy", phong(white, 30.0F)},
          {"narrow", phong(coloured, 1000.0F)},
          {"narrowest", phong(white, 1e6F), 1e-3}}},
        {"metallic_roughness",
         {{"plastic", metallic_roughness(coloured, 0.0F, 0.5F)},
          {"metal", metallic_roughness(coloured, 1.0F, 0.4F)},
          {"between", metallic_roughness(coloured, 0.3F, 0.7F, 0.02F, 0.5F)},
          {"roughest", metallic_roughness(white, 1.0F, 1.0F)},
          {"smoothest", metallic_roughness(white, 1.0F, 0.0F), 1e-4}}},
        {"layered_metallic_roughness",
         {{"coated", layered(metallic_roughness(coloured, 0.0F, 0.5F), 0)},
          {"coated_metal", layered(metallic_roughness(coloured, 1.0F, 0.8F), 0)},
          {"everything", layered(metallic_roughness(coloured, 0.3F, 0.5F), 1)},
          {"pane", layered(metallic_roughness(white, 0.0F, 0.4F), 2)},
          {"brushed", layered(metallic_roughness(coloured, 1.0F, 0.3F), 4)},
          {"brushed_pane", layered(metallic_roughness(coloured, 0.2F, 0.5F), 5)},
          {"below_sheen", layered(metallic_roughness(coloured, 0.4F, 0.5F), 7)},
          {"pane_below_sheen", layered(metallic_roughness(coloured, 0.2F, 0.5F), 8)},
          {"tilted_coat", layered(metallic_roughness(coloured, 0.0F, 0.5F), 6), 1.0, false},
          {"smoothest_coat", layered(metallic_roughness(white, 0.0F, 0.0F), 3), 1e-4}}},
        {"layered_metallic_roughness_base",
         {{"coated", layered(metallic_roughness(white, 0.0F, 0.5F), 0)}, {"everything", layered(metallic_roughness(coloured, 0.3F, 0.5F), 1)}}},
        {"sheen_metallic_roughness_base",
         // Masking is the exponential of up to 20, whose own rounding is 16 of the result's; it is a sum of such.
         {{"white", layered(metallic_roughness(white, 0.0F, 0.5F), 7), 1.0, true, 100},
          {"metal", layered(metallic_roughness(white, 1.0F, 0.5F), 7), 1.0, true, 100},
          {"rich", layered(metallic_roughness(coloured, 0.3F, 0.5F), 8), 1.0, true, 100},
          {"smooth", layered(metallic_roughness(white, 0.0F, 0.5F), 9), 1.0, true, 100}}},
        // But for the balanced one, Ward's highlights are not bounded: faint ones gain nothing.
        {"ward",
         {{"balanced", rough(coloured, 0.3F, 0.3F)},
          {"stretched", rough(coloured, 0.2F, 0.5F)},
          {"classic", rough(faint, 0.2F, 0.4F, MATERIAL_WARD_CLASSIC)},
          {"duer", rough(faint, 0.3F, 0.3F, MATERIAL_WARD_DUER)}}},
        {"principled",
         {{"plain", principled(coloured, 0, 0.0F, 0.5F, 1.5F)},
          {"metal", principled(coloured, 0, 1.0F, 0.6F, 1.5F)},
          {"rich", principled(coloured, 1, 0.4F, 0.5F, 1.4F)},
          {"glass", principled(white, 2, 0.1F, 0.6F, 1.5F, MATERIAL_TRANSMISSIVE)},
          {"bubble", principled(coloured, 2, 0.0F, 0.7F, 1.0F / 1.5F, MATERIAL_TRANSMISSIVE)}}},
        {"principled_thin",
         {{"glass", principled(coloured, 2, 0.0F, 0.6F, 1.0F, MATERIAL_TRANSMISSIVE), 1.0, false}}},
        {"principled_base",
         {{"plain", principled(coloured, 0, 0.0F, 0.3F, 1.5F)}, {"rich", principled(coloured, 1, 0.3F, 0.8F, 1.5F)}}},
        {"principled_thin_base",
         {{"plain", principled(coloured, 0, 0.0F, 0.5F, 1.0F, MATERIAL_TRANSMISSIVE)},
          {"leaf", principled(coloured, 1, 0.0F, 0.5F, 1.0F, MATERIAL_TRANSMISSIVE)},
          {"paper", principled(coloured, 2, 0.0F, 0.7F, 1.0F, MATERIAL_TRANSMISSIVE)}}},
        {"lambert", {{"white", white}, {"coloured", coloured}}},
        {"metallic_roughness_base",
         {{"white", metallic_roughness(white, 0.0F, 0.5F)}, {"coloured", metallic_roughness(coloured, 0.4F, 0.5F, 0.2F)}}},
        {"plastic_base",
         {{"white", plastic(white, 1.5F)},
          {"coloured", plastic(coloured, 1.3F)},
          {"saturated", plastic(coloured, 1.5F, MATERIAL_NONLINEAR)}}},
        {"rough_plastic_base",
         {{"white", plastic(white, 1.5F)},
          {"coloured", plastic(coloured, 1.3F)},
          {"saturated", plastic(coloured, 1.5F, MATERIAL_NONLINEAR)}}},
    };
    return sets;
}

}  // namespace wavelobe::test
