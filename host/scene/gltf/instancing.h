// EXT_mesh_gpu_instancing.
#pragma once

#include "scene/gltf/accessor.h"
#include "scene/gltf/nodes.h"

namespace wavelobe::gltf {

// Where the node's mesh stands, against the node: once at the identity without the extension.
std::vector<glm::dmat4> instances_of(Document& document, const Accessors& accessors, std::size_t node);

}  // namespace wavelobe::gltf
