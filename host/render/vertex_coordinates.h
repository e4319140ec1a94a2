// Texture coordinates of meshes as the kernels gather them.
#pragma once

#include "render/flatten.h"

namespace wavelobe {

// An offset into vertex data; throws InputError beyond what kernels can gather by.
std::uint32_t vertex_offset(std::size_t value, const Shape& shape);

// Both sets of coordinates of the corners of a mesh's triangles and, where rays ask for the shape's opacity, those of its
// vertices. The record of that opacity is the scene's last.
void add_vertex_coordinates(const Shape& shape, const TriangleMesh& mesh, DeviceShape& record, DeviceScene& out);

}  // namespace wavelobe
