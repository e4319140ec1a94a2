#include "accel/few_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "accel/few_facets.h"

namespace wavelobe {
namespace {

// Brings the vertices to the unit of the set.
void summarize(FewTriangleSet& few) {
    Bounds bounds;
    for (std::size_t i = 0; i < few.vertices.size(); i += 3) {
        bounds.extend({few.vertices[i], few.vertices[i + 1], few.vertices[i + 2]});
    }
    const glm::dvec3 lower = bounds.lower;
    const glm::dvec3 upper = bounds.upper;
    const glm::dvec3 center = 0.5 * (lower + upper);
    // Larger than from the rounded center to any corner.
    const double radius = 0.5 * glm::length(upper - lower) * (1 + 1e-6) + 1e-6 * glm::length(center);
    const double per_length = std::ldexp(1.0, std::clamp(-std::ilogb(std::max(radius, 1e-37)), -100, 100));
    for (float& coordinate : few.vertices) coordinate *= static_cast<float>(per_length);
    FewSummary& s = few.summary;
    for (glm::length_t i = 0; i < 3; ++i) s.center[i] = static_cast<float>(center[i] * per_length);
    s.radius = static_cast<float>(radius * per_length);
    s.per_length = static_cast<float>(per_length);
    s.triangle_count = static_cast<std::uint32_t>(few.triangles.size());
    s.vertex_count = static_cast<std::uint32_t>(few.vertices.size() / 3);
    s.analytic_count = static_cast<std::uint32_t>(few.analytics.size());
}

void add_analytics(FewTriangleSet& few, const Bvh& bvh, std::span<const Bounds> bounds) {
    std::set<std::uint32_t> seen;
    for (const std::uint32_t entry : bvh.analytic_order) {
        if (!seen.insert(entry).second) continue;
        const Bounds& box = bounds[entry & ~PRIMITIVE_MASKED];
        few.analytics.push_back({{box.lower.x, box.lower.y, box.lower.z}, {box.upper.x, box.upper.y, box.upper.z}, entry});
    }
}

}  // namespace

FewTriangleSet find_few_triangles(const Bvh& bvh, std::span<const Bounds> analytic_bounds) {
    FewTriangleSet few;
    std::map<std::array<float, 3>, std::uint32_t> known;
    std::set<std::uint32_t> seen;  // spatial splits put a triangle into several leaves
    if (analytic_bounds.size() > FEW_ANALYTIC_MAX || bvh.blocks.size() > FEW_TRIANGLES_MAX) return {};
    for (std::size_t b = 0; b < bvh.blocks.size(); ++b) {
        const TriangleBlock& block = bvh.blocks[b];
        for (std::uint32_t lane = 0; lane < BVH_WIDTH; ++lane) {
            FewTriangle triangle{};
            triangle.slot = static_cast<std::uint32_t>(b) * BVH_WIDTH + lane;
            triangle.primitive = block.primitive[lane];
            bool present = false;  // absent triangles are all zero
            std::array<std::array<float, 3>, 3> corners{};
            for (std::size_t row = 0; row < 9; ++row) {
                corners[row / 3][row % 3] = block.vertex[row][lane];
                present = present || block.vertex[row][lane] != 0.0F;
            }
            if (!present || !seen.insert(block.primitive[lane]).second) continue;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto [vertex, added] = known.try_emplace(corners[i], static_cast<std::uint32_t>(known.size()));
                if (added) few.vertices.insert(few.vertices.end(), corners[i].begin(), corners[i].end());
                triangle.corner[i] = vertex->second;
            }
            few.triangles.push_back(triangle);
        }
    }
    // Of two at the same distance the one that comes first is hit: that shall not depend on the hierarchy.
    std::ranges::sort(few.triangles, {}, [](const FewTriangle& t) { return t.primitive & ~PRIMITIVE_MASKED; });
    if (few.triangles.size() > FEW_TRIANGLES_MAX || known.size() > FEW_VERTICES_MAX) return {};
    if (few.triangles.empty()) return {};
    add_analytics(few, bvh, analytic_bounds);
    summarize(few);
    add_facets(few);
    return few;
}

}  // namespace wavelobe
