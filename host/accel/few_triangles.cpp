#include "accel/few_triangles.h"

#include <array>
#include <map>
#include <set>

namespace wavelobe {

FewTriangleSet find_few_triangles(const Bvh& bvh) {
    FewTriangleSet few;
    std::map<std::array<float, 3>, std::uint32_t> known;
    std::set<std::uint32_t> seen;  // spatial splits put a triangle into several leaves
    if (!bvh.analytic_order.empty() || bvh.blocks.size() > FEW_TRIANGLES_MAX) return {};
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
    if (few.triangles.size() > FEW_TRIANGLES_MAX || known.size() > FEW_VERTICES_MAX) return {};
    return few;
}

}  // namespace wavelobe
