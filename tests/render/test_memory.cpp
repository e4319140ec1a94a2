// What is said of memory before a scene is rendered.
#include <gtest/gtest.h>

#include <cmath>

#include "render/memory.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

// Waves of n x n squares.
TriangleMesh waves(int n) {
    TriangleMesh mesh;
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column) {
            const float x = 2.0F * static_cast<float>(column) / static_cast<float>(n) - 1.0F, y = 2.0F * static_cast<float>(row) / static_cast<float>(n) - 1.0F;
            mesh.positions.emplace_back(x, y, 5.0F + 0.1F * std::sin(20.0F * x) * std::cos(17.0F * y));
        }
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(n); ++row)
        for (std::uint32_t column = 0; column < static_cast<std::uint32_t>(n); ++column) {
            const std::uint32_t a = row * static_cast<std::uint32_t>(n + 1) + column, c = a + static_cast<std::uint32_t>(n) + 2;
            mesh.triangles.emplace_back(a, a + 1, c);
            mesh.triangles.emplace_back(a, c, c - 1);
        }
    return mesh;
}

Scene scene_of_waves(int n) {
    Scene scene = empty_scene(16);
    scene.emitters.emplace_back(ConstantEmitter{{1, 1, 1}});
    look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 20.0F);
    add_shape(scene, waves(n), add_diffuse(scene, Rgb{0.5F}), "waves");
    return scene;
}

// Of each triangle: what a mesh of 80,000 takes more than one of 5,000, in buffers that were really made.
TEST(Memory, BuffersOfAMesh) {
    const Scene large = scene_of_waves(200), small = scene_of_waves(50);
    const auto more = static_cast<double>(render(large, 1).stats.device_bytes - render(small, 1).stats.device_bytes);
    EXPECT_NEAR(static_cast<double>(summarize(large).device_bytes - summarize(small).device_bytes), more, 0.3 * more);
}

// At least what is held at once: the scene, its arrays, the buffers.
TEST(Memory, PeakHoldsItsParts) {
    const Scene scene = scene_of_waves(100);
    const SceneSummary summary = summarize(scene);
    const RenderStats stats = render(scene, 1).stats;
    EXPECT_EQ(stats.expected_peak_bytes, summary.peak_bytes);
    EXPECT_GT(summary.peak_bytes, summary.device_bytes + 20000U * 36U);
}

TEST(Memory, WhatCannotFitIsRefusedWithTheSum) {
    const MemoryEstimate estimate{std::uint64_t{3} << 30U, std::uint64_t{7} << 30U};
    EXPECT_NO_THROW(refuse_beyond(estimate, std::uint64_t{7} << 30U));
    try {
        refuse_beyond(estimate, std::uint64_t{6} << 30U);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("takes about 7168 MiB of memory, 3072 MiB of them the kernels' buffers; the machine has 6144 MiB"),
                  std::string::npos);
    }
    EXPECT_GT(physical_memory(), std::uint64_t{1} << 28U);
}

}  // namespace
}  // namespace wavelobe::test
