#include <gtest/gtest.h>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

class ShadeEscaped : public StageTest {};

const Rgb sky{0.5F, 1.0F, 2.0F};
constexpr double sky_pdf = 0.25 / 3.14159265358979323846;

std::vector<TestPath> escaped(std::uint32_t count, float pdf) {
    std::vector<TestPath> paths(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        paths[i].id = (i * 37) % TILE_PIXELS;
        paths[i].throughput = glm::vec3(1, 0.5F, 0.25F) * static_cast<float>(i + 1);
        paths[i].pdf = pdf;
        paths[i].depth = pdf < 0.0F ? 0 : 2;
    }
    return paths;
}

// No light sample could have made what the camera or a delta lobe sees: the whole radiance counts.
TEST_P(ShadeEscaped, AddsTheWholeRadianceWithoutADensity) {
    Scene scene = empty_scene(16);
    scene.emitters.emplace_back(ConstantEmitter{sky});
    StageBench bench(scene, GetParam());
    const std::vector<TestPath> paths = escaped(21, -1.0F);
    bench.radiance(paths[2].id, 0) = 4.0F;
    bench.fill(QUEUE_ESCAPED, paths);
    bench.run("shade_escaped");
    EXPECT_EQ(bench.header().count[QUEUE_ESCAPED], 0U);
    for (const TestPath& p : paths) {
        const glm::vec3 before = p.id == paths[2].id ? glm::vec3(4, 0, 0) : glm::vec3(0);
        EXPECT_EQ(bench.radiance(p.id), before + p.throughput * sky);
    }
    EXPECT_EQ(bench.radiance(1), glm::vec3(0)) << "a path that did not escape";
}

TEST_P(ShadeEscaped, WeighsAgainstTheLightSample) {
    for (const bool alone : {true, false}) {
        Scene scene = empty_scene(16);
        add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
        scene.emitters.emplace_back(ConstantEmitter{sky});
        if (!alone) scene.emitters.emplace_back(PointEmitter{{0, 1, 0}, Rgb{3.0F}});
        StageBench bench(scene, GetParam());
        const double choice = static_cast<double>(bench.scene().lights.back().selection_probability);
        EXPECT_EQ(alone, choice == 1.0);
        for (const float pdf : {0.01F, 0.2F, 1e6F}) {
            const std::vector<TestPath> paths = escaped(5, pdf);
            for (const TestPath& p : paths) {
                for (std::uint32_t c = 0; c < 3; ++c) bench.radiance(p.id, c) = 0.0F;
            }
            bench.fill(QUEUE_ESCAPED, paths);
            bench.run("shade_escaped");
            const double p2 = static_cast<double>(pdf) * static_cast<double>(pdf);
            const double l2 = choice * choice * sky_pdf * sky_pdf;
            for (const TestPath& p : paths) {
                expect_close(bench.radiance(p.id), glm::dvec3(p.throughput) * glm::dvec3(sky) * p2 / (p2 + l2));
            }
        }
    }
}

TEST_P(ShadeEscaped, HiddenFromTheCameraAlone) {
    Scene scene = empty_scene(16);
    scene.integrator.hide_emitters = true;
    scene.emitters.emplace_back(ConstantEmitter{sky});
    StageBench bench(scene, GetParam());
    std::vector<TestPath> paths = escaped(2, -1.0F);
    paths[1].depth = 1;  // by way of a mirror
    bench.fill(QUEUE_ESCAPED, paths);
    bench.run("shade_escaped");
    EXPECT_EQ(bench.radiance(paths[0].id), glm::vec3(0));
    EXPECT_EQ(bench.radiance(paths[1].id), paths[1].throughput * sky);
}

WAVELOBE_AT_EACH_WIDTH(ShadeEscaped);

}  // namespace
}  // namespace wavelobe::test
