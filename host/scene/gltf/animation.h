// Animations: where nodes stand at a time.
#pragma once

#include "scene/gltf/accessor.h"
#include "scene/gltf/nodes.h"

namespace wavelobe::gltf {

// Checks all animations; with a time in seconds the first of them moves the nodes of the tree.
void animate(Document& document, const Accessors& accessors, std::optional<double> time, NodeTree& tree);

}  // namespace wavelobe::gltf
