// Reads glTF 2.0, text and binary, into the neutral scene.
#pragma once

#include <string>

#include "scene/scene.h"

namespace wavelobe {

struct GltfOptions {
    int width = 0;  // of the picture; 0: what the camera's aspect ratio makes of 1280 x 720
    int height = 0;
};

// Throws InputError with every fault found in the file and the files it names.
Scene read_gltf_scene(const std::string& path, const GltfOptions& options = {});

// Whether the file is glTF, by its name's ending or its first bytes.
bool is_gltf(const std::string& path);

}  // namespace wavelobe
