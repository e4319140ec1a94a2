// Extensions of materials in tests of lobes: `extension` of a material is its record in lobe_extensions().
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "shared/materials.h"
#include "tables/sheen_albedo.h"

namespace wavelobe::test {

template <class Extension>
std::uint32_t append_extension(std::vector<::Material>& records, const Extension& extension) {
    const std::size_t first = records.size();
    records.resize(first + (sizeof(Extension) + sizeof(::Material) - 1) / sizeof(::Material));
    std::memcpy(static_cast<void*>(&records[first]), &extension, sizeof(Extension));
    return static_cast<std::uint32_t>(first);
}

// Transmittance that falls towards grazing incidence as Fresnel's does.
inline RoughTransmittance falling_transmittance() {
    RoughTransmittance table{};
    for (Uint32 i = 0; i < ROUGH_TRANSMITTANCE_STEPS; ++i) {
        const double cosine = static_cast<double>(i) / (ROUGH_TRANSMITTANCE_STEPS - 1);
        table.at[i] = static_cast<float>(0.96 * (1.0 - std::pow(1.0 - cosine, 5.0)));
    }
    return table;
}

// Of principled materials: opaque and plain, opaque with all there is, partly refracting, thin. Their records follow that of
// the transmittance.
inline std::vector<PrincipledParameters> principled_extensions() {
    const auto value = [](float v) { return TexturedFloat{v, WAVELOBE_NONE}; };
    const auto set = [&](float anisotropic, float spec_trans, float spec_tint, float sheen, float sheen_tint, float flatness,
                         float clearcoat, float gloss, float diff_trans, float eta) {
        return PrincipledParameters{value(anisotropic), value(spec_trans), value(spec_tint), value(sheen), value(sheen_tint),
                                    value(flatness), value(clearcoat), value(gloss), value(diff_trans), value(eta)};
    };
    return {set(0, 0, 0, 0, 0, 0, 0, 0, 0, 1.5F), set(0.5F, 0, 0.4F, 0.1F, 0.5F, 0.3F, 0.8F, 0.3F, 0.4F, 1.3F),
            set(0.2F, 0.7F, 0.2F, 0.05F, 0.3F, 0.5F, 0.5F, 0.1F, 1.4F, 1.6F)};
}

constexpr Uint32 first_principled_extension =
    (sizeof(RoughTransmittance) + sizeof(::Material) - 1) / sizeof(::Material);

constexpr Packed3 unstretched{1.0F, 0.5F, 0.0F};
constexpr Packed3 upright{0.5F, 0.5F, 1.0F};

inline MetallicRoughnessLayers layers_of(float coat, float coat_roughness, float transmission, float specular, Packed3 specular_color,
                                         Packed3 anisotropy = unstretched, Packed3 coat_normal = upright, Packed3 sheen_color = {0.0F, 0.0F, 0.0F},
                                         float sheen_roughness = 0.0F) {
    return {{coat, WAVELOBE_NONE}, {coat_roughness, WAVELOBE_NONE}, {transmission, WAVELOBE_NONE}, {specular, WAVELOBE_NONE}, {specular_color, WAVELOBE_NONE},
            {anisotropy, WAVELOBE_NONE}, {coat_normal, WAVELOBE_NONE}, {sheen_color, WAVELOBE_NONE}, {sheen_roughness, WAVELOBE_NONE}, 0U};
}

// Sets of layers, by their order in lobe_extensions().
inline const std::vector<MetallicRoughnessLayers>& layer_sets() {
    static const std::vector<MetallicRoughnessLayers> sets{layers_of(1.0F, 0.3F, 0.0F, 1.0F, {0.04F, 0.04F, 0.04F}), layers_of(0.4F, 0.7F, 0.8F, 0.6F, {0.2F, 0.1F, 0.02F}),
                                                           layers_of(0.0F, 0.0F, 1.0F, 1.0F, {0.04F, 0.04F, 0.04F}), layers_of(1.0F, 0.0F, 0.0F, 0.0F, {0.0F, 0.0F, 0.0F}),
                                                           layers_of(0.0F, 0.0F, 0.0F, 1.0F, {0.04F, 0.04F, 0.04F}, {0.8F, 0.9F, 0.7F}), layers_of(0.5F, 0.3F, 0.5F, 0.8F, {0.1F, 0.1F, 0.2F}, {0.3F, 0.5F, 1.0F}),
                                                           layers_of(1.0F, 0.4F, 0.0F, 1.0F, {0.04F, 0.04F, 0.04F}, unstretched, {0.7F, 0.4F, 0.9F}),
                                                           layers_of(0.0F, 0.0F, 0.0F, 1.0F, {0.04F, 0.04F, 0.04F}, unstretched, upright, {1.0F, 1.0F, 1.0F}, 0.5F),
                                                           layers_of(0.5F, 0.3F, 0.4F, 0.8F, {0.1F, 0.1F, 0.2F}, unstretched, upright, {0.6F, 0.8F, 0.3F}, 1.0F),
                                                           layers_of(0.0F, 0.0F, 0.0F, 1.0F, {0.04F, 0.04F, 0.04F}, unstretched, upright, {1.0F, 1.0F, 1.0F}, 0.12F)};
    return sets;
}

inline const std::vector<::Material>& lobe_extensions() {
    static const std::vector<::Material> records = [] {
        std::vector<::Material> list;
        append_extension(list, falling_transmittance());
        for (const PrincipledParameters& p : principled_extensions()) append_extension(list, p);
        const std::size_t table = list.size() + layer_sets().size();
        for (MetallicRoughnessLayers layers : layer_sets()) {
            layers.sheen_albedo = static_cast<Uint32>(table - list.size());
            append_extension(list, layers);
        }
        append_extension(list, sheen_albedo());
        return list;
    }();
    return records;
}

// The record of a set of layers, for Material::extension.
inline std::uint32_t layers_record(std::size_t set) {
    return static_cast<std::uint32_t>(first_principled_extension + principled_extensions().size() + set);
}

template <class Extension>
Extension extension_of(const ::Material& m) {
    Extension extension;
    std::memcpy(&extension, &lobe_extensions()[m.extension], sizeof(Extension));
    return extension;
}

// Materials with the records of all extensions behind them.
inline std::vector<::Material> with_extensions(std::vector<::Material> materials) {
    const auto first = static_cast<std::uint32_t>(materials.size());
    for (::Material& m : materials) m.extension += first;
    materials.insert(materials.end(), lobe_extensions().begin(), lobe_extensions().end());
    return materials;
}

}  // namespace wavelobe::test
