// What is no finite number ends a path, and its sample is counted with the stage that met it first: it is never dropped unseen.
#include <gtest/gtest.h>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

class BrokenSamples : public StageTest {};

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

// A quad of each class of lobes, and an emitter, in y = 1 with normals up.
Scene surfaces() {
    Scene scene = empty_scene(16);
    scene.integrator.rr_depth = 1000;
    const int materials[] = {add_diffuse(scene, Rgb{0.5F}), add_material(scene, Conductor{}), add_material(scene, RoughConductor{}),
                             add_material(scene, Plastic{1.5F, constant(0.5F), constant(1.0F), false}), 0};
    for (int i = 0; i < 5; ++i) add_quad(scene, {static_cast<float>(2 * i), 1, 0}, {0, 0, 1}, {1, 0, 0}, materials[i]);
    make_emitter(scene.shapes.back(), {3, 2, 1});
    scene.emitters.emplace_back(ConstantEmitter{});
    return scene;
}

std::vector<TestPath> falling_on(const StageBench& bench, std::uint32_t triangle) {
    std::vector<TestPath> paths(37);
    for (std::uint32_t i = 0; i < paths.size(); ++i) {
        TestPath& p = paths[i];
        p.hit = triangle == HIT_NONE ? HIT_NONE : bench.slot_of(triangle);
        p.direction = glm::normalize(glm::vec3{0.2F, -1, 0.1F});
        p.t = 2.0F;
        p.u = 0.25F;
        p.v = 0.5F;
        p.id = i * 5 % TILE_PIXELS;
        p.pdf = 0.5F;
    }
    return paths;
}

struct Break {
    const char* stage_name;
    std::uint32_t stage;
    std::uint32_t queue;
    std::uint32_t triangle;
};

constexpr Break breaks[] = {{"scatter_diffuse", STAGE_SCATTER_DIFFUSE, QUEUE_DIFFUSE, 1},
                            {"scatter_delta", STAGE_SCATTER_DELTA, QUEUE_DELTA, 2},
                            {"scatter_glossy", STAGE_SCATTER_GLOSSY, QUEUE_GLOSSY, 4},
                            {"shade_emitted", STAGE_SHADE_EMITTED, QUEUE_EMITTED, 8},
                            {"shade_escaped", STAGE_SHADE_ESCAPED, QUEUE_ESCAPED, HIT_NONE}};

TEST_P(BrokenSamples, AreCountedWithTheirStage) {
    StageBench bench(surfaces(), GetParam());
    for (const Break& b : breaks) {
        for (const float poison : {nan, infinity}) {
            std::vector<TestPath> paths = falling_on(bench, b.triangle);
            paths[7].throughput.y = poison;
            paths[30].throughput.x = -poison;
            const BlockHeader fresh = bench.header();
            bench.fill(b.queue, paths);
            bench.run(b.stage_name);
            for (std::uint32_t i = 0; i < bench.header().count[QUEUE_RAYS]; ++i) {
                const std::uint32_t id = bench.path(QUEUE_RAYS, i).id;
                EXPECT_NE(id, paths[7].id) << b.stage_name << ": the path goes on";
                EXPECT_NE(id, paths[30].id) << b.stage_name << ": the path goes on";
            }
            for (std::uint32_t queue = 0; queue < QUEUE_COUNT; ++queue) bench.header().count[queue] = 0;
            bench.run("accumulate");
            std::uint32_t broken = 0;
            for (FilmPixel& pixel : bench.film()) {
                broken += pixel.nonfinite;
                pixel = {};
            }
            EXPECT_EQ(broken, 2U) << b.stage_name << ", " << poison;
            EXPECT_EQ(bench.header().nonfinite_stage, b.stage) << b.stage_name;
            const std::uint32_t named = bench.header().nonfinite_path;
            EXPECT_TRUE(named == paths[7].id || named == paths[30].id) << b.stage_name;
            bench.header() = fresh;
        }
    }
}

// Most lobes are zero for a direction that is none: it is not their value that tells.
TEST_P(BrokenSamples, OfADirectionThatIsNone) {
    StageBench bench(surfaces(), GetParam());
    std::vector<TestPath> paths = falling_on(bench, 6);
    paths[3].direction = {nan, nan, nan};
    bench.fill(QUEUE_RAYS, paths);
    bench.run("sort_paths");
    bench.run("scatter_delta");
    bench.run("scatter_diffuse");
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 36U);
    for (std::uint32_t queue = 0; queue < QUEUE_COUNT; ++queue) bench.header().count[queue] = 0;
    bench.run("accumulate");
    EXPECT_EQ(bench.header().nonfinite_path, paths[3].id);
}

WAVELOBE_AT_EACH_WIDTH(BrokenSamples);

}  // namespace
}  // namespace wavelobe::test
