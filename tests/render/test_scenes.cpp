// The scenes of scenes/: each renders without a fault, and those with a known value have it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/render.h"

namespace wavelobe::test {
namespace {

const std::filesystem::path folder = std::filesystem::path(WAVELOBE_SOURCE_DIR) / "scenes";

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".xml") names.push_back(entry.path().stem());
    }
    std::sort(names.begin(), names.end());
    return names;
}

Scene read(const std::string& name) {
    return read_mitsuba_scene((folder / (name + ".xml")).string(), {{"width", "96"}, {"height", "64"}});
}

class Scenes : public testing::TestWithParam<std::string> {};

TEST_P(Scenes, Render) {
    const Scene scene = read(GetParam());
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    const Rendering rendering = render(scene, 16);
    ASSERT_EQ(rendering.image.rgb.size(), std::size_t{3} * 96 * 64);
    EXPECT_EQ(rendering.stats.samples, std::uint64_t{96} * 64 * 16);
    double sum = 0.0;
    for (const float value : rendering.image.rgb) {
        ASSERT_TRUE(std::isfinite(value));
        ASSERT_GE(value, 0.0F);
        sum += static_cast<double>(value);
    }
    EXPECT_GT(sum / static_cast<double>(rendering.image.rgb.size()), 0.1);
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scene_names()), [](const auto& name) { return name.param; });

TEST(WhiteFurnace, CannotBeSeen) {
    const Rendering rendering = render(read("white_furnace"), 64);
    expect_mean(rendering.image, glm::dvec3{1.0});
}

}  // namespace
}  // namespace wavelobe::test
