#include "render/flatten_materials.h"

#include <cmath>

#include "tables/light_power.h"

namespace wavelobe {
namespace {

constexpr std::uint32_t bit(LobeIndex lobe) { return 1U << lobe; }

Packed3 packed(const Rgb& v) { return {v.x, v.y, v.z}; }

// Unpolarized Fresnel reflectance of a dielectric boundary, eta = inside over outside (double: a table entry, not a path).
double fresnel_dielectric(double cos_i, double eta) {
    const double sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1.0) return 1.0;
    const double cos_t = std::sqrt(1.0 - sin2_t);
    const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const double perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Reflectance for diffuse light: 2 integral of F(mu) mu over mu in [0, 1], midpoint rule in mu^2, fine enough
// that the error stays below a rounding of float.
double diffuse_fresnel(double eta) {
    constexpr int steps = 1 << 16;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += fresnel_dielectric(std::sqrt((i + 0.5) / steps), eta);
    return sum / steps;
}

double mean_component(const Parameter& p) {
    if (!p.texture) return (static_cast<double>(p.value.x) + p.value.y + p.value.z) / 3.0;
    return mean_luminance(p);
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
    const double specular = mean_component(m.specular_reflectance);
    const double both = specular + mean_component(m.diffuse_reflectance);
    out.specular_weight = both > 0.0 ? static_cast<float>(specular / both) : 1.0F;
}

void MaterialFlattener::fill(DeviceMaterial& out, const Phong& m) {
    out.lobes = bit(LOBE_PHONG) | bit(LOBE_LAMBERT);
    out.diffuse = rgb(m.diffuse_reflectance);
    out.specular = rgb(m.specular_reflectance);
    out.exponent = scalar(m.exponent);
}

void MaterialFlattener::fill(DeviceMaterial& out, const MetallicRoughness& m) {
    out.lobes = bit(LOBE_METALLIC_ROUGHNESS);
    // A metal throughout has no base.
    if (m.metallic.texture || m.metallic.value.x < 1.0F) out.lobes |= bit(LOBE_METALLIC_ROUGHNESS_BASE);
    out_.features.ggx = true;
    out.diffuse = rgb(m.base_color);
    out.metallic = scalar(m.metallic);
    out.alpha_u = scalar(m.roughness);
    const double amplitude = (1.0 - static_cast<double>(m.ior)) / (1.0 + static_cast<double>(m.ior));
    out.specular.value = packed(Rgb(static_cast<float>(amplitude * amplitude)));
}

std::uint32_t MaterialFlattener::add(int material) {
    if (material < 0) return WAVELOBE_NONE;
    const auto [found, added] = materials_.try_emplace(material, static_cast<std::uint32_t>(out_.materials.size()));
    if (!added) return found->second;
    DeviceMaterial m{};
    for (TexturedRgb* parameter : {&m.diffuse, &m.specular, &m.transmission}) parameter->texture = WAVELOBE_NONE;
    for (TexturedFloat* parameter : {&m.alpha_u, &m.alpha_v, &m.exponent, &m.metallic}) parameter->texture = WAVELOBE_NONE;
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
    out_.materials.push_back(m);
    return found->second;
}

std::uint32_t MaterialFlattener::lobes(std::uint32_t device_material) const {
    return device_material == WAVELOBE_NONE ? 0 : out_.materials[device_material].lobes;
}

}  // namespace wavelobe
