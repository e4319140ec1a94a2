// Where points of the world are for the camera and on the film, as matrices for column vectors.
#pragma once

#include "scene/scene.h"

namespace wavelobe {

// Camera space with x right, y up, z forward.
glm::dmat4 world_to_camera(const Camera& camera);
// (0, 0) is the upper left corner of the film, (1, 1) the lower right one; z is 0 in the near plane and 1 in the far one.
glm::dmat4 world_to_ndc(const Camera& camera, const Film& film);

}  // namespace wavelobe
