#include "tables/light_tree.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "support/light_tree_reference.h"

namespace wavelobe::test {
namespace {

// All children of all nodes.
template <class Visit>
void for_each_child(const LightTree& tree, const Visit& visit) {
    for (std::size_t node = 0; node < tree.nodes.size(); ++node) {
        for (std::size_t i = 0; i < LIGHT_CHILDREN; ++i) visit(node, i);
    }
}

std::vector<Uint32> lights_below(const LightTree& tree, Uint32 child) {
    if ((child & LIGHT_LEAF) != 0) return {child & ~LIGHT_LEAF};
    std::vector<Uint32> below;
    const LightNode& n = tree.nodes[child];
    for (std::size_t i = 0; i < LIGHT_CHILDREN; ++i) {
        if (!(n.intensity[i] > 0.0F)) continue;
        const std::vector<Uint32> some = lights_below(tree, n.child[i]);
        below.insert(below.end(), some.begin(), some.end());
    }
    return below;
}

void expect_bounded(const LightBounds& light, const LightNode& n, std::size_t i) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? light.upper.x : light.lower.x,
                           (corner & 2) != 0 ? light.upper.y : light.lower.y,
                           (corner & 4) != 0 ? light.upper.z : light.lower.z);
        const glm::dvec3 c(n.center_x[i], n.center_y[i], n.center_z[i]);
        EXPECT_LE(glm::length(p - c), static_cast<double>(n.radius[i]) * (1.0 + 1e-6) + 1e-5);
    }
    const double spread = std::atan2(static_cast<double>(n.sin_spread[i]), static_cast<double>(n.cos_spread[i]));
    const glm::dvec3 axis(n.axis_x[i], n.axis_y[i], n.axis_z[i]);
    EXPECT_LE(std::min(angle_between(light.axis, axis) + light.spread, std::numbers::pi), spread + 1e-5);
    EXPECT_LE(static_cast<double>(n.cos_emission[i]), std::cos(light.emission) + 1e-6);
}

// Every light below a child lies in its sphere and cone, and their intensities add up to the child's.
TEST(LightTree, ChildrenBoundTheirLights) {
    std::vector<LightBounds> lights = random_lights(200, 3);
    lights[7].intensity = lights[8].intensity = 0.0;
    double all = 0.0;
    for (const LightBounds& light : lights) all += light.intensity;
    const LightTree tree = build_light_tree(lights);
    EXPECT_LT(tree.nodes.size(), lights.size() / 2) << "nodes hold more than two";
    EXPECT_EQ(lights_below(tree, 0).size(), lights.size() - 2);
    for_each_child(tree, [&](std::size_t node, std::size_t i) {
        const LightNode& n = tree.nodes[node];
        if (!(n.intensity[i] > 0.0F)) return;
        double sum = 0.0;
        for (const Uint32 light : lights_below(tree, n.child[i])) {
            expect_bounded(lights[light], n, i);
            sum += lights[light].intensity;
        }
        EXPECT_NEAR(static_cast<double>(n.intensity[i]), sum / all, 1e-6 * sum / all);
    });
}

TEST(LightTree, PlacesAreThoseOfTheLights) {
    for (const std::size_t count : {1U, 2U, 3U, 8U, 9U, 1000U}) {
        const LightTree tree = build_light_tree(random_lights(count, 4));
        ASSERT_EQ(tree.places.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            Uint32 place = tree.places[i];
            Uint32 child = LIGHT_LEAF | static_cast<Uint32>(i);
            for (; place != LIGHT_ROOT; place = tree.nodes[child].place) {
                const Uint32 node = place / LIGHT_CHILDREN;
                ASSERT_EQ(tree.nodes[node].child[place % LIGHT_CHILDREN], child);
                child = node;
            }
            EXPECT_EQ(child, 0U);
        }
    }
}

// Lights ever closer to a point would give a level for each few; lights in one place none to split by.
TEST(LightTree, IsNeverDeeperThanTheWalk) {
    std::vector<LightBounds> lights = random_lights(3000, 5);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double x = i < 1000 ? std::exp2(-static_cast<double>(i)) : 0.25;
        lights[i].lower = lights[i].upper = glm::dvec3(x, 0.0, 0.0);
    }
    const LightTree tree = build_light_tree(lights);
    EXPECT_LE(tree.depth, 32);
    EXPECT_GT(tree.depth, 3);
    EXPECT_EQ(lights_below(tree, 0).size(), lights.size());
}

// From anywhere, the probabilities add up to one, or to what is lost in subtrees where bounds promised more than there is.
TEST(LightTree, ProbabilitiesAddUp) {
    const std::vector<LightBounds> lights = random_lights(300, 6);
    const LightTree tree = build_light_tree(lights);
    for (const glm::dvec3& p : {glm::dvec3(0.0), glm::dvec3(30.0, 2.0, 1.0), glm::dvec3(3.0, -9.0, 4.0)}) {
        double sum = 0.0;
        for (const Uint32 place : tree.places) sum += reference_probability(tree.nodes, place, ReferenceReceiver{p, {}});
        EXPECT_LE(sum, 1.0 + 1e-12);
        EXPECT_GT(sum, 0.5);
    }
}

// Wherever a place on a light shines on a receiver, the light has a chance there.
TEST(LightTree, ForgetsNoLightThatShines) {
    const std::vector<LightBounds> lights = random_lights(300, 8);
    const LightTree tree = build_light_tree(lights);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto anywhere = [&](double size) { return size * glm::dvec3(unit(random), unit(random), unit(random)); };
    int shining = 0;
    for (int i = 0; i < 200000; ++i) {
        const std::size_t light = static_cast<std::size_t>(i) % lights.size();
        const LightBounds& b = lights[light];
        const glm::dvec3 from = 0.5 * (b.lower + b.upper) + 0.5 * anywhere(1.0) * (b.upper - b.lower);
        const glm::dvec3 to = i % 2 == 0 ? anywhere(12.0) : from + anywhere(0.2);
        const glm::dvec3 normal = glm::normalize(anywhere(1.0));
        const double off_normal = std::max(angle_between(b.axis, to - from) - b.spread, 0.0);
        if (off_normal >= b.emission || glm::dot(normal, from - to) <= 0.0) continue;
        ++shining;
        ASSERT_GT(reference_probability(tree.nodes, tree.places[light], ReferenceReceiver{to, normal}), 0.0) << i;
    }
    EXPECT_GT(shining, 20000);
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
    const double near = reference_probability(tree.nodes, tree.places[0], ReferenceReceiver{glm::dvec3(0.0), up});
    const double far = reference_probability(tree.nodes, tree.places[1], ReferenceReceiver{glm::dvec3(0.0), up});
    EXPECT_GT(near, 0.5);
    EXPECT_GT(near, 10.0 * far);
    EXPECT_EQ(reference_probability(tree.nodes, tree.places[2], ReferenceReceiver{glm::dvec3(0.0), up}), 0.0);
    EXPECT_EQ(reference_probability(tree.nodes, tree.places[0], ReferenceReceiver{glm::dvec3(0.0), -up}), 0.0);
}

TEST(LightTree, IsTheSameForTheSameLights) {
    const std::vector<LightBounds> lights = random_lights(500, 7);
    const LightTree a = build_light_tree(lights);
    const LightTree b = build_light_tree(lights);
    EXPECT_EQ(a.places, b.places);
    EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(LightNode)), 0);
}

TEST(LightTree, IsEmptyWithoutLights) { EXPECT_TRUE(build_light_tree({}).nodes.empty()); }

}  // namespace
}  // namespace wavelobe::test
