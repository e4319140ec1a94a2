#include "render/flatten_materials.h"

#include <cstring>

#include "scene/fault.h"
#include "tables/dielectric_surface.h"
#include "tables/luminance.h"
#include "tables/sheen_albedo.h"

namespace wavelobe {
namespace {

constexpr std::uint32_t bit(LobeIndex lobe) { return 1U << lobe; }


double mean_component(const Parameter& p) {
    if (!p.texture) return (static_cast<double>(p.value.x) + p.value.y + p.value.z) / 3.0;
    return mean_luminance(p);
}

// Their record is another.
template <class Model>
constexpr bool holds_others = std::is_same_v<Model, NormalMapped> || std::is_same_v<Model, BumpMapped> ||
                              std::is_same_v<Model, TwoSided> || std::is_same_v<Model, Blend>;

std::uint32_t perturbation_flags(const NormalPerturbation& p) {
    return (p.flip_invalid ? MATERIAL_FLIPS_NORMALS : 0U) | (p.soften_terminator ? MATERIAL_SHADES_TERMINATOR : 0U);
}

// How the lobes of plastic share the samples, before Fresnel.
template <class Model>
float specular_share(const Model& m) {
    const double specular = mean_component(m.specular_reflectance);
    const double both = specular + mean_component(m.diffuse_reflectance);
    return both > 0.0 ? static_cast<float>(specular / both) : 1.0F;
}

}  // namespace

std::uint32_t MaterialFlattener::first_texel(const Texture& texture) {
    const auto [found, added] = texels_.try_emplace(&texture, static_cast<std::uint32_t>(out_.texels.size()));
    if (!added) return found->second;
    const Bitmap& bitmap = std::get<Bitmap>(texture.source);
    // Kernels gather by signed 32-bit offsets.
    if (out_.texels.size() + bitmap.rgb.size() > 0x7fffffffU)
        throw InputError(Fault{"", 0, 0, texture.name, "the scene's textures have more texels than 32-bit offsets reach", "use smaller images"});
    out_.texels.insert(out_.texels.end(), bitmap.rgb.begin(), bitmap.rgb.end());
    return found->second;
}

std::uint32_t MaterialFlattener::texture(const std::shared_ptr<const Texture>& texture, int channel) {
    if (!texture) return WAVELOBE_NONE;
    const auto [found, added] =
        textures_.try_emplace(std::pair(texture.get(), channel), static_cast<std::uint32_t>(out_.textures.size()));
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
        if (bitmap.row_wrap.value_or(bitmap.wrap) != bitmap.wrap) {
            t.kind |= TEXTURE_OTHER_ROWS;
            if (*bitmap.row_wrap == Wrap::mirror) t.kind |= TEXTURE_WRAP_MIRROR << TEXTURE_ROW_SHIFT;
            if (*bitmap.row_wrap == Wrap::clamp) t.kind |= TEXTURE_WRAP_CLAMP << TEXTURE_ROW_SHIFT;
        }
        // A scalar of another channel starts there.
        t.first_texel = first_texel(*texture) + static_cast<std::uint32_t>(channel);
        t.width = static_cast<std::uint32_t>(bitmap.width);
        t.height = static_cast<std::uint32_t>(bitmap.height);
    }
    if (texture->second_uvs) {
        t.kind |= TEXTURE_SECOND_UVS;
        out_.features.second_uvs = true;
    }
    out_.textures.push_back(t);
    return found->second;
}

TexturedRgb MaterialFlattener::rgb(const Parameter& parameter) { return {packed(parameter.value), texture(parameter.texture, 0)}; }

TexturedFloat MaterialFlattener::scalar(const Parameter& parameter) {
    return {parameter.value.x, texture(parameter.texture, parameter.channel)};
}

