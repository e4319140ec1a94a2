#include <algorithm>
#include <array>
#include <numeric>

#include "accel/bvh.h"

namespace wavelobe {
namespace {

double half_area_of_box(const BvhNode& node, unsigned child) {
    const glm::dvec3 e(node.bounds[1][child] - node.bounds[0][child], node.bounds[3][child] - node.bounds[2][child],
                       node.bounds[5][child] - node.bounds[4][child]);
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

}  // namespace

void order_children(Bvh& bvh) {
    for (BvhNode& node : bvh.nodes) {
        const auto count = std::ranges::find(node.child, BVH_EMPTY) - std::begin(node.child);
        std::array<unsigned, BVH_WIDTH> order{};
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.begin() + count,
                         [&](unsigned a, unsigned b) { return half_area_of_box(node, a) < half_area_of_box(node, b); });
        const BvhNode before = node;
        for (unsigned i = 0; i < BVH_WIDTH; ++i) {
            for (unsigned row = 0; row < 6; ++row) node.bounds[row][i] = before.bounds[row][order[i]];
            node.child[i] = before.child[order[i]];
        }
    }
}

}  // namespace wavelobe
