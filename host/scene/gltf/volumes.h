// Volumes that absorb (KHR_materials_volume): media, and the shapes that part them.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/gltf/element.h"
#include "scene/scene.h"

namespace wavelobe::gltf {

// What the extension says of light inside: after its `attenuationDistance` its `attenuationColor` is left.
Rgb absorption_of(const Element& volume);

// A shape around a volume.
struct Volume {
    std::size_t shape = 0;
    int medium = -1;  // -1: does not absorb
};

// Lets the shapes part media: outside of each is the smallest other volume around it, and so of the camera. Shapes that are only
// partly there part none, which is said in the scene's warnings.
void part_media(Scene& scene, const std::vector<Volume>& volumes);

}  // namespace wavelobe::gltf
