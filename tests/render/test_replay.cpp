// One path alone: it is the path of the picture, and tells where a sample that is no number comes from.
#include <gtest/gtest.h>

#include "support/many_features.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

Replay replay(const Scene& scene, RenderSettings settings, const SampleName& name) {
    settings.driver = Driver::replay;
    settings.replayed = name;
    Renderer renderer(device(), scene, settings);
    EXPECT_TRUE(renderer.render());
    return renderer.stats().replay;
}

TEST(Replay, IsThePathOfThePicture) {
    Scene scene = many_features_scene(48, 33);
    scene.film.crop_x = 5;
    scene.film.crop_y = 3;
    scene.film.crop_width = 40;
    scene.film.crop_height = 30;
    RenderSettings settings;
    settings.seed = 3;
    settings.samples_per_pixel = 18;
    const Image two = render(scene, settings).image;
    settings.samples_per_pixel = 17;
    const Image one = render(scene, settings).image;
    std::size_t longest = 0;
    for (const glm::ivec2 at : {glm::ivec2{5, 3}, {44, 32}, {23, 19}, {12, 27}, {30, 22}, {38, 25}}) {
        const Replay found = replay(scene, settings, {at.x, at.y, 17});
        EXPECT_EQ(found.broken_by, "");
        longest = std::max(longest, found.vertices.size());
        const auto i = static_cast<std::size_t>((at.y - 3) * 40 + at.x - 5);
        // The eighteenth sample is what the mean of eighteen has beside that of seventeen, to the rounding of the two.
        const glm::dvec3 expected = 18.0 * pixel(two, i) - 17.0 * pixel(one, i);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.radiance[c], expected[c], 36 * 0x1p-24 * pixel(two, i)[c]) << at.x << "," << at.y;
    }
    EXPECT_GT(longest, 3U);
}

TEST(Replay, TellsOfEachVertex) {
    Scene scene = empty_scene(16);
    look_at_point(scene, {0, 3, 0}, {0, 0, 0});
    add_floor(scene, 20.0F, add_material(scene, Conductor{}));
    scene.emitters.emplace_back(ConstantEmitter{Rgb{2.0F}});
    const Replay found = replay(scene, {}, {4, 5, 0});
    ASSERT_EQ(found.vertices.size(), 2U);
    EXPECT_EQ(found.vertices[0].stage, "scatter_delta");
    EXPECT_EQ(found.vertices[0].shape, 0U);
    EXPECT_NEAR(found.vertices[0].distance, 3.0 - 1e-4, 1e-5) << "from the near clipping plane";
    EXPECT_NEAR(found.vertices[0].position.y, 0.0, 1e-6);
    EXPECT_EQ(found.vertices[1].stage, "shade_escaped");
    EXPECT_EQ(found.vertices[1].depth, 1U);
    EXPECT_FALSE(found.vertices[1].shape);
    EXPECT_NEAR(found.vertices[1].direction.y, 1.0, 1e-6);
    EXPECT_EQ(found.vertices[1].radiance, found.radiance);
}

TEST(Replay, FindsWhereASampleBroke) {
    Scene scene = empty_scene(16);
    look_at(scene, {0, 3, 0}, {0, 0, 0}, {0, 0, 1}, 40.0F);
    add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
    // Beyond what floats hold up to a distance of 0.54.
    scene.emitters.emplace_back(PointEmitter{{0, 0.01F, 0}, Rgb{1e38F, 1, 1}});
    RenderSettings settings;
    settings.samples_per_pixel = 2;
    for (const Driver driver : {Driver::one_kernel, Driver::staged}) {
        settings.driver = driver;
        Renderer renderer(device(), scene, settings);
        EXPECT_TRUE(renderer.render());
        const RenderStats& stats = renderer.stats();
        EXPECT_GT(stats.nan_samples, 50U);
        EXPECT_LT(stats.nan_samples, 256U);
        ASSERT_FALSE(stats.nan_examples.empty());
        EXPECT_EQ(stats.nan_examples[0].stage, "scatter_diffuse");
        const Replay found = replay(scene, settings, stats.nan_examples[0].name);
        EXPECT_EQ(found.broken_by, "scatter_diffuse");
        EXPECT_FALSE(std::isfinite(found.radiance.x));
    }
}

}  // namespace
}  // namespace wavelobe::test
