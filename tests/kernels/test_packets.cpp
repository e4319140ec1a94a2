// Rays in groups, as packets where they agree: the same bits as each ray alone.
#include <gtest/gtest.h>

#include <cstring>

#include "support/ray_sets.h"

namespace wavelobe::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TraversalProbe& alone() {
    static TraversalProbe probe;
    return probe;
}

TraversalProbe& grouped() {
    static TraversalProbe probe(false, true);
    return probe;
}

// Bundles of 16 rays from about one point to about another, as wide as `spread` times their length.
std::vector<TestRay> bundles(std::size_t count, float spread, float scale, const glm::vec3& offset) {
    Generator random(11);
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 origin = uniform_in_cube(random, 1.5F);
        const glm::vec3 target = uniform_in_cube(random, 1.0F);
        for (int k = 0; k < 16; ++k) {
            const glm::vec3 from = origin + (i % 2 == 0 ? glm::vec3{0.0F} : uniform_in_cube(random, 0.5F * spread));
            TestRay ray = ray_to(from * scale + offset, (target + uniform_in_cube(random, spread)) * scale + offset);
            if (i % 3 == 0) ray.limit = uniform(random, 0.5F, 2.5F) * scale;
            rays.push_back(ray);
        }
    }
    return rays;
}

// A triangle may stand in several leaves: which of these names a hit does not matter.
TestHit with_primitive(TestHit hit, const Bvh& bvh) {
    if (hit.slot != HIT_NONE) hit.slot = primitive_of(bvh, hit.slot);
    return hit;
}

void expect_same(const Bvh& bvh, const std::vector<TestRay>& rays, TraversalProbe& groups = grouped()) {
    const std::vector<TestHit> expected = alone().trace(bvh, rays);
    const std::vector<TestHit> hits = groups.trace(bvh, rays);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const TestHit hit = with_primitive(hits[i], bvh);
        const TestHit one = with_primitive(expected[i], bvh);
        ASSERT_EQ(std::memcmp(&hit, &one, sizeof hit), 0)  // limits that are not numbers come back
            << "ray " << i << ": " << hits[i].t << " instead of " << expected[i].t;
        if (hits[i].slot != HIT_NONE) ++found;
    }
    EXPECT_GT(found, rays.size() / 20);
}

struct Bundle {
    const char* name;
    float spread;
    float scale;
    glm::vec3 offset;
};

void PrintTo(const Bundle& b, std::ostream* out) { *out << b.name; }

class Packets : public testing::TestWithParam<Bundle> {};

TEST_P(Packets, HaveTheBitsOfSingleRays) {
    const Bundle& b = GetParam();
    const Bvh bvh = build_bvh(triangle_soup(5000, 0.1F, b.scale, b.offset, 1), {}, BvhQuality::split, 1);
    expect_same(bvh, bundles(8000, b.spread, b.scale, b.offset));
}

INSTANTIATE_TEST_SUITE_P(All, Packets,
                         testing::Values(Bundle{"narrow", 0.01F, 1.0F, {}}, Bundle{"wide", 0.2F, 1.0F, {}},
                                         Bundle{"incoherent", 1.0F, 1.0F, {}}, Bundle{"tiny_scale", 0.05F, 1e-6F, {}},
                                         Bundle{"huge_scale", 0.05F, 1e6F, {}},
                                         Bundle{"far_away", 0.05F, 1.0F, {1000.0F, -3000.0F, 500.0F}}),
                         [](const auto& bundle) { return bundle.param.name; });

TEST(Packets, OfEveryWidthAndPath) {
    const Bvh bvh = build_bvh(triangle_soup(2000, 0.1F, 1.0F, {}, 2), {}, BvhQuality::split, 1);
    const std::vector<TestRay> rays = bundles(3000, 0.03F, 1.0F, {});
    TraversalProbe eight(false, true, 8);
    expect_same(bvh, rays, eight);
    TraversalProbe portable(true, true);
    expect_same(bvh, rays, portable);
}

// Rays that have nothing in common, several in turn: more of them than walks, as many, and fewer.
TEST(Packets, WalksInTurn) {
    const Bvh bvh = build_bvh(triangle_soup(5000, 0.1F, 1.0F, {}, 4), {}, BvhQuality::split, 1);
    for (const int walks : {2, 8, 16}) {
        TraversalProbe in_turn(false, true, 16, walks);
        expect_same(bvh, bundles(2000, 1.0F, 1.0F, {}), in_turn);
        expect_same(bvh, bundles(2000, 0.1F, 1.0F, {}), in_turn);
    }
}

// Rays from all around to about one point: they agree in nothing, and go together as shadow rays to a lamp do.
TEST(Packets, TowardsALampFromAllSides) {
    const Bvh bvh = build_bvh(triangle_soup(5000, 0.05F, 1.0F, {}, 5), {}, BvhQuality::split, 1);
    Generator random(6);
    std::vector<TestRay> rays;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 lamp{0.1F, 0.9F, -0.2F};
        TestRay ray = ray_to(lamp + uniform_in_cube(random, i < 10000 ? 0.3F : 1.5F), lamp + uniform_in_cube(random, 0.02F));
        ray.limit = i % 5 == 0 ? infinity : uniform(random, 0.1F, 2.0F);
        rays.push_back(ray);
    }
    expect_same(bvh, rays);
}

