// Scenes so small that testing every triangle beats a hierarchy (kernels/shapes/few_triangles.h).
#pragma once

#include <span>
#include <vector>

#include "accel/bvh.h"

namespace wavelobe {

struct FewTriangleSet {
    std::vector<float> vertices;  // 3 each, distinct, in the unit of the summary
    std::vector<FewTriangle> triangles;
    std::vector<FewFacet> facets;
    std::vector<float> corners;  // FEW_CORNER_ROWS rows of all facets, in that unit too
    std::vector<std::uint32_t> numbers;  // facet of each triangle by its number, or FACET_NONE
    std::vector<FewAnalytic> analytics;
    FewSummary summary{};
};

// The triangles of a hierarchy, each once, naming the slots where the hierarchy keeps them, and its analytic shapes, whose
// bounds are given by number. Empty when there are too many of either, or no triangles.
FewTriangleSet find_few_triangles(const Bvh& bvh, std::span<const Bounds> analytic_bounds = {});

}  // namespace wavelobe