void MaterialFlattener::fill(DeviceMaterial& out, const Diffuse& m) {
    // Black surfaces, lamps as a rule, have nothing to go on with: paths end there.
    const bool black = !m.reflectance.texture && m.reflectance.value == glm::vec3(0.0F);
    out.lobes = black ? 0 : bit(LOBE_LAMBERT);
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

void MaterialFlattener::fill(DeviceMaterial& out, const Ward& m) {
    out.lobes = bit(LOBE_WARD) | bit(LOBE_LAMBERT);
    out.diffuse = rgb(m.diffuse_reflectance);
    out.specular = rgb(m.specular_reflectance);
    fill_roughness(out, m.alpha_u, m.alpha_v, Distribution::ggx);
    if (m.variant == Ward::Variant::ward) out.flags |= MATERIAL_WARD_CLASSIC;
    if (m.variant == Ward::Variant::ward_duer) out.flags |= MATERIAL_WARD_DUER;
}

void MaterialFlattener::nest(DeviceNesting& out, std::uint32_t kind, const NestedMaterial& first, const NestedMaterial& second) {
    out.flags = kind;
    out.inner[0] = add(first.get());
    out.inner[1] = add(second.get());
    for (const std::uint32_t inner : out.inner) out.lobes |= lobes(inner);
}

int MaterialFlattener::levels_of(const DeviceNesting& nesting) const {
    int levels = 0;
    for (const std::uint32_t inner : nesting.inner) {
        const auto known = levels_.find(inner);
        if (known != levels_.end()) levels = std::max(levels, known->second);
    }
    return levels + 1;
}

void MaterialFlattener::fill(DeviceNesting& out, const NormalMapped& m) {
    nest(out, MATERIAL_NORMAL_MAP | perturbation_flags(m.perturbation), m.nested, nullptr);
    out_.features.normal_maps = true;
    out.normal = rgb(m.normals);
    out.scale = m.scale;
}

void MaterialFlattener::fill(DeviceNesting& out, const BumpMapped& m) {
    nest(out, MATERIAL_BUMP_MAP | perturbation_flags(m.perturbation), m.nested, nullptr);
    out_.features.normal_maps = out_.features.bump_maps = true;
    out.height = texture(m.height, 0);
    out.scale = m.scale;
}

void MaterialFlattener::fill(DeviceNesting& out, const TwoSided& m) {
    nest(out, MATERIAL_SIDES, m.front, m.back);
    out_.features.nested_sides = true;
}

void MaterialFlattener::fill(DeviceNesting& out, const Blend& m) {
    nest(out, MATERIAL_BLEND, m.first, m.second);
    out_.features.blends = true;
    out.weight = scalar(m.weight);
}

void MaterialFlattener::fill(DeviceMaterial& out, const MetallicRoughness& m) {
    out_.features.ggx = true;
    out.diffuse = rgb(m.base_color);
    out.metallic = scalar(m.metallic);
    out.alpha_u = scalar(m.roughness);
    const double amplitude = m.ior == 0.0F ? 1.0 : (1.0 - static_cast<double>(m.ior)) / (1.0 + static_cast<double>(m.ior));
    const Rgb reflectance = static_cast<float>(amplitude * amplitude) * m.specular_color.value;
    // A metal throughout has no base.
    const bool has_base = m.metallic.texture || m.metallic.value.x < 1.0F;
    const bool transmits = has_base && m.transmission.value.x > 0.0F;
    const bool anisotropic = m.anisotropy.texture || m.anisotropy.value.z > 0.0F;
    const Rgb sheen = m.sheen_color.value;
    const bool has_sheen = std::max({sheen.x, sheen.y, sheen.z}) > 0.0F;
    if (transmits || anisotropic || has_sheen || m.clearcoat.value.x > 0.0F || m.specular.texture || m.specular_color.texture) {
        out.lobes = bit(LOBE_LAYERED_METALLIC_ROUGHNESS);
        if (has_sheen) out.lobes |= bit(LOBE_SHEEN_METALLIC_ROUGHNESS_BASE);
        else if (has_base) out.lobes |= bit(LOBE_LAYERED_METALLIC_ROUGHNESS_BASE);
        if (has_sheen && sheen_albedo_ == WAVELOBE_NONE) sheen_albedo_ = add_extension(sheen_albedo());
        out_.features.anisotropy = out_.features.anisotropy || anisotropic;
        if (transmits) out.flags |= MATERIAL_TRANSMISSIVE | MATERIAL_THIN;
        out.eta.x = 1.0F;
        Parameter f0 = m.specular_color;
        f0.value = reflectance;
        out.extension = add_extension(MetallicRoughnessLayers{scalar(m.clearcoat), scalar(m.clearcoat_roughness), scalar(m.transmission),
                                                              scalar(m.specular), rgb(f0), rgb(m.anisotropy),
                                                              rgb(m.clearcoat_normal.value_or(Parameter{Rgb{0.5F, 0.5F, 1.0F}, nullptr})),
                                                              rgb(m.sheen_color), scalar(m.sheen_roughness),
                                                              sheen_albedo_ - static_cast<std::uint32_t>(out_.materials.size())});
        out_.features.coat_normals = out_.features.coat_normals || (m.clearcoat_normal && m.clearcoat.value.x > 0.0F);
        return;
    }
    out.lobes = bit(LOBE_METALLIC_ROUGHNESS);
    if (has_base) out.lobes |= bit(LOBE_METALLIC_ROUGHNESS_BASE);
    out.specular.value = packed(glm::min(reflectance, Rgb(1.0F)) * m.specular.value.x);
    out.specular_weight = m.specular.value.x;
}

std::uint32_t MaterialFlattener::add(int material) {
    return add(material < 0 ? nullptr : &scene_.materials[static_cast<std::size_t>(material)]);
}

std::uint32_t MaterialFlattener::add(const Material* material) {
    if (material == nullptr) return WAVELOBE_NONE;
    if (const auto known = materials_.find(material); known != materials_.end()) return known->second;
    // Before its extension and what it holds: lanes without a material read the first record, which must be one.
    const auto index = static_cast<std::uint32_t>(out_.materials.size());
    out_.materials.emplace_back();
    DeviceMaterial m{};
    for (TexturedRgb* parameter : {&m.diffuse, &m.specular, &m.transmission}) parameter->texture = WAVELOBE_NONE;
    for (TexturedFloat* parameter : {&m.alpha_u, &m.alpha_v, &m.exponent, &m.metallic}) parameter->texture = WAVELOBE_NONE;
    std::visit(
        [this, &m, index](const auto& model) {
            if constexpr (holds_others<std::decay_t<decltype(model)>>) {
                DeviceNesting nesting{};
                nesting.normal.texture = nesting.weight.texture = nesting.height = WAVELOBE_NONE;
                fill(nesting, model);
                levels_[index] = levels_of(nesting);
                out_.features.material_levels = std::max(out_.features.material_levels, levels_[index]);
                std::memcpy(static_cast<void*>(&m), &nesting, sizeof(nesting));
            } else {
                fill(m, model);
            }
        },
        material->model);

    FeatureSet& f = out_.features;
    f.lobes |= m.lobes;
    f.transmission = f.transmission || (m.flags & MATERIAL_TRANSMISSIVE) != 0;
    std::uint32_t classes = 0;
    for (std::uint32_t i = 0; i < LOBE_COUNT; ++i) {
        if (((m.lobes >> i) & 1U) != 0) classes |= 1U << lobe_class(i);
    }
    constexpr std::uint32_t smooth = (1U << LOBE_CLASS_GLOSSY) | (1U << LOBE_CLASS_DIFFUSE);
    f.mixture = f.mixture || ((m.flags & MATERIAL_NESTS) == 0 && (classes & smooth) == smooth);
    f.lobe_choice = f.lobe_choice || (classes & (classes - 1U)) != 0;
    out_.materials[index] = m;
    materials_.emplace(material, index);
    return index;
}

DeviceOpacity MaterialFlattener::opacity(const Opacity& opacity) {
    return {scalar(opacity.value), opacity.texture_scale, opacity.cutoff ? std::max(*opacity.cutoff, 0.0F) : -1.0F, WAVELOBE_NONE,
            WAVELOBE_NONE};
}

std::uint32_t MaterialFlattener::lobes(std::uint32_t device_material) const {
    return device_material == WAVELOBE_NONE ? 0 : out_.materials[device_material].lobes;
}

}  // namespace wavelobe
