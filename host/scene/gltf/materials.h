// Materials of a glTF document.
#pragma once

#include <map>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace wavelobe::gltf {

// What a shape takes from its material.
struct Appearance {
    SurfaceMaterial surface;
    std::optional<AreaEmitter> emitter;
};

class Materials {
public:
    Materials(Document& document, Scene& scene) : document_(document), scene_(scene) {}

    // Checks all materials, also those that nothing shows.
    void check();
    // The material of that number, or the specification's default; put into the scene the first time it is asked for.
    const Appearance& appearance(std::optional<std::size_t> material);

private:
    Appearance read(const Element& material);

    Document& document_;
    Scene& scene_;
    std::map<std::size_t, Appearance> known_;
};

}  // namespace wavelobe::gltf
