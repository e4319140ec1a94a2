// Rays that leave a surface: they start beyond its rounding error and never meet it again, at any scale.
#include <gtest/gtest.h>

#include <tuple>

#include "support/surface_bench.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {
namespace {

TriangleMesh mesh_of(const Triangles& triangles) {
    TriangleMesh mesh;
    for (const TriangleVertices& t : triangles) {
        const auto first = static_cast<unsigned>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), t.begin(), t.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

struct Placement {
    const char* name;
    float scale;
    glm::vec3 offset;  // in units of the scale
};

void PrintTo(const Placement& placement, std::ostream* out) { *out << placement.name; }

class Leaving : public testing::TestWithParam<std::tuple<Placement, bool>> {};

// From all over random triangles, in all directions and nearly along the surface: positions are known to within their
// bounds, and the triangle is never met again.
TEST_P(Leaving, NeverMeetsTheSameTriangle) {
    const auto& [placement, few] = GetParam();
    const glm::vec3 offset = placement.offset * placement.scale;
    const Triangles triangles = triangle_soup(few ? 40 : 300, 0.4F, placement.scale, offset, 1);
    Scene scene = empty_scene(16);
    add_shape(scene, mesh_of(triangles), add_diffuse(scene, Rgb{0.5F}), "soup");
    SurfaceBench bench(scene, 16, few);
    Generator random(2);
    std::size_t met = 0;
    for (int round = 0; round < 8; ++round) {
        std::vector<TestPath> rays;
        std::vector<glm::vec3> leave;
        while (rays.size() < surface_batch) {
            const TriangleVertices& t = triangles[random() % triangles.size()];
            const float b = uniform(random, 0.0F, 1.0F);
            const float c = uniform(random, 0.0F, 1.0F - b);
            const glm::vec3 target = t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]);
            const glm::vec3 origin = offset + placement.scale * 3.0F * uniform_direction(random);
            rays.push_back(untraced(origin, glm::normalize(target - origin)));
            glm::vec3 away = uniform_direction(random);
            if (rays.size() % 2 == 0) {  // to within 1e-6 of tangential
                const glm::vec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
                away = glm::normalize(away - n * glm::dot(n, away) + n * uniform(random, -1e-6F, 1e-6F));
            }
            leave.push_back(away);
        }
        bench.hit(rays, leave);
        std::vector<TestPath> next;
        std::vector<std::uint32_t> from;
        for (std::size_t i = 0; i < surface_batch; ++i) {
            if (bench.path(i).hit == HIT_NONE) continue;
            const std::uint32_t primitive = bench.primitive(i);
            const TriangleVertices& t = triangles[primitive];
            const glm::dvec3 n =
                glm::normalize(glm::cross(glm::dvec3(t[1]) - glm::dvec3(t[0]), glm::dvec3(t[2]) - glm::dvec3(t[0])));
            const double distance = glm::dot(n, glm::dvec3(bench.position(i)) - glm::dvec3(t[0]));
            ASSERT_LE(std::abs(distance), glm::dot(glm::abs(n), glm::dvec3(bench.error(i))));
            ASSERT_NEAR(std::abs(glm::dot(n, glm::dvec3(bench.normal(i)))), 1.0, 1e-5) << "of a sliver's normal";
            next.push_back(untraced(bench.leaving_origin(i), leave[i]));
            if (i % 4 == 0) next.back().hit = primitive;  // as stages say; the others must do without
            from.push_back(primitive);
        }
        ASSERT_GT(next.size(), surface_batch / 2);
        bench.hit(next, std::vector<glm::vec3>(next.size(), glm::vec3(0, 0, 1)));
        for (std::size_t i = 0; i < next.size(); ++i) {
            if (bench.path(i).hit != HIT_NONE && bench.primitive(i) == from[i]) ++met;
        }
    }
    EXPECT_EQ(met, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    All, Leaving,
    testing::Combine(testing::Values(Placement{"unit", 1.0F, {0, 0, 0}}, Placement{"tiny", 1e-6F, {0, 0, 0}},
                                     Placement{"huge", 1e6F, {0, 0, 0}}, Placement{"away", 1.0F, {1000, -300, 500}},
                                     Placement{"tiny_away", 1e-6F, {100, 50, -80}},
                                     Placement{"huge_away", 1e6F, {20, 30, -10}}),
                     testing::Bool()),
    [](const auto& p) { return std::get<0>(p.param).name + std::string(std::get<1>(p.param) ? "_few" : ""); });

// A flat floor at a height that floats hold exactly: origins stay on their side, at any distance from the middle.
// (That position is known far better than the distances of a test against such large triangles.)
class LeavingFloor : public testing::TestWithParam<bool> {};

TEST_P(LeavingFloor, AtAnyScale) {
    for (const float size : {1e-6F, 1.0F, 1e6F}) {
        for (const float height : {0.0F, 0.25F, -3.0F}) {
            Scene scene = empty_scene(16);
            add_quad(scene, {-size, height * size, size}, {2 * size, 0, 0}, {0, 0, -2 * size},
                     add_diffuse(scene, Rgb{0.5F}));
            SurfaceBench bench(scene, 16, GetParam());
            Generator random(3);
            std::vector<TestPath> rays;
            std::vector<glm::vec3> leave;
            for (std::uint32_t i = 0; i < surface_batch; ++i) {
                const glm::vec3 target{uniform(random, -size, size), height * size, uniform(random, -size, size)};
                rays.push_back(untraced({0.1F * size, (height + 1) * size, 0},
                                        glm::normalize(target - glm::vec3{0.1F * size, (height + 1) * size, 0})));
                leave.push_back(uniform_direction(random));
            }
            bench.hit(rays, leave);
            std::vector<TestPath> next;
            for (std::uint32_t i = 0; i < surface_batch; ++i) {
                if (bench.path(i).hit == HIT_NONE) continue;
                const float y = bench.leaving_origin(i).y;
                if (leave[i].y > 0.0F) {
                    ASSERT_GE(y, height * size);
                } else {
                    ASSERT_LE(y, height * size);
                }
                next.push_back(untraced(bench.leaving_origin(i), leave[i]));
            }
            ASSERT_GT(next.size(), surface_batch * 9 / 10);
            bench.trace(next);
            for (std::size_t i = 0; i < next.size(); ++i)
                ASSERT_EQ(bench.path(i).hit, HIT_NONE) << "size " << size << " height " << height;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, LeavingFloor, testing::Bool(),
                         [](const auto& few) { return few.param ? "few" : "hierarchy"; });

// Walls next to the origin are met at any distance, however small beside their own size, from the side on which it is.
class NearWall : public testing::TestWithParam<bool> {};

TEST_P(NearWall, IsMet) {
    Generator random(5);
    for (const float scale : {1e-6F, 1.0F, 1e6F}) {
        TriangleVertices wall{glm::vec3{1.0F, 0.1F, 0.2F}, glm::vec3{-0.3F, 1.0F, -0.4F}, glm::vec3{0.2F, -0.5F, 0.9F}};
        for (glm::vec3& v : wall) v *= scale;
        Scene scene = empty_scene(16);
        add_shape(scene, mesh_of({wall}), add_diffuse(scene, Rgb{0.5F}), "wall");
        SurfaceBench bench(scene, 16, GetParam());
        const glm::dvec3 a{wall[0]};
        const glm::dvec3 n = glm::normalize(glm::cross(glm::dvec3(wall[1]) - a, glm::dvec3(wall[2]) - a));
        std::vector<TestPath> rays;
        std::vector<double> distances;
        while (rays.size() < surface_batch) {
            const float b = uniform(random, 0.1F, 0.5F);
            const float c = uniform(random, 0.1F, 0.8F - b);
            const float away = scale * std::exp2(uniform(random, -24.0F, -7.0F));
            const glm::vec3 origin = wall[0] + b * (wall[1] - wall[0]) + c * (wall[2] - wall[0]) +
                                     away * uniform_direction(random);
            const glm::vec3 direction = uniform_direction(random);
            const double along = glm::dot(n, glm::dvec3(direction));
            const double distance = glm::dot(n, a - glm::dvec3(origin)) / along;
            if (std::abs(along) < 0.1 || std::abs(distance) > 0.01 * static_cast<double>(scale)) continue;
            rays.push_back(untraced(origin, direction));
            distances.push_back(distance);
        }
        bench.trace(rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(bench.path(i).hit != HIT_NONE, distances[i] > 0.0) << "at distance " << distances[i];
            // Up to the bound from which on the float test is trusted (shapes/triangle_block.h), over an area's share.
            if (distances[i] < 0.0) continue;
            ASSERT_NEAR(bench.path(i).t, distances[i], 1e-6 * distances[i] + 1e-4 * static_cast<double>(scale));
        }
        for (TestPath& ray : rays) ray.hit = 0;
        bench.trace(rays);
        for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(bench.path(i).hit, HIT_NONE) << "of the triangle it left";
    }
}

INSTANTIATE_TEST_SUITE_P(All, NearWall, testing::Bool(),
                         [](const auto& few) { return few.param ? "few" : "hierarchy"; });

}  // namespace
}  // namespace wavelobe::test
