// Closest-hit and any-hit traversal against brute force in double, and the cases that break ray tracers.
#include <gtest/gtest.h>

#include "support/ray_sets.h"

namespace wavelobe::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TraversalProbe& probe() {
    static TraversalProbe instance;
    return instance;
}

Bvh hierarchy(const Triangles& triangles, BvhQuality quality = BvhQuality::split) {
    return build_bvh(triangles, {}, quality, 2);
}

void expect_valid(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits, const Bvh& bvh,
                  const Triangles& triangles) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::string fault = fault_of_hit(rays[i], hits[i], bvh, triangles);
        ASSERT_EQ(fault, "") << "ray " << i;
        if (hits[i].slot != HIT_NONE) ++found;
    }
    EXPECT_GT(found, rays.size() / 20) << "rays that hit nothing test nothing";
}

struct Soup {
    const char* name;
    std::size_t triangles;
    float size;
    float scale;
    glm::vec3 offset;
};

void PrintTo(const Soup& soup, std::ostream* out) { *out << soup.name; }

class Soups : public testing::TestWithParam<Soup> {};

TEST_P(Soups, AgreeWithBruteForce) {
    const Soup& soup = GetParam();
    const Triangles triangles = triangle_soup(soup.triangles, soup.size, soup.scale, soup.offset, 1);
    for (const BvhQuality quality : {BvhQuality::fast, BvhQuality::split}) {
        const Bvh bvh = hierarchy(triangles, quality);
        const std::vector<TestRay> rays = random_rays(40000, soup.scale, soup.offset, 2);
        expect_valid(rays, probe().trace(bvh, rays), bvh, triangles);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Soups,
                         testing::Values(Soup{"large", 60, 1.0F, 1.0F, {}}, Soup{"medium", 400, 0.2F, 1.0F, {}},
                                         Soup{"small", 800, 0.1F, 1.0F, {}}, Soup{"tiny_scale", 200, 0.3F, 1e-6F, {}},
                                         Soup{"huge_scale", 200, 0.3F, 1e6F, {}},
                                         Soup{"far_away", 200, 0.3F, 1.0F, {1000.0F, -3000.0F, 500.0F}}),
                         [](const auto& soup) { return soup.param.name; });

TEST(Traversal, Slivers) {
    Generator random(3);
    Triangles triangles;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 a = uniform_in_cube(random, 1.0F);
        const glm::vec3 along = uniform_direction(random) * 2.0F;
        triangles.push_back({a, a + along, a + 0.5F * along + uniform_in_cube(random, 1e-3F)});
    }
    const Bvh bvh = hierarchy(triangles);
    std::vector<TestRay> rays = random_rays(20000, 1.0F, {}, 4);
    for (std::size_t i = 0; i < rays.size(); i += 2) {  // half of them aimed at one
        const TriangleVertices& t = triangles[i % triangles.size()];
        rays[i] = ray_to(rays[i].origin, 0.3F * t[0] + 0.3F * t[1] + 0.4F * t[2]);
    }
    expect_valid(rays, probe().trace(bvh, rays), bvh, triangles);
}

// The portable twins of the instruction-set idioms give the same bits.
TEST(Traversal, PortableTwinsAgree) {
    TraversalProbe portable(true);
    const Triangles triangles = triangle_soup(5000, 0.05F, 1.0F, {}, 5);
    const Bvh bvh = hierarchy(triangles);
    const std::vector<TestRay> rays = random_rays(100000, 1.0F, {}, 6);
    EXPECT_EQ(portable.trace(bvh, rays), probe().trace(bvh, rays));
}

// ---- nothing slips through ------------------------------------------------------------------------------

void expect_nothing_escapes(const ClosedMesh& mesh, float inner_half, const glm::vec3& center) {
    const Bvh bvh = hierarchy(mesh.triangles());
    const std::vector<TestRay> rays = rays_from_inside(mesh, inner_half, center, 300000);
    const std::vector<TestHit> hits = probe().trace(bvh, rays);
    std::size_t escaped = 0;
    for (const TestHit& hit : hits) escaped += hit.slot == HIT_NONE || hit.any == 0 ? 1 : 0;
    EXPECT_EQ(escaped, 0U);
}

