#include "scene/gltf/materials.h"

namespace wavelobe::gltf {

namespace {

constexpr std::size_t default_material = static_cast<std::size_t>(-1);
constexpr NumberRange unit{0.0, 1.0};

Rgb rgb(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

Appearance Materials::read(const Element& material) {
    const Element pbr = material.object("pbrMetallicRoughness");
    const auto base = pbr.vector<4>("baseColorFactor", {1, 1, 1, 1}, unit);
    MetallicRoughness model;
    model.base_color.value = {base[0], base[1], base[2]};
    model.metallic.value = Rgb(static_cast<float>(pbr.number("metallicFactor", 1.0, unit)));
    model.roughness.value = Rgb(static_cast<float>(pbr.number("roughnessFactor", 1.0, unit)));

    Appearance out;
    const Rgb emission = rgb(material.vector<3>("emissiveFactor", {0, 0, 0}, unit));
    if (emission != Rgb(0.0F)) out.emitter = AreaEmitter{{emission, nullptr}};
    const std::string mode = material.text("alphaMode", "OPAQUE");
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
        material.fault("alphaMode `" + mode + "`; expected OPAQUE, MASK or BLEND");
    material.number("alphaCutoff", 0.5, {0.0, 1e30});
    material.flag("doubleSided", false);
    // Paths have no faces to cull: both sides show the material, whatever `doubleSided` says.
    out.surface.front = out.surface.back = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back({model, material.text("name", "material")});
    return out;
}

void Materials::check() {
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
