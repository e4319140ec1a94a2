#include <gtest/gtest.h>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

class ScatterDiffuse : public StageTest {};

constexpr double pi = 3.14159265358979323846;
const Rgb albedo{0.25F, 0.5F, 0.75F};
const Rgb intensity{4.0F, 8.0F, 2.0F};

// Triangles 0, 1: diffuse, [0, 2] x [0, 3] in z = 1, normal +z, black behind.
Scene wall_scene() {
    Scene scene = empty_scene(16);
    scene.integrator.rr_depth = 1000;
    add_quad(scene, {0, 0, 1}, {2, 0, 0}, {0, 3, 0}, add_diffuse(scene, albedo));
    return scene;
}

std::vector<TestPath> arriving(const StageBench& bench, const glm::vec3& direction, std::uint32_t count) {
    std::vector<TestPath> paths(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        paths[i].hit = bench.slot_of(0);
        paths[i].u = 0.25F;
        paths[i].v = 0.5F;
        paths[i].t = 2.0F;
        paths[i].direction = glm::normalize(direction);
        paths[i].throughput = glm::vec3(1, 0.5F, 0.25F) * static_cast<float>(i + 1);
        paths[i].id = (i * 41) % TILE_PIXELS;
        paths[i].depth = i % 5;
    }
    return paths;
}

const glm::dvec3 position{1.5, 1.5, 1};  // of these hits
const glm::vec3 from_front{1, 0.5F, -2};

TEST_P(ScatterDiffuse, SendsAShadowRayToThePointLight) {
    Scene scene = wall_scene();
    const glm::dvec3 light{2.5, 0.5, 3};
    scene.emitters.emplace_back(PointEmitter{glm::vec3(light), intensity});
    StageBench bench(scene, GetParam());
    const std::vector<TestPath> paths = arriving(bench, from_front, 21);
    bench.fill(QUEUE_DIFFUSE, paths);
    bench.run("scatter_diffuse");
    EXPECT_EQ(bench.header().count[QUEUE_DIFFUSE], 0U);
    ASSERT_EQ(bench.header().count[QUEUE_SHADOW], 21U);
    const glm::dvec3 way = light - position;
    const double distance = glm::length(way);
    const double received = way.z / distance / (distance * distance) / pi;
    for (std::uint32_t i = 0; i < 21; ++i) {
        const TestShadowRay s = bench.shadow(i);
        EXPECT_EQ(s.id, paths[i].id);
        expect_close(s.direction, way / distance);
        expect_close(s.origin, position);
        EXPECT_GT(s.origin.z, 1.0F);
        EXPECT_LE(s.t, distance * (1.0 + stage_rounding));
        EXPECT_NEAR(s.t, distance, distance * stage_rounding);
        expect_close(s.contribution,
                     glm::dvec3(paths[i].throughput) * glm::dvec3(albedo) * glm::dvec3(intensity) * received);
    }
}

TEST_P(ScatterDiffuse, ContinuesByTheCosine) {
    Scene scene = wall_scene();
    scene.emitters.emplace_back(PointEmitter{{2.5F, 0.5F, 3}, intensity});
    StageBench bench(scene, GetParam(), 256);
    const std::vector<TestPath> paths = arriving(bench, from_front, 256);
    bench.fill(QUEUE_DIFFUSE, paths);
    bench.run("scatter_diffuse");
    ASSERT_EQ(bench.header().count[QUEUE_RAYS], 256U);
    double mean_cosine = 0.0;
    for (std::uint32_t i = 0; i < 256; ++i) {
        const TestPath p = bench.path(QUEUE_RAYS, i);
        EXPECT_EQ(p.id, paths[i].id);
        EXPECT_EQ(p.depth, paths[i].depth + 1);
        EXPECT_EQ(p.t, std::numeric_limits<float>::infinity());
        ASSERT_GT(p.direction.z, 0.0F);
        EXPECT_NEAR(glm::length(glm::dvec3(p.direction)), 1.0, stage_rounding);
        EXPECT_NEAR(p.pdf, static_cast<double>(p.direction.z) / pi, stage_rounding);
        expect_close(p.throughput, glm::dvec3(paths[i].throughput) * glm::dvec3(albedo));
        expect_close(p.origin, position);
        EXPECT_GT(p.origin.z, 1.0F);
        mean_cosine += static_cast<double>(p.direction.z) / 256.0;
    }
    // cos has the mean 2/3 and the variance 1/18 under the density cos / pi.
    EXPECT_NEAR(mean_cosine, 2.0 / 3.0, 4.5 * std::sqrt(1.0 / 18.0 / 256.0));
}

