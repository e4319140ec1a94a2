// KHR_lights_punctual.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/scene.h"

namespace wavelobe::gltf {

// Adds the lights of the nodes shown. Lumens are taken as watts: radiance one is what a display shows white.
void add_punctual_lights(Document& document, const NodeTree& tree, Scene& scene);

}  // namespace wavelobe::gltf