TEST(Watertight, Sphere) { expect_nothing_escapes(sphere_mesh(5, 1.0F, {}), 0.5F, {}); }
TEST(Watertight, SphereFarFromTheOrigin) {
    const glm::vec3 center{1234.5F, -777.7F, 4321.1F};
    expect_nothing_escapes(sphere_mesh(4, 3.0F, center), 1.5F, center);
}
TEST(Watertight, SmallSphere) { expect_nothing_escapes(sphere_mesh(4, 1e-5F, {}), 5e-6F, {}); }
TEST(Watertight, Cube) { expect_nothing_escapes(cube_mesh(12), 0.9F, {}); }

// Straight down on the vertices, edges and diagonals of a grid, whose bounds all these rays touch.
TEST(Watertight, AxisParallelRaysOnSharedVertices) {
    constexpr int half = 8;
    const Bvh bvh = hierarchy(floor_grid(half));
    std::vector<TestRay> rays;
    for (int x = -4 * half + 1; x < 4 * half; ++x) {
        for (int z = -4 * half + 1; z < 4 * half; ++z) {
            const glm::vec3 above{static_cast<float>(x) * 0.25F, 3.0F, static_cast<float>(z) * 0.25F};
            rays.push_back({above, {0.0F, -1.0F, 0.0F}});
            rays.push_back({above, {-0.0F, -1.0F, 0.0F}});
            rays.push_back({above * glm::vec3{1.0F, -1.0F, 1.0F}, {0.0F, 1.0F, -0.0F}});
        }
    }
    for (const TestHit& hit : probe().trace(bvh, rays)) {
        ASSERT_NE(hit.slot, HIT_NONE);
        ASSERT_EQ(hit.any, 1U);
        ASSERT_EQ(hit.t, 3.0F);
    }
}

// ---- odd scenes -----------------------------------------------------------------------------------------

