#include "tables/light_tree.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "support/light_tree_reference.h"

namespace wavelobe::test {
namespace {

glm::dvec3 unpacked(const Packed3& v) { return {v.x, v.y, v.z}; }

// Every light of a subtree lies in the node's sphere and cone, and their intensities add up to the node's.
struct Totals {
    std::size_t lights = 0;
    double intensity = 0.0;
};

Totals check_bounds(const LightTree& tree, std::span<const LightBounds> lights, std::size_t top, std::size_t node) {
    const Uint32 child = tree.nodes[node].child;
    if ((child & LIGHT_LEAF) == 0) {
        const Totals a = check_bounds(tree, lights, top, child);
        const Totals b = check_bounds(tree, lights, top, child + 1);
        return {a.lights + b.lights, a.intensity + b.intensity};
    }
    const LightBounds& light = lights[child & ~LIGHT_LEAF];
    const LightNode& n = tree.nodes[top];
    if (light.intensity > 0.0) {
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p((corner & 1) != 0 ? light.upper.x : light.lower.x,
                               (corner & 2) != 0 ? light.upper.y : light.lower.y,
                               (corner & 4) != 0 ? light.upper.z : light.lower.z);
            EXPECT_LE(glm::length(p - unpacked(n.center)), static_cast<double>(n.radius) * (1.0 + 1e-6) + 1e-5);
        }
        const double spread = std::atan2(static_cast<double>(n.sin_spread), static_cast<double>(n.cos_spread));
        EXPECT_LE(std::min(angle_between(light.axis, unpacked(n.axis)) + light.spread, std::numbers::pi), spread + 1e-5);
        EXPECT_LE(static_cast<double>(n.cos_emission), std::cos(light.emission) + 1e-6);
    }
    return {1, light.intensity};
}

TEST(LightTree, NodesBoundTheirLights) {
    std::vector<LightBounds> lights = random_lights(200, 3);
    lights[7].intensity = lights[8].intensity = 0.0;
    const LightTree tree = build_light_tree(lights);
    EXPECT_EQ(tree.nodes.size(), 2 * lights.size() - 1);
    EXPECT_EQ(check_bounds(tree, lights, 0, 0).lights, lights.size());
    for (std::size_t node = 0; node < tree.nodes.size(); ++node) {
        const Totals totals = check_bounds(tree, lights, node, node);
        EXPECT_NEAR(static_cast<double>(tree.nodes[node].intensity), totals.intensity, 1e-6 * totals.intensity);
    }
}

TEST(LightTree, TrailsLeadToTheirLights) {
    for (const std::size_t count : {1U, 2U, 3U, 1000U}) {
        const std::vector<LightBounds> lights = random_lights(count, 4);
        const LightTree tree = build_light_tree(lights);
        for (std::size_t i = 0; i < count; ++i) {
            Uint32 trail = tree.trails[i];
            Uint32 child = tree.nodes[0].child;
            for (; (child & LIGHT_LEAF) == 0; trail >>= 1) child = tree.nodes[child + (trail & 1U)].child;
            EXPECT_EQ(child & ~LIGHT_LEAF, i);
            EXPECT_EQ(trail, 0U);
        }
    }
}

// Lights ever closer to a point would give one level each; lights in one place none to split by.
TEST(LightTree, IsNeverDeeperThanATrail) {
    std::vector<LightBounds> lights = random_lights(3000, 5);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double x = i < 1000 ? std::exp2(-static_cast<double>(i)) : 0.25;
        lights[i].lower = lights[i].upper = glm::dvec3(x, 0.0, 0.0);
    }
    const LightTree tree = build_light_tree(lights);
    EXPECT_LE(tree.depth, 32);
    EXPECT_GT(tree.depth, 12);
    EXPECT_EQ(tree.nodes.size(), 2 * lights.size() - 1);
}

// From anywhere, the probabilities add up to one, or to what is lost in subtrees where bounds promised more than there is.
TEST(LightTree, ProbabilitiesAddUp) {
    const std::vector<LightBounds> lights = random_lights(300, 6);
    const LightTree tree = build_light_tree(lights);
    for (const glm::dvec3& p : {glm::dvec3(0.0), glm::dvec3(30.0, 2.0, 1.0), glm::dvec3(3.0, -9.0, 4.0)}) {
        double sum = 0.0;
        for (const Uint32 trail : tree.trails) sum += reference_probability(tree.nodes, trail, ReferenceReceiver{p, {}});
        EXPECT_LE(sum, 1.0 + 1e-12);
        EXPECT_GT(sum, 0.5);
    }
}

// A near light is likelier than a far one of the same power, and one that looks away has no chance.
TEST(LightTree, FollowsDistanceAndDirection) {
    std::vector<LightBounds> lights(3);
    const double places[] = {1.0, 10.0, 2.0};
    for (std::size_t i = 0; i < 3; ++i) {
        lights[i].lower = lights[i].upper = glm::dvec3(0.0, places[i], 0.0);
        lights[i].axis = {0.0, i == 2 ? 1.0 : -1.0, 0.0};
        lights[i].emission = 0.5 * std::numbers::pi;
        lights[i].intensity = 1.0;
    }
    const LightTree tree = build_light_tree(lights);
    const glm::dvec3 up(0.0, 1.0, 0.0);
    const double near = reference_probability(tree.nodes, tree.trails[0], ReferenceReceiver{glm::dvec3(0.0), up});
    const double far = reference_probability(tree.nodes, tree.trails[1], ReferenceReceiver{glm::dvec3(0.0), up});
    EXPECT_GT(near, 0.5);
    EXPECT_GT(near, 10.0 * far);
    EXPECT_EQ(reference_probability(tree.nodes, tree.trails[2], ReferenceReceiver{glm::dvec3(0.0), up}), 0.0);
    EXPECT_EQ(reference_probability(tree.nodes, tree.trails[0], ReferenceReceiver{glm::dvec3(0.0), -up}), 0.0);
}

TEST(LightTree, IsTheSameForTheSameLights) {
    const std::vector<LightBounds> lights = random_lights(500, 7);
    const LightTree a = build_light_tree(lights);
    const LightTree b = build_light_tree(lights);
    EXPECT_EQ(a.trails, b.trails);
    EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(LightNode)), 0);
}

TEST(LightTree, IsEmptyWithoutLights) { EXPECT_TRUE(build_light_tree({}).nodes.empty()); }

}  // namespace
}  // namespace wavelobe::test