// Along the axes, where reciprocals are as large as they get, up and down at once.
TEST(Packets, AlongTheAxes) {
    const Bvh bvh = build_bvh(sphere_mesh(5, 1.0F, {}).triangles(), {}, BvhQuality::split, 1);
    Generator random(7);
    std::vector<TestRay> rays;
    for (int i = 0; i < 8000; ++i) {
        TestRay ray{uniform_in_cube(random, 1.2F), {0, 0, 0}};
        ray.direction[static_cast<glm::length_t>(i / 16 % 3)] = i % 2 == 0 ? 1.0F : -1.0F;
        rays.push_back(ray);
    }
    expect_same(bvh, rays);
}

// Each triangle there three times, in three planes that are the same: which of them is hit is a matter of ties.
TEST(Packets, BreakTiesAlike) {
    Triangles triangles;
    for (int copy = 0; copy < 3; ++copy) {
        for (const TriangleVertices& t : sphere_mesh(4, 1.0F, {}).triangles()) triangles.push_back(t);
    }
    const Bvh bvh = build_bvh(triangles, {}, BvhQuality::split, 1);
    expect_same(bvh, bundles(6000, 0.03F, 1.0F, {}));
}

// Neighbouring rays to the vertices and edges of a closed mesh, where several triangles are hit at one distance.
TEST(Packets, OnEdgesAndVertices) {
    const ClosedMesh mesh = sphere_mesh(5, 1.0F, {});
    const Bvh bvh = build_bvh(mesh.triangles(), {}, BvhQuality::split, 1);
    std::vector<TestRay> rays;
    Generator random(3);
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        const glm::vec3 origin = uniform_in_cube(random, 0.3F);
        for (std::size_t k = 0; k < 16; ++k) {
            const glm::uvec3& f = mesh.faces[(i + k / 4) % mesh.faces.size()];
            const glm::vec3 a = mesh.vertices[f[static_cast<int>(k % 3)]];
            const glm::vec3 b = mesh.vertices[f[static_cast<int>((k + 1) % 3)]];
            rays.push_back(ray_to(origin, k % 4 == 0 ? a : glm::mix(a, b, uniform(random, 0.0F, 1.0F))));
        }
    }
    expect_same(bvh, rays);
    for (const TestHit& hit : grouped().trace(bvh, rays)) ASSERT_TRUE(hit.slot != HIT_NONE && hit.any == 1U);
}

// Limits one float beyond what is hit, and at it: boxes that end in the plane of a triangle must not cost the hit.
TEST(Packets, SeeUpToTheLastFloatBeforeTheLimit) {
    const Bvh bvh = build_bvh(cube_mesh(12).triangles(), {}, BvhQuality::split, 1);
    Generator random(8);
    for (TraversalProbe* probe : {&alone(), &grouped()}) {
        std::vector<TestRay> rays;
        for (int i = 0; i < 1000; ++i) {
            const glm::vec3 origin = uniform_in_cube(random, 0.9F), target = uniform_in_cube(random, 1.0F);
            for (int k = 0; k < 16; ++k) rays.push_back(ray_to(origin, target + uniform_in_cube(random, 0.01F)));
        }
        const std::vector<TestHit> hits = probe->trace(bvh, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i].limit = std::nextafter(hits[i].t, infinity);
        const std::vector<TestHit> beyond = probe->trace(bvh, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i].limit = hits[i].t;
        const std::vector<TestHit> at = probe->trace(bvh, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(beyond[i].any, 1U) << "ray " << i;
            ASSERT_EQ(beyond[i].t, hits[i].t) << "ray " << i;
            ASSERT_EQ(at[i].any, 0U) << "ray " << i;
            ASSERT_EQ(at[i].slot, HIT_NONE) << "ray " << i;
        }
    }
}

TEST(Packets, RaysThatAreNotNumbersMissAndHarmNoNeighbour) {
    const Bvh bvh = build_bvh(sphere_mesh(4, 1.0F, {}).triangles(), {}, BvhQuality::split, 1);
    std::vector<TestRay> rays = bundles(500, 0.02F, 1.0F, {});
    for (std::size_t i = 0; i < rays.size(); i += 5) {
        const float bad = i % 3 == 0 ? nan : (i % 3 == 1 ? infinity : -infinity);
        const auto axis = static_cast<glm::length_t>(i % 3);
        if (i % 2 == 0) {
            rays[i].origin[axis] = bad;
        } else {
            rays[i].direction[axis] = bad;
        }
        if (i % 7 == 0) rays[i] = {{0, 0, 0}, {0, 0, 0}};
        if (i % 11 == 0) rays[i].limit = i % 2 == 0 ? nan : -1.0F;
    }
    expect_same(bvh, rays);
}

}  // namespace
}  // namespace wavelobe::test
