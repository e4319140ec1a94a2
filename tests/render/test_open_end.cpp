// Renders that end by error or by time rather than by a number of samples.
#include <gtest/gtest.h>

#include "scene/mitsuba_reader.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

Scene small_box() {
    Scene scene = read_mitsuba_scene(std::string(WAVELOBE_SOURCE_DIR) + "/scenes/cornell_box.xml", {});
    scene.film.crop_x = 200;
    scene.film.crop_y = 200;
    scene.film.crop_width = 64;
    scene.film.crop_height = 64;
    return scene;
}

double relative_mse(const Image& image, const Image& reference) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const double x = image.rgb[i];
        const double r = reference.rgb[i];
        sum += (x - r) * (x - r) / (r * r + 0.01);
    }
    return sum / static_cast<double>(image.rgb.size());
}

RenderSettings with_target(double target) {
    RenderSettings settings;
    settings.samples_per_pixel = 4096;
    settings.target_error = target;
    return settings;
}

TEST(TargetError, IsReachedAndTheEstimateHonest) {
    const Image reference = render(small_box(), 8192).image;
    const Rendering found = render(small_box(), with_target(1e-3));
    const double truth = relative_mse(found.image, reference);
    EXPECT_LT(truth, 1.2e-3);
    ASSERT_TRUE(found.stats.estimated_error);
    EXPECT_NEAR(*found.stats.estimated_error, truth, 0.2 * truth);
    EXPECT_LT(found.stats.samples, std::uint64_t{64} * 64 * 1024) << "tiles did not stop";
}

TEST(TargetError, DriversAgreeBitForBit) {
    RenderSettings settings = with_target(4e-3);
    const Rendering one_kernel = render(small_box(), settings);
    settings.driver = Driver::staged;
    const Rendering staged = render(small_box(), settings);
    EXPECT_EQ(one_kernel.image.rgb, staged.image.rgb);
    EXPECT_EQ(one_kernel.stats.estimated_error, staged.stats.estimated_error);
}

TEST(TimeLimit, EndsAPictureWithoutHoles) {
    RenderSettings settings;
    settings.samples_per_pixel = 1 << 20;
    settings.time_limit = 0.3;
    const Rendering found = render(small_box(), settings);
    EXPECT_GE(found.stats.samples, std::uint64_t{64} * 64);
    EXPECT_LT(found.stats.samples, (std::uint64_t{64} * 64) << 20);
    for (std::size_t tile = 0; tile < 4; ++tile) {
        double sum = 0.0;
        for (std::size_t y = 0; y < 16; ++y) {
            for (std::size_t x = 0; x < 16; ++x) sum += pixel(found.image, (y + 16 * tile) * 64 + x + 16 * tile).g;
        }
        EXPECT_GT(sum, 0.0) << "tile " << tile;
    }
}

TEST(TimeLimit, LeavesTimeForSomeSamples) {
    RenderSettings settings;
    settings.samples_per_pixel = 1 << 20;
    settings.time_limit = 1e-6;
    EXPECT_GT(render(small_box(), settings).stats.samples, 0U);
}

}  // namespace
}  // namespace wavelobe::test