TEST(Traversal, EmptySceneIsMissed) {
    const Bvh bvh = hierarchy({});
    const std::vector<TestRay> rays = random_rays(1000, 1.0F, {}, 8);
    const std::vector<TestHit> hits = probe().trace(bvh, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(hits[i], (TestHit{rays[i].limit, 0.0F, 0.0F, HIT_NONE, 0}));
}

TEST(Traversal, OneTriangle) {
    const Triangles triangles{{glm::vec3{0, 0, 0}, glm::vec3{1, 0, 0}, glm::vec3{0, 1, 0}}};
    const Bvh bvh = hierarchy(triangles);
    const std::vector<TestHit> hits =
        probe().trace(bvh, {{{0.25F, 0.5F, 2.0F}, {0, 0, -1}},
                            {{0.25F, 0.5F, -2.0F}, {0, 0, 1}},
                            {{0.75F, 0.5F, 2.0F}, {0, 0, -1}},
                            {{0.25F, 0.5F, 2.0F}, {0, 0, 1}},
                            {{0.25F, 0.5F, 2.0F}, {0, 0, -1}, 2.0F},
                            {{0.25F, 0.5F, 2.0F}, {0, 0, -1}, std::nextafter(2.0F, 3.0F)}});
    const std::uint32_t slot = hits[0].slot;
    ASSERT_NE(slot, HIT_NONE);
    EXPECT_EQ(primitive_of(bvh, slot), 0U);
    EXPECT_EQ(hits[0], (TestHit{2.0F, 0.25F, 0.5F, slot, 1}));
    EXPECT_EQ(hits[1], (TestHit{2.0F, 0.25F, 0.5F, slot, 1})) << "from behind";
    EXPECT_EQ(hits[2], (TestHit{infinity, 0.0F, 0.0F, HIT_NONE, 0})) << "beside";
    EXPECT_EQ(hits[3], (TestHit{infinity, 0.0F, 0.0F, HIT_NONE, 0})) << "behind the origin";
    EXPECT_EQ(hits[4], (TestHit{2.0F, 0.0F, 0.0F, HIT_NONE, 0})) << "a hit at the limit is none";
    EXPECT_EQ(hits[5].slot, slot);
}

TEST(Traversal, ManyCopiesOfOneTriangle) {
    const Triangles triangles(1000, {glm::vec3{-1, -1, 0}, glm::vec3{1, -1, 0}, glm::vec3{0, 1, 0}});
    for (const BvhQuality quality : {BvhQuality::fast, BvhQuality::split}) {
        const Bvh bvh = hierarchy(triangles, quality);
        const std::vector<TestRay> rays = random_rays(2000, 1.0F, {}, 9);
        expect_valid(rays, probe().trace(bvh, rays), bvh, triangles);
    }
}

// Triangles without area are never hit, not even by rays in their plane, and do not hide others.
TEST(Traversal, DegenerateTrianglesAreMissed) {
    Triangles triangles(50, {glm::vec3{0, 0, 1}, glm::vec3{0, 0, 1}, glm::vec3{0, 0, 1}});
    for (int i = 0; i < 50; ++i) triangles.push_back({glm::vec3{-1, 0, 1}, glm::vec3{1, 0, 1}, glm::vec3{0.5F, 0, 1}});
    triangles.push_back({glm::vec3{-1, -1, 2}, glm::vec3{1, -1, 2}, glm::vec3{0, 1, 2}});
    const Bvh bvh = hierarchy(triangles);
    const std::vector<TestHit> hits = probe().trace(
        bvh,
        {{{0, 0, 0}, {0, 0, 1}}, {{-2, 0, 1}, {1, 0, 0}}, {{0, 0, 0}, glm::normalize(glm::vec3{0.25F, 0.0F, 1.0F})}});
    EXPECT_EQ(hits[0].t, 2.0F);
    EXPECT_EQ(hits[1].slot, HIT_NONE);
    ASSERT_NE(hits[2].slot, HIT_NONE);
    EXPECT_EQ(primitive_of(bvh, hits[2].slot), 100U);
}

// Rays that are not numbers end as misses, without walking the whole scene: at some 30 microseconds a walk these would
// take minutes.
TEST(Traversal, RaysThatAreNotNumbersMiss) {
    const Bvh bvh = hierarchy(triangle_soup(100000, 0.02F, 1.0F, {}, 10), BvhQuality::fast);
    std::vector<TestRay> rays;
    Generator random(11);
    for (int i = 0; i < 200000; ++i) {
        TestRay ray{uniform_in_cube(random, 1.0F), uniform_direction(random)};
        const float bad = i % 3 == 0 ? nan : (i % 3 == 1 ? infinity : -infinity);
        const int where = i % 7;
        if (where < 3) {
            ray.origin[where] = bad;
        } else if (where < 6) {
            ray.direction[where - 3] = bad;
        } else {
            ray = {glm::vec3{nan}, glm::vec3{nan}};
        }
        rays.push_back(ray);
    }
    for (const float limit : {nan, 0.0F, -0.0F, -1.0F, -infinity}) rays.push_back({{0, 0, 0}, {0, 0, 1}, limit});
    rays.push_back({{0, 0, 0}, {0, 0, 0}});
    for (const Bvh& scene : {bvh, hierarchy({})}) {
        const std::vector<TestHit> hits = probe().trace(scene, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(hits[i].slot, HIT_NONE) << "ray " << i;
            ASSERT_EQ(hits[i].any, 0U) << "ray " << i;
        }
    }
}

// Origins outside by any distance, and coordinates near the ends of the range of floats: no overflow turns into a hit
// that is not there.
TEST(Traversal, DistantOrigins) {
    const Triangles triangles = triangle_soup(200, 0.3F, 1.0F, {}, 12);
    const Bvh bvh = hierarchy(triangles);
    Generator random(13);
    std::vector<TestRay> rays;
    for (int i = 0; i < 20000; ++i) {
        const float distance = std::exp2(uniform(random, 0.0F, 20.0F));
        rays.push_back(ray_to(uniform_direction(random) * distance, uniform_in_cube(random, 0.8F)));
    }
    expect_valid(rays, probe().trace(bvh, rays), bvh, triangles);
}

}  // namespace
}  // namespace wavelobe::test
