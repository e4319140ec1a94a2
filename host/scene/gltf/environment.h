// The environment of scenes that bring no light.
#pragma once

#include "scene/scene.h"

namespace wavelobe::gltf {

// A grey studio: a floor of medium brightness, a brighter ceiling, a large softbox to the upper left of +Z and a fill to the
// right. Its mean radiance is about one, so that white surfaces come out nearly white.
EnvironmentMap studio_environment();

}  // namespace wavelobe::gltf
