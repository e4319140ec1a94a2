// Reads Mitsuba 3 XML scenes into the neutral scene.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"

namespace wavelobe {

// `-D NAME=VALUE` definitions override `<default>`.
using Definitions = std::map<std::string, std::string>;

// Throws InputError with every fault found in the scene and the files it names.
Scene read_mitsuba_scene(const std::string& path, const Definitions& definitions = {});

}  // namespace wavelobe
