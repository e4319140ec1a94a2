// Instances as the kernels see them.
#pragma once

#include "render/flatten.h"

namespace wavelobe {

// Throws InputError where the map has no inverse.
DeviceInstance device_instance(const glm::mat4& to_world, std::uint32_t group);

// World-space bounds of a box under the map, with room for the rounding of both ways.
Bounds instance_bounds(const glm::mat4& to_world, const Bounds& box);

// Of the triangles and analytic shapes of a group or the world.
Bounds bounds_of_range(const DeviceScene& scene, const GeometryRange& range);

}  // namespace wavelobe
