// Back faces of single-sided materials, which glTF does not show.
#pragma once

#include "scene/scene.h"

namespace wavelobe::gltf {

// Whether a mesh is closed and faces outwards: nobody outside it sees a back.
bool is_closed(const TriangleMesh& mesh);

// Lets paths pass the backs of the listed shapes, but for those that nobody sees.
void clear_backs(Scene& scene, const std::vector<std::size_t>& shapes);

}  // namespace wavelobe::gltf
