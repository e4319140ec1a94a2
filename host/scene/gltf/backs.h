// Back faces of single-sided materials, which glTF does not show.
#pragma once

#include "scene/scene.h"

namespace wavelobe::gltf {

// Whether a mesh is closed and faces outwards: nobody outside it sees a back.
bool is_closed(const TriangleMesh& mesh);

// Leaves out of the listed shapes what shows the camera nothing but backs: all that hangs together, by vertices at the same places,
// and does not shine. Returns the number of triangles.
std::size_t leave_out_backs(Scene& scene, const std::vector<std::size_t>& shapes);

// Lets the camera see through the backs of the listed shapes, but for those that nobody sees.
void clear_backs(Scene& scene, const std::vector<std::size_t>& shapes);

}  // namespace wavelobe::gltf
