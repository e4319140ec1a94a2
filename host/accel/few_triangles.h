// Scenes so small that testing every triangle beats a hierarchy (kernels/shapes/few_triangles.h).
#pragma once

#include <vector>

#include "accel/bvh.h"

namespace wavelobe {

struct FewTriangleSet {
    std::vector<float> vertices;  // 3 each, distinct, in the unit of the summary
    std::vector<FewTriangle> triangles;
    FewSummary summary{};
};

// The triangles of a hierarchy, each once, naming the slots where the hierarchy keeps them. Empty when there are too many, or
// when there are shapes that are not triangles.
FewTriangleSet find_few_triangles(const Bvh& bvh);

}  // namespace wavelobe
