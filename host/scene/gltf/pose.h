// Morph targets and skins: the vertices of a primitive in their pose.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/gltf/primitive.h"

namespace wavelobe::gltf {

// Adds the deltas of the targets, weighted; targets beyond the weights count nothing.
void morph(Primitive& primitive, const std::vector<double>& weights);

// The matrices of a skin's joints, world after inverse bind; empty after a fault.
std::vector<glm::dmat4> joint_matrices(Document& document, const Accessors& accessors, std::size_t skin, const NodeTree& tree);

// Moves the vertices into the world by their joints.
void bend(Document& document, const std::vector<glm::dmat4>& joints, const std::string& path, Primitive& primitive);

}  // namespace wavelobe::gltf
