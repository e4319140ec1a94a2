#include "render/flatten_materials.h"

#include <cstring>

#include "tables/dielectric_surface.h"
#include "tables/light_power.h"

namespace wavelobe {
namespace {

constexpr std::uint32_t bit(LobeIndex lobe) { return 1U << lobe; }

Packed3 packed(const Rgb& v) { return {v.x, v.y, v.z}; }

double mean_component(const Parameter& p) {
    if (!p.texture) return (static_cast<double>(p.value.x) + p.value.y + p.value.z) / 3.0;
    return mean_luminance(p);
}

// How the lobes of plastic share the samples, before Fresnel.
template <class Model>
float specular_share(const Model& m) {
    const double specular = mean_component(m.specular_reflectance);
    const double both = specular + mean_component(m.diffuse_reflectance);
    return both > 0.0 ? static_cast<float>(specular / both) : 1.0F;
}

}  // namespace

std::uint32_t MaterialFlattener::texture(const std::shared_ptr<const Texture>& texture) {
    if (!texture) return WAVELOBE_NONE;
    const auto [found, added] = textures_.try_emplace(texture.get(), static_cast<std::uint32_t>(out_.textures.size()));
    if (!added) return found->second;
    DeviceTexture t{};
    for (int row = 0; row < 2; ++row) {
        for (int column = 0; column < 3; ++column) t.to_uv[3 * row + column] = texture->to_uv[column][row];
    }
    if (const auto* checkerboard = std::get_if<Checkerboard>(&texture->source)) {
        t.kind = TEXTURE_CHECKERBOARD;
        t.color0 = packed(checkerboard->color0);
        t.color1 = packed(checkerboard->color1);
    } else {
        const Bitmap& bitmap = std::get<Bitmap>(texture->source);
        t.kind = TEXTURE_BITMAP;
        if (bitmap.filter == Filter::nearest) t.kind |= TEXTURE_NEAREST;
        if (bitmap.wrap == Wrap::mirror) t.kind |= TEXTURE_WRAP_MIRROR;
        if (bitmap.wrap == Wrap::clamp) t.kind |= TEXTURE_WRAP_CLAMP;
        t.first_texel = static_cast<std::uint32_t>(out_.texels.size());
        t.width = static_cast<std::uint32_t>(bitmap.width);
        t.height = static_cast<std::uint32_t>(bitmap.height);
        out_.texels.insert(out_.texels.end(), bitmap.rgb.begin(), bitmap.rgb.end());
    }
    out_.textures.push_back(t);
    return found->second;
}

TexturedRgb MaterialFlattener::rgb(const Parameter& parameter) { return {packed(parameter.value), texture(parameter.texture)}; }

TexturedFloat MaterialFlattener::scalar(const Parameter& parameter) {
    return {parameter.value.x, texture(parameter.texture)};
}

void MaterialFlattener::fill(DeviceMaterial& out, const Diffuse& m) {
    out.lobes = bit(LOBE_LAMBERT);
    out.diffuse = rgb(m.reflectance);
}

void MaterialFlattener::fill(DeviceMaterial& out, const Conductor& m) {
    out.lobes = bit(LOBE_MIRROR);
    out.specular = rgb(m.specular_reflectance);
    out.eta = packed(m.eta);
    out.k = packed(m.k);
}

void MaterialFlattener::fill_roughness(DeviceMaterial& out, const Parameter& alpha_u, const Parameter& alpha_v,
                                       Distribution distribution) {
    out.alpha_u = scalar(alpha_u);
    out.alpha_v = scalar(alpha_v);
    if (distribution == Distribution::beckmann) out.flags |= MATERIAL_BECKMANN;
    (distribution == Distribution::beckmann ? out_.features.beckmann : out_.features.ggx) = true;
    const bool isotropic = alpha_u.texture == alpha_v.texture && alpha_u.value.x == alpha_v.value.x;
    out_.features.anisotropy = out_.features.anisotropy || !isotropic;
}

void MaterialFlattener::fill(DeviceMaterial& out, const RoughConductor& m) {
    out.lobes = bit(LOBE_ROUGH_CONDUCTOR);
    out.specular = rgb(m.specular_reflectance);
    out.eta = packed(m.eta);
    out.k = packed(m.k);
    fill_roughness(out, m.alpha_u, m.alpha_v, m.distribution);
}

template <class Model>
void MaterialFlattener::fill_interface(DeviceMaterial& out, const Model& m) {
    out.flags = MATERIAL_TRANSMISSIVE;
    out.eta.x = m.eta;
    out.specular = rgb(m.specular_reflectance);
    out.transmission = rgb(m.specular_transmittance);
}

void MaterialFlattener::fill(DeviceMaterial& out, const Dielectric& m) {
    out.lobes = bit(LOBE_DIELECTRIC);
    fill_interface(out, m);
}

void MaterialFlattener::fill(DeviceMaterial& out, const ThinDielectric& m) {
    out.lobes = bit(LOBE_THIN_DIELECTRIC);
    fill_interface(out, m);
}

void MaterialFlattener::fill(DeviceMaterial& out, const RoughDielectric& m) {
    out.lobes = bit(LOBE_ROUGH_DIELECTRIC);
    fill_interface(out, m);
    fill_roughness(out, m.alpha_u, m.alpha_v, m.distribution);
}

void MaterialFlattener::fill(DeviceMaterial& out, const Plastic& m) {
    out.lobes = bit(LOBE_PLASTIC_COAT) | bit(LOBE_PLASTIC_BASE);
    if (m.nonlinear) out.flags |= MATERIAL_NONLINEAR;
    out.eta.x = m.eta;
    out.diffuse = rgb(m.diffuse_reflectance);
    out.specular = rgb(m.specular_reflectance);
    out.diffuse_fresnel_internal = static_cast<float>(diffuse_fresnel(1.0 / static_cast<double>(m.eta)));
    out.specular_weight = specular_share(m);
}

void MaterialFlattener::fill(DeviceMaterial& out, const RoughPlastic& m) {
    out.lobes = bit(LOBE_ROUGH_PLASTIC_COAT) | bit(LOBE_ROUGH_PLASTIC_BASE);
    if (m.nonlinear) out.flags |= MATERIAL_NONLINEAR;
    out.eta.x = m.eta;
    out.diffuse = rgb(m.diffuse_reflectance);
    out.specular = rgb(m.specular_reflectance);
    const Parameter alpha{Rgb{m.alpha}, nullptr};
    fill_roughness(out, alpha, alpha, m.distribution);
    const RoughSurface surface = rough_surface(m.eta, m.alpha, m.distribution);
    out.diffuse_fresnel_internal = surface.internal_reflectance;
    RoughTransmittance table{};
    std::copy(surface.transmittance.begin(), surface.transmittance.end(), table.at);
    out.extension = add_extension(table);
    out.specular_weight = specular_share(m);
}

void MaterialFlattener::fill(DeviceMaterial& out, const Phong& m) {
    out.lobes = bit(LOBE_PHONG) | bit(LOBE_LAMBERT);
    out.diffuse = rgb(m.diffuse_reflectance);
    out.specular = rgb(m.specular_reflectance);
    out.exponent = scalar(m.exponent);
}

template <class Extension>
std::uint32_t MaterialFlattener::add_extension(const Extension& extension) {
    const std::size_t first = out_.materials.size();
    out_.materials.resize(first + (sizeof(Extension) + sizeof(DeviceMaterial) - 1) / sizeof(DeviceMaterial));
    std::memcpy(static_cast<void*>(&out_.materials[first]), &extension, sizeof(Extension));
    return static_cast<std::uint32_t>(first);
}

std::uint32_t MaterialFlattener::add(int material) {
    if (material < 0) return WAVELOBE_NONE;
    if (const auto known = materials_.find(material); known != materials_.end()) return known->second;
    DeviceMaterial m{};
    for (TexturedRgb* parameter : {&m.diffuse, &m.specular, &m.transmission}) parameter->texture = WAVELOBE_NONE;
    for (TexturedFloat* parameter : {&m.alpha_u, &m.alpha_v, &m.exponent}) parameter->texture = WAVELOBE_NONE;
    std::visit([this, &m](const auto& model) { fill(m, model); },
               scene_.materials[static_cast<std::size_t>(material)].model);

    FeatureSet& f = out_.features;
    f.lobes |= m.lobes;
    f.transmission = f.transmission || (m.flags & MATERIAL_TRANSMISSIVE) != 0;
    std::uint32_t classes = 0;
    for (std::uint32_t i = 0; i < LOBE_COUNT; ++i) {
        if (((m.lobes >> i) & 1U) != 0) classes |= 1U << lobe_class(i);
    }
    constexpr std::uint32_t smooth = (1U << LOBE_CLASS_GLOSSY) | (1U << LOBE_CLASS_DIFFUSE);
    f.mixture = f.mixture || (classes & smooth) == smooth;
    f.lobe_choice = f.lobe_choice || (classes & (classes - 1U)) != 0;
    const auto index = static_cast<std::uint32_t>(out_.materials.size());
    out_.materials.push_back(m);
    materials_.emplace(material, index);
    return index;
}

DeviceOpacity MaterialFlattener::opacity(const Opacity& opacity) {
    return {scalar(opacity.value), opacity.texture_scale, opacity.cutoff ? std::max(*opacity.cutoff, 0.0F) : -1.0F};
}

std::uint32_t MaterialFlattener::lobes(std::uint32_t device_material) const {
    return device_material == WAVELOBE_NONE ? 0 : out_.materials[device_material].lobes;
}

}  // namespace wavelobe
