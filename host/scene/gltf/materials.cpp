#include "scene/gltf/materials.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/gltf/volumes.h"

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

// Across the tangent: the second of two coordinates, stored as (y + 1) / 2.
void turn_over(Parameter& parameter) {
    parameter.value.y = 1.0F - parameter.value.y;
    if (!parameter.texture) return;
    auto texture = std::make_shared<Texture>(*parameter.texture);
    std::vector<float>& rgb = std::get<Bitmap>(texture->source).rgb;
    for (std::size_t i = 1; i < rgb.size(); i += 3) rgb[i] = 1.0F - rgb[i];
    parameter.texture = std::move(texture);
}

bool turn_over(NestedMaterial& nested);

// All that a material says of the tangent frame; whether that is anything.
bool turn_over(Material& material) {
    if (auto* map = std::get_if<NormalMapped>(&material.model)) {
        turn_over(map->normals);
        turn_over(map->nested);
        return true;
    }
    if (auto* sides = std::get_if<TwoSided>(&material.model)) {
        const bool turned = turn_over(sides->front);
        sides->back = sides->front;
        return turned;
    }
    auto* layers = std::get_if<MetallicRoughness>(&material.model);
    if (layers == nullptr) return false;
    const bool coated = layers->clearcoat_normal && layers->clearcoat_normal->texture;
    if (coated) turn_over(*layers->clearcoat_normal);
    if (layers->anisotropy.value.z == 0.0F) return coated;
    turn_over(layers->anisotropy);
    return true;
}

bool turn_over(NestedMaterial& nested) {
    auto turned = std::make_shared<Material>(*nested);
    if (!turn_over(*turned)) return false;
    nested = std::move(turned);
    return true;
}

}  // namespace

std::shared_ptr<const Texture> Materials::take(const Element& owner, const char* name, Transfer transfer, Appearance& out, const Rgb& factor) {
    const Element info = owner.object(name);
    if (!info.present()) return nullptr;
    const std::int64_t set = uv_set_of(info);
    auto slot = std::find(out.uv_sets.begin(), out.uv_sets.end(), set);
    if (slot == out.uv_sets.end() && out.uv_sets.size() == 2) {
        document_.warn(fmt::format("{}: {} is the third set of coordinates of its material, TEXCOORD_{}; TEXCOORD_{} serves in its place",
                                   document_.file, info.path(), set, out.uv_sets[0]));
        slot = out.uv_sets.begin();
    }
    if (slot == out.uv_sets.end()) slot = out.uv_sets.insert(slot, set);
    return textures_.use(info, transfer, factor, slot != out.uv_sets.begin());
}

void Materials::read_emission(const Element& material, Appearance& out) {
    const double strength = material.extension("KHR_materials_emissive_strength").number("emissiveStrength", 1.0, positive);
    const Rgb emission = rgb(material.vector<3>("emissiveFactor", {0, 0, 0}, positive)) * static_cast<float>(strength);
    const auto texture = take(material, "emissiveTexture", Transfer::of_format, out, emission);
    if (emission == Rgb(0.0F)) return;
    // Of a surface that is not all there neither is its light, which sampling does not know.
    const bool whole = material.text("alphaMode", "OPAQUE") == "OPAQUE";
    out.emitter = AreaEmitter{{emission, texture}, material.flag("doubleSided", false), whole};
}

void Materials::read_alpha(const Element& material, float factor, Appearance& out) {
    const std::string mode = material.text("alphaMode", "OPAQUE");
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
        material.fault("alphaMode `" + mode + "`; expected OPAQUE, MASK or BLEND");
    const double cutoff = material.number("alphaCutoff", 0.5, positive);
    if (mode != "MASK" && mode != "BLEND") return;
    out.blends = true;
    Opacity& opacity = out.surface.opacity;
    opacity.value.value = Rgb(factor);
    opacity.texture_scale = factor;
    if (mode == "MASK") opacity.cutoff = static_cast<float>(cutoff);
    const Element pbr = material.object("pbrMetallicRoughness");
    opacity.value.texture = take(pbr, "baseColorTexture", Transfer::alpha, out);
}

// What a member of an extension says of a scalar: a factor, and a channel of a texture.
Parameter Materials::read_scalar(const Element& owner, const char* factor, double fallback, const char* texture, Transfer transfer, int channel,
                                 Appearance& out) {
    const auto value = static_cast<float>(owner.number(factor, fallback, unit));
    return {Rgb(value), take(owner, texture, transfer, out), channel};
}

