#include "scene/gltf/materials.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wavelobe::gltf {

namespace {

constexpr std::size_t default_material = static_cast<std::size_t>(-1);
constexpr NumberRange unit{0.0, 1.0};
constexpr NumberRange positive{0.0, std::numeric_limits<float>::max()};

Rgb rgb(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

// Mean of a scalar parameter over its texture.
double mean(const Parameter& p) {
    if (!p.texture) return static_cast<double>(p.value.x);
    const Bitmap& bitmap = std::get<Bitmap>(p.texture->source);
    double sum = 0.0;
    for (std::size_t i = static_cast<std::size_t>(p.channel); i < bitmap.rgb.size(); i += 3) sum += static_cast<double>(bitmap.rgb[i]);
    return static_cast<double>(p.value.x) * sum / (static_cast<double>(bitmap.rgb.size()) / 3.0);
}

}  // namespace

std::shared_ptr<const Texture> Materials::take(const Element& owner, const char* name, const TextureUse& use, Appearance& out) {
    if (!use.texture) return nullptr;
    if (!uv_chosen_) out.uv_set = use.uv_set;
    else if (out.uv_set != use.uv_set)
        document_.warn(fmt::format("{}: {}/{} looks up TEXCOORD_{}, and other textures of its material TEXCOORD_{}, which serves for all",
                                   document_.file, owner.path(), name, use.uv_set, out.uv_set));
    uv_chosen_ = true;
    return use.texture;
}

void Materials::read_emission(const Element& material, Appearance& out) {
    const double strength = material.extension("KHR_materials_emissive_strength").number("emissiveStrength", 1.0, positive);
    const Rgb emission = rgb(material.vector<3>("emissiveFactor", {0, 0, 0}, positive)) * static_cast<float>(strength);
    const TextureUse use = textures_.scaled(material, "emissiveTexture", Transfer::of_format, emission);
    if (emission == Rgb(0.0F)) return;
    out.emitter = AreaEmitter{{emission, take(material, "emissiveTexture", use, out)}};
}

void Materials::read_alpha(const Element& material, float factor, Appearance& out) {
    const std::string mode = material.text("alphaMode", "OPAQUE");
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
        material.fault("alphaMode `" + mode + "`; expected OPAQUE, MASK or BLEND");
    const double cutoff = material.number("alphaCutoff", 0.5, positive);
    if (mode != "MASK" && mode != "BLEND") return;
    Opacity& opacity = out.surface.opacity;
    opacity.value.value = Rgb(factor);
    opacity.texture_scale = factor;
    if (mode == "MASK") opacity.cutoff = static_cast<float>(cutoff);
    const Element pbr = material.object("pbrMetallicRoughness");
    opacity.value.texture = take(pbr, "baseColorTexture", textures_.use(pbr, "baseColorTexture", Transfer::alpha), out);
}

// A surface that lets light through is one of the dielectrics where the factor is at least one half.
std::optional<MaterialModel> Materials::read_transmission(const Element& material, const MetallicRoughness& surface, Appearance& out) {
    const Element transmission = material.extension("KHR_materials_transmission");
    const double share = transmission.number("transmissionFactor", 0.0, unit);
    const Element volume = material.extension("KHR_materials_volume");
    const double thickness = volume.number("thicknessFactor", 0.0, positive);
    volume.number("attenuationDistance", 1.0, positive);
    volume.vector<3>("attenuationColor", {1, 1, 1}, unit);
    if (share < 0.5 || mean(surface.metallic) > 0.5) {
        if (share > 0.0)
            document_.warn(fmt::format("{}: {}: a transmission of {} {}is taken as none", document_.file, material.path(), share,
                                       share < 0.5 ? "" : "of a metal "));
        return {};
    }
    if (transmission.has("transmissionTexture"))
        document_.warn(fmt::format("{}: {}: the texture of the transmission is passed over", document_.file, material.path()));
    Parameter tint = surface.base_color;
    if (tint.texture) {
        const Element pbr = material.object("pbrMetallicRoughness");
        tint.texture = take(pbr, "baseColorTexture", textures_.scaled(pbr, "baseColorTexture", Transfer::of_format, tint.value), out);
    }
    if (thickness > 0.0 && volume.has("attenuationDistance"))
        document_.warn(fmt::format("{}: {}: absorption inside the volume is passed over", document_.file, material.path()));
    const auto roughness = static_cast<float>(mean(surface.roughness));
    const float alpha = roughness * roughness;
    const Parameter white{Rgb(1.0F), nullptr};
    if (thickness == 0.0) {
        if (alpha > 1e-3F)
            document_.warn(fmt::format("{}: {}: light goes straight through, whatever its roughness", document_.file, material.path()));
        return ThinDielectric{surface.ior, white, tint};
    }
    // Light crosses the surface twice.
    if (!tint.texture) tint.value = glm::sqrt(tint.value);
    if (alpha <= 1e-3F) return Dielectric{surface.ior, white, tint};
    const Parameter rough{Rgb(alpha), nullptr};
    return RoughDielectric{surface.ior, white, tint, rough, rough, Distribution::ggx};
}

MaterialModel Materials::read_model(const Element& material, Appearance& out) {
    const Element pbr = material.object("pbrMetallicRoughness");
    const auto base = pbr.vector<4>("baseColorFactor", {1, 1, 1, 1}, unit);
    MetallicRoughness model;
    model.base_color.value = {base[0], base[1], base[2]};
    model.base_color.texture = take(pbr, "baseColorTexture", textures_.use(pbr, "baseColorTexture", Transfer::of_format), out);
    read_alpha(material, base[3], out);
    if (material.extension("KHR_materials_unlit").present()) {
        // It shines in its colour and reflects nothing.
        const TextureUse use = textures_.scaled(pbr, "baseColorTexture", Transfer::of_format, model.base_color.value);
        out.emitter = AreaEmitter{{model.base_color.value, take(pbr, "baseColorTexture", use, out)}};
        return Diffuse{{Rgb(0.0F), nullptr}};
    }
    model.metallic.value = Rgb(static_cast<float>(pbr.number("metallicFactor", 1.0, unit)));
    model.roughness.value = Rgb(static_cast<float>(pbr.number("roughnessFactor", 1.0, unit)));
    const TextureUse both = textures_.use(pbr, "metallicRoughnessTexture", Transfer::linear);
    model.roughness.texture = model.metallic.texture = take(pbr, "metallicRoughnessTexture", both, out);
    model.roughness.channel = 1;
    model.metallic.channel = 2;
    model.ior = static_cast<float>(material.extension("KHR_materials_ior").number("ior", 1.5, positive));
    if (model.ior != 0.0F && model.ior < 1.0F) {
        material.extension("KHR_materials_ior").fault(fmt::format("an index of {}; expected 0, or at least 1", model.ior));
        model.ior = 1.5F;
    }
    const Element specular = material.extension("KHR_materials_specular");
    model.specular = static_cast<float>(specular.number("specularFactor", 1.0, unit));
    model.specular_color = rgb(specular.vector<3>("specularColorFactor", {1, 1, 1}, positive));
    for (const char* name : {"specularTexture", "specularColorTexture"})
        if (specular.has(name)) document_.warn(fmt::format("{}: {}/{}: passed over", document_.file, specular.path(), name));
    if (const auto through = read_transmission(material, model, out)) return *through;
    return model;
}

void Materials::name_what_is_left_out(const Element& material) {
    for (const char* name : {"KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_anisotropy"})
        if (material.extension(name).present())
            document_.warn(fmt::format("{}: {}: {} is passed over", document_.file, material.path(), name));
    const Element normal = material.object("normalTexture");
    if (normal.present()) {
        normal.index("index", document_.textures.size(), "textures");
        document_.warn(fmt::format("{}: {}: the normal map is passed over", document_.file, material.path()));
    }
    const Element occlusion = material.object("occlusionTexture");
    if (occlusion.present()) {
        occlusion.index("index", document_.textures.size(), "textures");
        document_.warn(fmt::format("{}: {}: the occlusion texture is not needed: paths find what is occluded", document_.file, material.path()));
    }
}

Appearance Materials::read(const Element& material) {
    Appearance out;
    uv_chosen_ = false;
    MaterialModel model = read_model(material, out);
    if (!material.extension("KHR_materials_unlit").present()) read_emission(material, out);
    material.flag("doubleSided", false);
    name_what_is_left_out(material);
    // Paths have no faces to cull: both sides show the material, whatever `doubleSided` says.
    out.surface.front = out.surface.back = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back({std::move(model), material.text("name", "material")});
    return out;
}

void Materials::check() {
    textures_.check();
    for (std::size_t i = 0; i < document_.materials.size(); ++i) appearance(i);
}

const Appearance& Materials::appearance(std::optional<std::size_t> material) {
    const std::size_t key = material.value_or(default_material);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    const Element absent{nullptr, "/materials", &document_.faults};
    return known_.emplace(key, read(material ? document_.materials[*material] : absent)).first->second;
}

}  // namespace wavelobe::gltf
