// Media of the neutral scene: what fills space.
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace wavelobe {

using Rgb = glm::vec3;

// Absorbs and does not scatter: after a distance d through it exp(-absorption * d) of the light is left.
struct Medium {
    Rgb absorption{0.0F};  // 1 / m
    std::string name;
};

// What lies on the two sides of a shape: indices into Scene::media, or -1 for vacuum. A ray that leaves the shape is in what
// is on its side, whatever it was in before.
struct MediumBoundary {
    int interior = -1;  // behind the geometric normal
    int exterior = -1;
};

}  // namespace wavelobe
