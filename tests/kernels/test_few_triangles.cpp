// LANES rays against every triangle of a small scene: the same demands as on the hierarchy.
#include <gtest/gtest.h>

#include <numeric>

#include "support/few_probe.h"
#include "support/ray_sets.h"

namespace wavelobe::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// How many facets are left for each group of rays: all of them where the rays are no pencil.
const char* const pencil_source = R"(
#include "shapes/few_facets.h"
#define RAY(k) load(rays + (size_t)(k) * count + i)

kernel void count_left(global const struct FewSummary *summary, global const float *corners, global const float *rays, uint count,
                       global uint *left) {
    uint i = (uint)get_global_id(0) * LANES;
    FewTriangles geometry = {0, 0, summary, 0, corners, 0};
    Vec3 direction = vec3(RAY(3), RAY(4), RAY(5));
    LaneRay ray = lane_ray(geometry, vec3(RAY(0), RAY(1), RAY(2)), direction, (UInt)HIT_NONE);
    Pencil pencil;
    left[get_global_id(0)] = summary->facet_count;
    if (!find_pencil(ray.origin, direction, ray.unsure, &pencil)) return;
    left[get_global_id(0)] = 0u;
    for (uint first = 0u; first < summary->facet_count; first += LANES) {
        uint present = lane_bits(lanes_below(first, summary->facet_count));
        left[get_global_id(0)] += popcount(few_in_pencil(corners, first, &pencil) & present);
    }
}
)";

FewProbe& probe() {
    static FewProbe instance;
    return instance;
}

struct Soup {
    const char* name;
    float size;
    float scale;
    glm::vec3 offset;
};

void PrintTo(const Soup& soup, std::ostream* out) { *out << soup.name; }

class FewSoups : public testing::TestWithParam<Soup> {};

TEST_P(FewSoups, AgreeWithBruteForce) {
    const Soup& soup = GetParam();
    // Of 42 triangles that share no corner: 126 vertices of at most 128.
    const SmallScene scene(triangle_soup(42, soup.size, soup.scale, soup.offset, 1));
    const std::vector<TestRay> rays = random_rays(100000, soup.scale, soup.offset, 2);
    const std::vector<TestHit> hits = probe().trace(scene.few, rays);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::string fault = fault_of_hit(rays[i], hits[i], scene.bvh, scene.triangles, Projection::rotation);
        ASSERT_EQ(fault, "") << "ray " << i;
        if (hits[i].slot != HIT_NONE) ++found;
    }
    EXPECT_GT(found, rays.size() / 20);
}

INSTANTIATE_TEST_SUITE_P(All, FewSoups,
                         testing::Values(Soup{"large", 1.0F, 1.0F, {}}, Soup{"small", 0.3F, 1.0F, {}},
                                         Soup{"tiny_scale", 0.5F, 1e-6F, {}}, Soup{"huge_scale", 0.5F, 1e6F, {}},
                                         Soup{"far_away", 0.5F, 1.0F, {1000.0F, -3000.0F, 500.0F}}),
                         [](const auto& soup) { return soup.param.name; });

TEST(FewTriangles, SameBitsAtEveryWidth) {
    const SmallScene scene(triangle_soup(42, 0.5F, 1.0F, {}, 3));
    const std::vector<TestRay> rays = random_rays(20000, 1.0F, {}, 4);
    const std::vector<TestHit> hits = probe().trace(scene.few, rays);
    EXPECT_EQ(FewProbe(1).trace(scene.few, rays), hits);
    EXPECT_EQ(FewProbe(8).trace(scene.few, rays), hits);
    EXPECT_EQ(FewProbe(16, true).trace(scene.few, rays), hits) << "portable twins";
}

// Groups of 16 rays from one point, within `spread` of each other; every other point lies in the plane of a triangle.
std::vector<TestRay> pencils(const Triangles& triangles, std::size_t count, float spread, unsigned seed, float scale = 1.0F, const glm::vec3& offset = {}) {
    Generator random(seed);
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const TriangleVertices& t = triangles[i % triangles.size()];
        const glm::vec3 weights = uniform_in_cube(random, 4.0F);
        const glm::vec3 in_plane = t[0] + weights.x * (t[1] - t[0]) + weights.y * (t[2] - t[0]);
        const glm::vec3 origin = i % 2 == 0 ? in_plane : uniform_in_cube(random, 3.0F) * scale + offset;
        const glm::vec3 axis = i % 3 == 0 ? uniform_direction(random) : glm::normalize(t[i % 3] - origin);
        for (int k = 0; k < 16; ++k) rays.push_back({origin, glm::normalize(axis + spread * uniform_direction(random))});
    }
    return rays;
}

// Triangles of every shape, down to needles.
Triangles soup_with_needles(unsigned seed, float scale, const glm::vec3& offset) {
    Triangles triangles = triangle_soup(42, 0.7F, scale, offset, seed);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        triangles[i][2] = glm::mix(glm::mix(triangles[i][0], triangles[i][1], 0.3F), triangles[i][2], std::ldexp(1.0F, -static_cast<int>(i) / 2));
    }
    return triangles;
}

