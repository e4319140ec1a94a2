// Builds the eight-wide bounding volume hierarchy that kernels/shapes/traversal.h walks.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <vector>

#include <glm/glm.hpp>

#include "shared/bvh.h"

namespace wavelobe {

using TriangleVertices = std::array<glm::vec3, 3>;

struct Bounds {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void extend(const glm::vec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
};

struct Bvh {
    std::vector<BvhNode> nodes;  // the root is node 0
    std::vector<TriangleBlock> blocks;
    std::vector<std::uint32_t> analytic_order;  // indices of analytic shapes, run by run
    int depth = 1;                              // levels of nodes
    double build_seconds = 0.0;
};

// `best` is the one of the others that the surface-area heuristic prefers: on few or large triangles splits often do not pay.
enum class BvhQuality { fast, split, best };

// Told what share of the work is done, now and then, by any thread but one at a time; false stops it.
using BuildProgress = std::function<bool(double share)>;

struct BuildStopped : std::runtime_error {
    BuildStopped() : std::runtime_error("the building of the hierarchy was stopped") {}
};

// Topology from Embree's public builder: surface-area heuristic, with spatial splits for `split`.
// Primitive ids in leaves index `triangles`. `analytic_bounds` must contain their shapes with room for rounding.
// Throws std::runtime_error if the builder fails, BuildStopped where `progress` asks for it.
Bvh build_bvh(std::span<const TriangleVertices> triangles, std::span<const Bounds> analytic_bounds, BvhQuality quality,
              int threads, std::span<const Bounds> instance_bounds = {}, const BuildProgress& progress = {});

// Puts the children of each node in the order of their boxes' areas: any-hit traversal, which does not sort, visits the last one first,
// and a ray is likeliest to be blocked in the largest.
void order_children(Bvh& bvh);

// How many rays without anything in common are best traced in turn (kernels/shapes/walks.h): several through a hierarchy that
// does not stay in the caches, else one.
int walks_in_turn(const Bvh& bvh);

// Nodes and blocks that a random line through the root's bounds is expected to meet (Goldsmith, Salmon 1987, "Automatic
// Creation of Object Hierarchies for Ray Tracing"): both take about as long.
double expected_steps(const Bvh& bvh);

// Adds the hierarchy of a group, whose triangles and analytic shapes are numbered from these on, and returns its root.
std::uint32_t append_bvh(Bvh& all, const Bvh& group, std::uint32_t first_triangle, std::uint32_t first_analytic);

}  // namespace wavelobe
