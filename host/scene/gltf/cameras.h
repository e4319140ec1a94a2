// Cameras, and the view a file without one gets.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/scene.h"

namespace wavelobe::gltf {

struct PictureSize {
    int width = 0;  // 0: the camera's aspect ratio decides
    int height = 0;
};

// Fills camera and film. The first perspective camera among the nodes shown is used; without one the bounding box of the
// scene's shapes is framed from the front, which is +Z in glTF.
void place_camera(Document& document, const NodeTree& tree, const PictureSize& size, Scene& scene);

}  // namespace wavelobe::gltf