TEST_P(ScatterDiffuse, LightsBehindSendNothing) {
    Scene scene = wall_scene();
    scene.emitters.emplace_back(PointEmitter{{1, 1, -3}, intensity});
    StageBench bench(scene, GetParam());
    bench.fill(QUEUE_DIFFUSE, arriving(bench, from_front, 9));
    bench.run("scatter_diffuse");
    EXPECT_EQ(bench.header().count[QUEUE_SHADOW], 0U);
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 9U);
}

TEST_P(ScatterDiffuse, PathsEndAtABlackBack) {
    Scene scene = wall_scene();
    scene.emitters.emplace_back(PointEmitter{{1, 1, -3}, intensity});
    StageBench bench(scene, GetParam());
    bench.fill(QUEUE_DIFFUSE, arriving(bench, {1, 0.5F, 2}, 9));
    bench.run("scatter_diffuse");
    EXPECT_EQ(bench.header().count[QUEUE_DIFFUSE], 0U);
    EXPECT_EQ(bench.header().count[QUEUE_SHADOW], 0U);
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 0U);
}

// An area light: shadow rays end on it, and weigh against the direction that the lobe might have chosen.
TEST_P(ScatterDiffuse, WeighsTheLightSample) {
    Scene scene = wall_scene();
    const int black = add_diffuse(scene, Rgb{0});
    make_emitter(add_quad(scene, {1, 1, 3}, {0, 1, 0}, {1, 0.25F, 0}, black), intensity);  // shines towards -z
    StageBench bench(scene, GetParam());
    const std::vector<TestPath> paths = arriving(bench, from_front, 33);
    bench.fill(QUEUE_DIFFUSE, paths);
    bench.run("scatter_diffuse");
    ASSERT_EQ(bench.header().count[QUEUE_SHADOW], 33U);
    for (std::uint32_t i = 0; i < 33; ++i) {
        const TestShadowRay s = bench.shadow(i);
        const glm::dvec3 direction = glm::normalize(glm::dvec3(s.direction));
        const double distance = 2.0 / direction.z;
        const glm::dvec3 end = position + direction * distance;
        EXPECT_GE(end.x, 1.0 - 1e-5);
        EXPECT_LE(end.x, 2.0 + 1e-5);
        const double edge = 1.0 + 0.25 * (end.x - 1.0);
        EXPECT_GE(end.y, edge - 1e-5);
        EXPECT_LE(end.y, edge + 1.0 + 1e-5);
        EXPECT_LT(s.t, distance) << "the light itself would be in the way";
        // Both ends are moved by 7 roundings of coordinates up to 3, and the reach is 32 of the distance shorter.
        EXPECT_GT(s.t, distance - (2 * 7 * 3 + 32 * distance) * 0x1p-24 - distance * stage_rounding);
        const double light_pdf = distance * distance / direction.z;  // area 1
        const double lobe_pdf = direction.z / pi;
        const double weight = light_pdf * light_pdf / (light_pdf * light_pdf + lobe_pdf * lobe_pdf);
        expect_close(s.contribution, glm::dvec3(paths[i].throughput) * glm::dvec3(albedo) * glm::dvec3(intensity) *
                                         (weight * lobe_pdf / light_pdf));
    }
}

WAVELOBE_AT_EACH_WIDTH(ScatterDiffuse);

}  // namespace
}  // namespace wavelobe::test
