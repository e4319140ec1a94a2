#include <gtest/gtest.h>

#include <tuple>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

// At each width, with a hierarchy and without.
class IntersectClosest : public testing::TestWithParam<std::tuple<int, bool>> {
protected:
    static StageBench bench(const Scene& scene) {
        return StageBench(scene, std::get<0>(GetParam()), 64, std::get<1>(GetParam()));
    }
};

// Triangle 0 in z = 2, triangles 1 and 2 a square in z = 5.
Scene two_walls() {
    Scene scene = empty_scene(16);
    const int material = add_diffuse(scene, Rgb{0.5F});
    add_triangle(scene, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}, material);
    add_quad(scene, {-4, -4, 5}, {8, 0, 0}, {0, 8, 0}, material);
    return scene;
}

TestPath ray(std::uint32_t id, const glm::vec3& origin, const glm::vec3& direction, float limit) {
    TestPath p;
    p.id = id;
    p.origin = origin;
    p.direction = direction;
    p.t = limit;
    p.throughput = glm::vec3(0.25F, 0.5F, static_cast<float>(id));
    p.depth = id;
    p.pdf = 0.125F * static_cast<float>(id);
    return p;
}

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST_P(IntersectClosest, WritesTheNearestHitIntoEachSlot) {
    StageBench b = bench(two_walls());
    const glm::vec3 z{0, 0, 1};
    const std::vector<TestPath> rays = {
        ray(0, {0.25F, 0.5F, 0}, z, infinity),   // both: the triangle is nearer
        ray(1, {-1, 2, 0}, z, infinity),         // the square alone
        ray(2, {0.25F, 0.25F, 3}, z, infinity),  // from between them
        ray(3, {0.25F, 0.5F, 0}, z, 1.5F),       // ends before both
        ray(4, {0.25F, 0.5F, 0}, -z, infinity),  // away from both
        ray(5, {0.25F, 0.5F, 4}, -z, infinity),  // the triangle from behind
        ray(6, {9, 9, 0}, z, infinity),          // beside
    };
    b.fill(QUEUE_RAYS, rays);
    b.run("intersect_closest");
    ASSERT_EQ(b.header().count[QUEUE_RAYS], rays.size());
    const std::uint32_t none = HIT_NONE;
    const std::uint32_t triangle = b.slot_of(0);
    const std::uint32_t hits[] = {triangle, b.slot_of(2), 0, none, none, triangle, none};
    const float distances[] = {2, 5, 2, 1.5F, infinity, 2, infinity};
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        const TestPath p = b.path(QUEUE_RAYS, i);
        if (i == 2) {
            // On the square's diagonal.
            EXPECT_TRUE(p.hit == b.slot_of(1) || p.hit == b.slot_of(2));
        } else {
            EXPECT_EQ(p.hit, hits[i]) << "ray " << i;
        }
        EXPECT_EQ(p.t, distances[i]) << "ray " << i;
        // All else stays.
        EXPECT_EQ(p.id, rays[i].id);
        EXPECT_EQ(p.depth, rays[i].depth);
        EXPECT_EQ(p.pdf, rays[i].pdf);
        EXPECT_EQ(p.throughput, rays[i].throughput);
        EXPECT_EQ(p.origin, rays[i].origin);
        EXPECT_EQ(p.direction, rays[i].direction);
    }
    EXPECT_EQ(b.path(QUEUE_RAYS, 0).u, 0.25F);
    EXPECT_EQ(b.path(QUEUE_RAYS, 0).v, 0.5F);
    // The square's triangles are (0, 1, 2) and (0, 2, 3): (-1, 2) lies in the second.
    EXPECT_EQ(b.path(QUEUE_RAYS, 1).u, 0.375F);
    EXPECT_EQ(b.path(QUEUE_RAYS, 1).v, 0.375F);
}

TEST_P(IntersectClosest, NothingInTheQueueIsNothingToDo) {
    StageBench b = bench(two_walls());
    b.run("intersect_closest");
    EXPECT_EQ(b.header().count[QUEUE_RAYS], 0U);
}

INSTANTIATE_TEST_SUITE_P(All, IntersectClosest, testing::Combine(testing::Values(1, 8, 16), testing::Bool()),
                         [](const auto& p) {
                             return std::to_string(std::get<0>(p.param)) +
                                    (std::get<1>(p.param) ? "_few" : "_hierarchy");
                         });

// A sphere in front of the walls: hits of analytic shapes name them.
TEST(IntersectClosestAnalytic, NamesTheShape) {
    Scene scene = two_walls();
    add_sphere(scene, {0.25F, 0.5F, -3}, 1.0F, 0);
    StageBench b(scene);
    b.fill(QUEUE_RAYS, {ray(0, {0.25F, 0.5F, -9}, {0, 0, 1}, infinity), ray(1, {0.25F, 0.5F, -3}, {0, 0, 1}, infinity),
                        ray(2, {0.25F, 0.5F, 0}, {0, 0, 1}, infinity)});
    b.run("intersect_closest");
    EXPECT_EQ(b.path(QUEUE_RAYS, 0).hit, HIT_ANALYTIC);
    EXPECT_EQ(b.path(QUEUE_RAYS, 0).t, 5.0F);
    EXPECT_EQ(b.path(QUEUE_RAYS, 1).hit, HIT_ANALYTIC);
    EXPECT_EQ(b.path(QUEUE_RAYS, 1).t, 1.0F);
    EXPECT_EQ(b.path(QUEUE_RAYS, 2).hit, b.slot_of(0));
}

}  // namespace
}  // namespace wavelobe::test