void Materials::read_layers(const Element& material, MetallicRoughness& model, Appearance& out) {
    const Element specular = material.extension("KHR_materials_specular");
    model.specular = read_scalar(specular, "specularFactor", 1.0, "specularTexture", Transfer::alpha, 0, out);
    model.specular_color.value = rgb(specular.vector<3>("specularColorFactor", {1, 1, 1}, positive));
    model.specular_color.texture = take(specular, "specularColorTexture", Transfer::of_format, out);
    const Element coat = material.extension("KHR_materials_clearcoat");
    model.clearcoat = read_scalar(coat, "clearcoatFactor", 0.0, "clearcoatTexture", Transfer::linear, 0, out);
    model.clearcoat_roughness = read_scalar(coat, "clearcoatRoughnessFactor", 0.0, "clearcoatRoughnessTexture", Transfer::linear, 1, out);
    const Element sheen = material.extension("KHR_materials_sheen");
    model.sheen_color.value = rgb(sheen.vector<3>("sheenColorFactor", {0, 0, 0}, unit));
    model.sheen_color.texture = take(sheen, "sheenColorTexture", Transfer::of_format, out);
    model.sheen_roughness = read_scalar(sheen, "sheenRoughnessFactor", 0.0, "sheenRoughnessTexture", Transfer::alpha, 0, out);
    const Element transmission = material.extension("KHR_materials_transmission");
    model.transmission = read_scalar(transmission, "transmissionFactor", 0.0, "transmissionTexture", Transfer::linear, 0, out);
}

// A volume that mostly lets light through is one of the dielectrics; other transmission is that of a thin wall.
std::optional<MaterialModel> Materials::read_volume(const Element& material, const MetallicRoughness& surface, Appearance& out) {
    const Element volume = material.extension("KHR_materials_volume");
    const Rgb absorption = absorption_of(volume);
    const auto factor = static_cast<float>(volume.number("thicknessFactor", 0.0, positive));
    const Parameter depth{Rgb(factor), textures_.use(volume.object("thicknessTexture"), Transfer::linear, Rgb(1.0F), false), 1};
    const double thickness = mean(depth);
    const double share = mean(surface.transmission);
    if (thickness == 0.0 || share == 0.0) return {};
    if (share < 0.5 || mean(surface.metallic) > 0.5) {
        document_.warn(fmt::format("{}: {}: a volume that lets {:.2g} of the light through is taken as a thin wall", document_.file, material.path(), share));
        return {};
    }
    if (surface.transmission.texture || share < 1.0)
        document_.warn(fmt::format("{}: {}: all of the volume lets light through, whatever its transmission", document_.file, material.path()));
    Parameter tint = surface.base_color;
    if (tint.texture) {
        const Element pbr = material.object("pbrMetallicRoughness");
        tint.texture = take(pbr, "baseColorTexture", Transfer::of_format, out, tint.value);
    }
    out.is_volume = true;
    if (absorption != Rgb(0.0F)) {
        out.medium = static_cast<int>(scene_.media.size());
        scene_.media.push_back({absorption, material.text("name", "material")});
    }
    const auto roughness = static_cast<float>(mean(surface.roughness));
    const float alpha = roughness * roughness;
    const Parameter white{Rgb(1.0F), nullptr};
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
    model.base_color.texture = take(pbr, "baseColorTexture", Transfer::of_format, out);
    read_alpha(material, base[3], out);
    if (material.extension("KHR_materials_unlit").present()) {
        // It shines in its colour and reflects nothing. Paths that find it see it so; it is no lamp, and not sampled.
        const Rgb color = model.base_color.value;
        AreaEmitter glow;
        glow.radiance = {color, take(pbr, "baseColorTexture", Transfer::of_format, out, color)};
        glow.both_sides = material.flag("doubleSided", false);
        glow.sampled = false;
        glow.colored = true;
        out.emitter = glow;
        return Diffuse{{Rgb(0.0F), nullptr}};
    }
    model.metallic.value = Rgb(static_cast<float>(pbr.number("metallicFactor", 1.0, unit)));
    model.roughness.value = Rgb(static_cast<float>(pbr.number("roughnessFactor", 1.0, unit)));
    model.roughness.texture = model.metallic.texture = take(pbr, "metallicRoughnessTexture", Transfer::linear, out);
    model.roughness.channel = 1;
    model.metallic.channel = 2;
    model.ior = static_cast<float>(material.extension("KHR_materials_ior").number("ior", 1.5, positive));
    if (model.ior != 0.0F && model.ior < 1.0F) {
        material.extension("KHR_materials_ior").fault(fmt::format("an index of {}; expected 0, or at least 1", model.ior));
        model.ior = 1.5F;
    }
    read_layers(material, model, out);
    if (const auto volume = read_volume(material, model, out)) return *volume;
    return model;
}

void Materials::name_what_is_left_out(const Element& material) {
    const Element occlusion = material.object("occlusionTexture");
    if (occlusion.present()) {
        occlusion.index("index", document_.textures.size(), "textures");
        document_.warn(fmt::format("{}: {}: the occlusion texture is not needed: paths find what is occluded", document_.file, material.path()));
    }
}

// Its tangents follow the first set of coordinates, so it takes its own before all others do.
NormalMapped Materials::read_normal_map(const Element& material, Appearance& out) {
    NormalMapped map;
    map.normals.texture = take(material, "normalTexture", Transfer::linear, out);
    map.scale = static_cast<float>(material.object("normalTexture").number("scale", 1.0));
    map.perturbation.soften_terminator = false;
    return map;
}

