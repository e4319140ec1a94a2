// KHR_draco_mesh_compression: primitives whose triangles and attributes are packed by Google's Draco.
#pragma once

#include <map>
#include <optional>

#include "scene/gltf/accessor.h"

namespace wavelobe::gltf {

struct UnpackedPrimitive {
    std::map<std::string, std::vector<float>> attributes;  // by name, element by element, as their accessors describe them
    std::vector<std::uint32_t> indices;                    // three a triangle
};

// What the extension of a primitive holds; nothing where it has none, or after a fault.
std::optional<UnpackedPrimitive> unpack_draco(Document& document, const Accessors& accessors, const Element& primitive);

}  // namespace wavelobe::gltf
