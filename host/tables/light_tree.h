// A tree over the lights that have a place, by which a light is chosen for a point: at each node the point's bounds on what each
// of up to eight parts could send it decide. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting"; the binary tree of theirs, its dearest nodes opened until there are eight side by side.
// kernels/lights/light_tree.h walks it.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/lights.h"

namespace wavelobe {

// Where a light is, where it shines, and how bright it is.
struct LightBounds {
    glm::dvec3 lower{0.0};
    glm::dvec3 upper{0.0};
    glm::dvec3 axis{0.0, 0.0, 1.0};  // unit; of the cone that holds all its normals
    double spread = 0.0;             // half angle of that cone, rad; pi: all directions
    double emission = 0.0;           // it emits up to this angle off each normal, rad
    double intensity = 0.0;          // the greatest, W / sr, weighted by luminance
};

// The smallest cone about both (nearly: exact but for the order of unions).
LightBounds light_bounds_union(const LightBounds& a, const LightBounds& b);

struct LightTree {
    // The root first. Empty without lights.
    std::vector<LightNode> nodes;
    std::vector<Uint32> places;  // of each light: LIGHT_PLACE of its leaf
    int depth = 0;               // nodes on the longest way, 32 at the most
};

// The same lights give the same tree. At most 2^28 lights.
LightTree build_light_tree(std::span<const LightBounds> lights);

}  // namespace wavelobe