TEST(FewTriangles, PencilsInARoomOfRectanglesMeetWhatSingleRaysMeet) {
    for (const float spread : {1e-3F, 0.03F, 0.3F}) {
        const SmallScene scene(furnished_room(1.0F, {}, 0.0F));
        const std::vector<TestRay> rays = pencils(scene.triangles, 4000, spread, 13);
        const std::vector<TestHit> hits = FewProbe(1).trace(scene.few, rays);
        EXPECT_EQ(probe().trace(scene.few, rays), hits) << spread;
        EXPECT_EQ(FewProbe(8).trace(scene.few, rays), hits) << spread;
        EXPECT_EQ(FewProbe(16, true).trace(scene.few, rays), hits) << spread << ", portable twins";
    }
}

class FewPencils : public testing::TestWithParam<Soup> {};

TEST_P(FewPencils, MeetWhatSingleRaysMeet) {
    const Soup& soup = GetParam();
    for (const float spread : {0.0F, 1e-3F, 0.03F, 0.3F, 0.9F}) {
        const SmallScene scene(soup_with_needles(7, soup.scale, soup.offset));
        const std::vector<TestRay> rays = pencils(scene.triangles, 4000, spread, 8, soup.scale, soup.offset);
        const std::vector<TestHit> hits = FewProbe(1).trace(scene.few, rays);
        EXPECT_EQ(probe().trace(scene.few, rays), hits) << spread;
        EXPECT_EQ(FewProbe(8).trace(scene.few, rays), hits) << spread;
    }
}

INSTANTIATE_TEST_SUITE_P(All, FewPencils,
                         testing::Values(Soup{"unit", 0.7F, 1.0F, {}}, Soup{"tiny_scale", 0.7F, 1e-6F, {}}, Soup{"huge_scale", 0.7F, 1e6F, {}},
                                         Soup{"far_away", 0.7F, 1.0F, {1000.0F, -3000.0F, 500.0F}}),
                         [](const auto& soup) { return soup.param.name; });

TEST(FewTriangles, PencilsAreNotTestedAgainstWhatLiesBesideThem) {
    const SmallScene scene(triangle_soup(42, 0.3F, 1.0F, {}, 9));
    const auto left = [&](const std::vector<TestRay>& rays) {
        const std::vector<float> packed = packed_rays(rays, rays.size());
        const std::vector<FewSummary> summary{scene.few.summary};
        std::vector<std::uint32_t> of_group(rays.size() / 16);
        const auto count = static_cast<cl_uint>(rays.size());
        Probe(pencil_source).run("count_left", of_group.size(), summary, scene.few.corners, packed, count, of_group);
        return std::accumulate(of_group.begin(), of_group.end(), 0.0) / static_cast<double>(of_group.size());
    };
    EXPECT_LT(left(pencils(scene.triangles, 1000, 0.01F, 10)), 12.0);
    EXPECT_EQ(left(pencils(scene.triangles, 1000, 3.0F, 11)), 42.0) << "no pencils";
    EXPECT_EQ(left(random_rays(16000, 1.0F, {}, 12)), 42.0) << "no common origin";
}

void expect_nothing_escapes(const ClosedMesh& mesh, float inner_half, const glm::vec3& center) {
    const SmallScene scene(mesh.triangles());
    const std::vector<TestRay> rays = rays_from_inside(mesh, inner_half, center, 300000);
    std::size_t escaped = 0;
    for (const TestHit& hit : probe().trace(scene.few, rays)) escaped += hit.slot == HIT_NONE || hit.any == 0 ? 1 : 0;
    EXPECT_EQ(escaped, 0U);
}

TEST(FewTriangles, ClosedCubeIsWatertight) { expect_nothing_escapes(cube_mesh(2), 0.9F, {}); }
TEST(FewTriangles, ClosedSphereIsWatertight) { expect_nothing_escapes(sphere_mesh(1, 1.0F, {}), 0.4F, {}); }
TEST(FewTriangles, SmallSphereIsWatertight) { expect_nothing_escapes(sphere_mesh(1, 1e-5F, {}), 4e-6F, {}); }
TEST(FewTriangles, DistantSphereIsWatertight) {
    const glm::vec3 center{1234.5F, -777.7F, 4321.1F};
    expect_nothing_escapes(sphere_mesh(1, 3.0F, center), 1.2F, center);
}

TEST(FewTriangles, RaysThatAreNotNumbersMiss) {
    const SmallScene scene(triangle_soup(42, 0.5F, 1.0F, {}, 5));
    std::vector<TestRay> rays;
    Generator random(6);
    for (int i = 0; i < 2100; ++i) {
        TestRay ray{uniform_in_cube(random, 1.0F), uniform_direction(random)};
        const float bad = i % 3 == 0 ? nan : (i % 3 == 1 ? infinity : -infinity);
        if (i % 7 < 3) {
            ray.origin[i % 7] = bad;
        } else if (i % 7 < 6) {
            ray.direction[i % 7 - 3] = bad;
        } else {
            ray.limit = i % 3 == 0 ? nan : -1.0F;
        }
        rays.push_back(ray);
    }
    rays.push_back({{0, 0, 0}, {0, 0, 0}});
    for (const TestHit& hit : probe().trace(scene.few, rays)) {
        ASSERT_EQ(hit.slot, HIT_NONE);
        ASSERT_EQ(hit.any, 0U);
    }
}

}  // namespace
}  // namespace wavelobe::test
