// Materials of a glTF document.
#pragma once

#include <map>

#include "scene/gltf/textures.h"

namespace wavelobe::gltf {

// What a shape takes from its material.
struct Appearance {
    SurfaceMaterial surface;
    std::optional<AreaEmitter> emitter;
    std::int64_t uv_set = 0;  // of all its textures
};

class Materials {
public:
    Materials(Document& document, Scene& scene) : document_(document), scene_(scene), textures_(document) {}

    // Checks all materials and textures, also those that nothing shows.
    void check();
    // The material of that number, or the specification's default.
    const Appearance& appearance(std::optional<std::size_t> material);

private:
    Appearance read(const Element& material);
    void read_emission(const Element& material, Appearance& out);
    void read_alpha(const Element& material, float factor, Appearance& out);
    MaterialModel read_model(const Element& material, Appearance& out);
    std::optional<MaterialModel> read_transmission(const Element& material, const MetallicRoughness& surface, Appearance& out);
    // Takes over a texture, and the set of coordinates it looks up.
    std::shared_ptr<const Texture> take(const Element& owner, const char* name, const TextureUse& use, Appearance& out);
    void name_what_is_left_out(const Element& material);

    Document& document_;
    Scene& scene_;
    Textures textures_;
    std::map<std::size_t, Appearance> known_;
    bool uv_chosen_ = false;  // by a texture of the material that is being read
};

}  // namespace wavelobe::gltf
