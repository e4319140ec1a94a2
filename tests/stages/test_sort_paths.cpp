#include <gtest/gtest.h>

#include "support/lobe_reference.h"
#include "support/stage.h"

namespace wavelobe::test {
namespace {

class SortPaths : public StageTest {};

constexpr std::uint32_t traced_queues[] = {QUEUE_ESCAPED, QUEUE_EMITTED, QUEUE_DELTA, QUEUE_GLOSSY, QUEUE_DIFFUSE};

// Triangles 0, 1: diffuse; 2, 3: mirror; 4, 5: rough metal; 6, 7: a diffuse light. All in y = 1, normals up.
Scene four_surfaces(bool environment = true) {
    Scene scene = empty_scene(16);
    const int materials[] = {add_diffuse(scene, Rgb{0.5F}), add_material(scene, Conductor{}),
                             add_material(scene, RoughConductor{}), 0};
    for (int i = 0; i < 4; ++i) add_quad(scene, {static_cast<float>(2 * i), 1, 0}, {0, 0, 1}, {1, 0, 0}, materials[i]);
    make_emitter(scene.shapes.back(), {3, 2, 1});
    if (environment) scene.emitters.emplace_back(ConstantEmitter{});
    return scene;
}

TestPath falling_on(const StageBench& bench, std::uint32_t triangle, std::uint32_t id) {
    TestPath p;
    p.hit = triangle == HIT_NONE ? HIT_NONE : bench.slot_of(triangle);
    p.direction = {0, -1, 0};
    p.t = 2.0F;
    p.u = 0.25F;
    p.v = 0.5F;
    p.id = id;
    p.throughput = glm::vec3(1, 0.5F, 0.25F) * static_cast<float>(1 + id % 3);
    p.pdf = 0.125F;
    return p;
}

void expect_same_path(const TestPath& found, const TestPath& expected) {
    EXPECT_EQ(found.t, expected.t);
    EXPECT_EQ(found.hit, expected.hit);
    EXPECT_EQ(found.u, expected.u);
    EXPECT_EQ(found.v, expected.v);
    EXPECT_EQ(found.direction, expected.direction);
    EXPECT_EQ(found.throughput, expected.throughput);
    EXPECT_EQ(found.pdf, expected.pdf);
    EXPECT_EQ(found.depth, expected.depth);
}

TEST_P(SortPaths, EachGoesWhereItsHitSays) {
    StageBench bench(four_surfaces(), GetParam());
    const std::uint32_t triangles[] = {0, 2, 5, 7, HIT_NONE, 1, 3};
    const std::vector<std::vector<std::uint32_t>> goes = {
        {QUEUE_DIFFUSE}, {QUEUE_DELTA},   {QUEUE_GLOSSY}, {QUEUE_EMITTED, QUEUE_DIFFUSE},
        {QUEUE_ESCAPED}, {QUEUE_DIFFUSE}, {QUEUE_DELTA}};
    std::vector<TestPath> paths;
    std::vector<std::vector<std::uint32_t>> expected(QUEUE_COUNT);
    for (std::uint32_t id = 0; id < 53; ++id) {
        paths.push_back(falling_on(bench, triangles[id % 7], id));
        for (const std::uint32_t queue : goes[id % 7]) expected[queue].push_back(id);
    }
    bench.fill(QUEUE_RAYS, paths);
    bench.run("sort_paths");
    EXPECT_EQ(bench.header().traced, 53U);
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 0U);
    for (const std::uint32_t queue : traced_queues) {
        EXPECT_EQ(bench.ids(queue), expected[queue]) << "queue " << queue << ", in order";
        for (std::uint32_t i = 0; i < bench.header().count[queue]; ++i) {
            const TestPath p = bench.path(queue, i);
            expect_same_path(p, paths[p.id]);
        }
    }
}

// The last vertex may shine, and does not scatter.
TEST_P(SortPaths, PathsEndAtTheGreatestDepth) {
    Scene scene = four_surfaces();
    scene.integrator.max_depth = 3;
    StageBench bench(scene, GetParam());
    std::vector<TestPath> paths;
    const std::uint32_t triangles[] = {0, 2, 4, 6, HIT_NONE};
    for (std::uint32_t id = 0; id < 10; ++id) {
        paths.push_back(falling_on(bench, triangles[id % 5], id));
        paths.back().depth = id < 5 ? 1 : 2;
    }
    bench.fill(QUEUE_RAYS, paths);
    bench.run("sort_paths");
    using Ids = std::vector<std::uint32_t>;
    EXPECT_EQ(bench.ids(QUEUE_DIFFUSE), (Ids{0, 3}));
    EXPECT_EQ(bench.ids(QUEUE_DELTA), (Ids{1}));
    EXPECT_EQ(bench.ids(QUEUE_GLOSSY), (Ids{2}));
    EXPECT_EQ(bench.ids(QUEUE_EMITTED), (Ids{3, 8}));
    EXPECT_EQ(bench.ids(QUEUE_ESCAPED), (Ids{4, 9}));
}

TEST_P(SortPaths, MissesEndWithoutAnEnvironment) {
    StageBench bench(four_surfaces(false), GetParam());
    std::vector<TestPath> paths;
    for (std::uint32_t id = 0; id < 40; ++id) paths.push_back(falling_on(bench, id % 4 == 0 ? 0 : HIT_NONE, id));
    bench.fill(QUEUE_RAYS, paths);
    bench.run("sort_paths");
    EXPECT_EQ(bench.ids(QUEUE_DIFFUSE), (std::vector<std::uint32_t>{0, 4, 8, 12, 16, 20, 24, 28, 32, 36}));
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 0U);
}

