// Materials of a glTF document.
#pragma once

#include <map>

#include "scene/gltf/textures.h"

namespace wavelobe::gltf {

// What a shape takes from its material.
struct Appearance {
    SurfaceMaterial surface;
    std::optional<AreaEmitter> emitter;
    bool needs_tangents = false;  // for a normal map, or stretched highlights
    bool single_sided = false;  // its back is not shown
    bool is_volume = false;     // light goes on inside of it
    int medium = -1;            // that absorbs there
    bool blends = false;  // alpha, that of vertices too, says how much of it is there
    std::vector<std::int64_t> uv_sets{};  // that its textures look up: the first, and the second
};

class Materials {
public:
    Materials(Document& document, Scene& scene) : document_(document), scene_(scene), textures_(document) {}

    // Checks all materials and textures, also those that nothing shows.
    void check();
    // The material of that number, or the specification's default.
    const Appearance& appearance(std::optional<std::size_t> material);

    // What triangles with mirrored tangents show of a material that needs them: turned over across them.
    const SurfaceMaterial& mirrored(std::optional<std::size_t> material);

private:
    Appearance read(const Element& material);
    NormalMapped read_normal_map(const Element& material, Appearance& out);
    std::optional<Parameter> read_coat_normal(const Element& material, bool has_normal_map, Appearance& out);
    Parameter read_anisotropy(const Element& material, Appearance& out);
    int add(MaterialModel model, const std::string& name);
    void read_emission(const Element& material, Appearance& out);
    void read_alpha(const Element& material, float factor, Appearance& out);
    MaterialModel read_model(const Element& material, Appearance& out);
    Parameter read_scalar(const Element& owner, const char* factor, double fallback, const char* texture, Transfer transfer, int channel, Appearance& out);
    void read_layers(const Element& material, MetallicRoughness& model, Appearance& out);
    std::optional<MaterialModel> read_volume(const Element& material, const MetallicRoughness& surface, Appearance& out);
    // The texture that member `name` of `owner` refers to, scaled, and with it the set of coordinates it looks up.
    std::shared_ptr<const Texture> take(const Element& owner, const char* name, Transfer transfer, Appearance& out, const Rgb& factor = Rgb(1.0F));
    void name_what_is_left_out(const Element& material);

    Document& document_;
    Scene& scene_;
    Textures textures_;
    std::map<std::size_t, Appearance> known_;
    std::map<std::size_t, SurfaceMaterial> mirrored_;
};

}  // namespace wavelobe::gltf
