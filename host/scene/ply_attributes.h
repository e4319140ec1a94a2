// Values of PLY files beside positions, normals and texture coordinates, by the names that Mitsuba gives them.
#pragma once

#include <string>
#include <vector>

#include "scene/ply_header.h"

namespace wavelobe::ply {

// The columns of an attribute such as `vertex_color`, `kind` being what its name starts with: one or three, one behind the
// other. Empty where the element has none of that name.
std::vector<std::size_t> find_attribute(const Element& element, const std::string& kind, const std::string& name);

}  // namespace wavelobe::ply