// Plastic: a path goes on by the coat or by the base, with the chances of their weights, and its throughput makes up
// for it.
TEST_P(SortPaths, ChoosesAClassOfLobes) {
    Scene scene = empty_scene(16);
    add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0},
             add_material(scene, Plastic{1.5F, constant(0.5F), constant(1.0F), false}));
    // Enough to know the chances by; an interpreter that looks for errors of memory is served with less.
    const std::uint32_t count = device().info().platform.find("Oclgrind") == std::string::npos ? 1024 : 64;
    StageBench bench(scene, GetParam(), static_cast<int>(count));
    const glm::vec3 direction = glm::normalize(glm::vec3{3, -1, 0});
    std::vector<TestPath> paths;
    for (std::uint32_t id = 0; id < count; ++id) {
        paths.push_back(falling_on(bench, 0, id));
        paths.back().direction = direction;
    }
    bench.fill(QUEUE_RAYS, paths);
    bench.run("sort_paths");
    const double fresnel = reference_fresnel_dielectric(-static_cast<double>(direction.y), 1.5);
    const double coat = fresnel * 2.0 / 3.0;  // share of the specular reflectance: 1 of 1 + 0.5
    const double base = (1.0 - fresnel) / 3.0;
    const double chance = coat / (coat + base);
    const auto chosen = static_cast<double>(bench.header().count[QUEUE_DELTA]);
    EXPECT_EQ(bench.header().count[QUEUE_DELTA] + bench.header().count[QUEUE_DIFFUSE], count);
    EXPECT_NEAR(chosen, chance * count, 4.5 * std::sqrt(count * chance * (1.0 - chance)));
    for (const std::uint32_t queue : {QUEUE_DELTA, QUEUE_DIFFUSE}) {
        const double probability = queue == QUEUE_DELTA ? chance : 1.0 - chance;
        for (std::uint32_t i = 0; i < bench.header().count[queue]; ++i) {
            const TestPath p = bench.path(queue, i);
            expect_close(p.throughput, glm::dvec3(paths[p.id].throughput) / probability);
        }
    }
}

// Camera rays go on behind hidden lights; others see them.
TEST_P(SortPaths, HiddenEmittersArePassed) {
    Scene scene = four_surfaces();
    scene.integrator.hide_emitters = true;
    StageBench bench(scene, GetParam());
    std::vector<TestPath> paths;
    for (std::uint32_t id = 0; id < 20; ++id) {
        paths.push_back(falling_on(bench, id % 2 == 0 ? 6 : 0, id));
        paths.back().depth = id < 10 ? 0 : 1;
    }
    bench.fill(QUEUE_RAYS, paths);
    bench.run("sort_paths");
    using Ids = std::vector<std::uint32_t>;
    EXPECT_EQ(bench.ids(QUEUE_RAYS), (Ids{0, 2, 4, 6, 8}));
    EXPECT_EQ(bench.ids(QUEUE_EMITTED), (Ids{10, 12, 14, 16, 18}));
    EXPECT_EQ(bench.ids(QUEUE_DIFFUSE), (Ids{1, 3, 5, 7, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}));
    for (std::uint32_t i = 0; i < 5; ++i) {
        const TestPath p = bench.path(QUEUE_RAYS, i);
        EXPECT_LT(p.origin.y, 1.0F) << "behind the light";
        EXPECT_GT(p.origin.y, 1.0F - 1e-5F);
        // The hit's barycentrics are 0.25 and 0.5 on the triangle (6, 1, 0), (6, 1, 1), (7, 1, 1).
        EXPECT_NEAR(p.origin.x, 6.5, 1e-5);
        EXPECT_NEAR(p.origin.z, 0.75, 1e-5);
        EXPECT_EQ(p.t, std::numeric_limits<float>::infinity());
        EXPECT_EQ(p.depth, 0U);
        EXPECT_EQ(p.direction, glm::vec3(0, -1, 0));
        EXPECT_EQ(p.throughput, paths[p.id].throughput);
    }
}

WAVELOBE_AT_EACH_WIDTH(SortPaths);

}  // namespace
}  // namespace wavelobe::test