// Of the coat, which without one keeps to the surface's own normal whatever map is below it.
std::optional<Parameter> Materials::read_coat_normal(const Element& material, bool has_normal_map, Appearance& out) {
    const Element coat = material.extension("KHR_materials_clearcoat");
    Parameter normal{{0.5F, 0.5F, 1.0F}, take(coat, "clearcoatNormalTexture", Transfer::linear, out)};
    const auto scale = static_cast<float>(coat.object("clearcoatNormalTexture").number("scale", 1.0));
    if (normal.texture && scale != 1.0F) {
        auto scaled = std::make_shared<Texture>(*normal.texture);
        std::vector<float>& rgb = std::get<Bitmap>(scaled->source).rgb;
        for (std::size_t i = 0; i < rgb.size(); ++i)
            if (i % 3 != 2) rgb[i] = 0.5F + scale * (rgb[i] - 0.5F);
        normal.texture = std::move(scaled);
    }
    if (!normal.texture && !has_normal_map) return {};
    return normal;
}

// Its direction is in the same tangent frame.
Parameter Materials::read_anisotropy(const Element& material, Appearance& out) {
    const Element anisotropy = material.extension("KHR_materials_anisotropy");
    const auto strength = static_cast<float>(anisotropy.number("anisotropyStrength", 0.0, unit));
    const double rotation = anisotropy.number("anisotropyRotation", 0.0);
    const auto texture = take(anisotropy, "anisotropyTexture", Transfer::linear, out);
    const auto c = static_cast<float>(std::cos(rotation)), s = static_cast<float>(std::sin(rotation));
    Parameter direction{{0.5F + 0.5F * c, 0.5F + 0.5F * s, strength}, nullptr};
    if (!texture || strength == 0.0F) return direction;
    auto turned = std::make_shared<Texture>(*texture);
    std::vector<float>& rgb = std::get<Bitmap>(turned->source).rgb;
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
        const float x = rgb[i] - 0.5F, y = rgb[i + 1] - 0.5F;
        rgb[i] = 0.5F + c * x - s * y;
        rgb[i + 1] = 0.5F + s * x + c * y;
        rgb[i + 2] *= strength;
    }
    direction.texture = std::move(turned);
    return direction;
}

int Materials::add(MaterialModel model, const std::string& name) {
    scene_.materials.push_back({std::move(model), name});
    return static_cast<int>(scene_.materials.size()) - 1;
}

Appearance Materials::read(const Element& material) {
    Appearance out;
    NormalMapped map = read_normal_map(material, out);
    const std::optional<Parameter> coat_normal = read_coat_normal(material, map.normals.texture != nullptr, out);
    const Parameter anisotropy = read_anisotropy(material, out);
    MaterialModel model = read_model(material, out);
    auto* layers = std::get_if<MetallicRoughness>(&model);
    const bool stretched = anisotropy.value.z > 0.0F;
    if (layers != nullptr) {
        layers->anisotropy = anisotropy;
        if (layers->clearcoat.value.x > 0.0F) layers->clearcoat_normal = coat_normal;
    } else if (stretched) {
        document_.warn(fmt::format("{}: {}: light that goes through a volume is spread alike in all directions", document_.file,
                                   material.path()));
    }
    if (!material.extension("KHR_materials_unlit").present()) read_emission(material, out);
    name_what_is_left_out(material);
    // What lets light through needs both of its sides.
    const bool unlit = std::holds_alternative<Diffuse>(model);
    out.single_sided = !material.flag("doubleSided", false) && (unlit || (layers != nullptr && layers->transmission.value.x == 0.0F));
    const std::string name = material.text("name", "material");
    const bool has_normal_map = map.normals.texture != nullptr && !unlit;
    const bool coated = layers != nullptr && layers->clearcoat_normal && layers->clearcoat_normal->texture;
    out.needs_tangents = has_normal_map || coated || (layers != nullptr && stretched);
    if (has_normal_map) {
        // Maps keep their frame when seen from behind; two sides inside turn it.
        const bool transmits = layers == nullptr || layers->transmission.value.x > 0.0F;
        map.nested = std::make_shared<Material>(Material{std::move(model), name});
        if (!transmits) map.nested = std::make_shared<Material>(Material{TwoSided{map.nested, map.nested}, name});
        model = std::move(map);
    }
    out.surface.front = out.surface.back = add(std::move(model), name);
    return out;
}

const SurfaceMaterial& Materials::mirrored(std::optional<std::size_t> material) {
    const auto [found, added] = mirrored_.try_emplace(material.value_or(default_material), appearance(material).surface);
    if (!added) return found->second;
    Material turned = scene_.materials[static_cast<std::size_t>(found->second.front)];
    turn_over(turned);
    found->second.front = found->second.back = add(std::move(turned.model), turned.name);
    return found->second;
}

void Materials::check() {
    textures_.check();
    for (std::size_t i = 0; i < document_.materials.size(); ++i) appearance(i);
    textures_.check_unused();
}

const Appearance& Materials::appearance(std::optional<std::size_t> material) {
    const std::size_t key = material.value_or(default_material);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    const Element absent{nullptr, "/materials", &document_.faults};
    return known_.emplace(key, read(material ? document_.materials[*material] : absent)).first->second;
}

}  // namespace wavelobe::gltf
