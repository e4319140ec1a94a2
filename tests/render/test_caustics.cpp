// Paths that photons guide to caustics: the same mean, with less noise.
#include "render/flatten.h"
#include "support/agreement.h"

namespace wavelobe::test {
namespace {

// A glass ball on a floor, beside a mirror, under a small lamp.
Scene glass_ball() {
    Scene scene = empty_scene(32);
    scene.integrator.max_depth = 8;
    look_at(scene, {0, 2, 4}, {0, 0.2F, 0}, {0, 1, 0}, 40.0F);
    add_floor(scene, 4.0F, add_diffuse(scene, Rgb{0.6F}));
    const int glass = add_material(scene, Dielectric{});
    add_sphere(scene, {-0.4F, 0.5F, 0}, 0.5F, glass).material.back = glass;
    add_quad(scene, {0.8F, 0, -0.6F}, {0.2F, 0, 1}, {0.1F, 1, 0}, add_material(scene, Conductor{}));
    make_emitter(add_quad(scene, {-0.1F, 3, -0.1F}, {0.2F, 0, 0}, {0, 0, 0.2F}, add_diffuse(scene, Rgb{0})), Rgb{200.0F});
    return scene;
}

RenderSettings with(bool guided, std::uint32_t seed, int samples) {
    RenderSettings settings;
    settings.samples_per_pixel = samples;
    settings.seed = seed;
    settings.guide_caustics = guided;
    return settings;
}

double mean_square_difference(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        const double d = static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]), mean = 0.5 * (static_cast<double>(a.rgb[i]) + static_cast<double>(b.rgb[i]));
        sum += d * d / (mean * mean + 0.01);
    }
    return sum / static_cast<double>(a.rgb.size());
}

TEST(Caustics, GuidedPathsFindTheSameLight) {
    const Scene scene = glass_ball();
    const int samples = quick_or_full(1024, 16384);
    expect_agreement("Paths guided to caustics against paths that are not", scene, with(true, 1, samples), scene, with(false, 2, samples));
}

TEST(Caustics, GuidedPathsMakeLessNoise) {
    const Scene scene = glass_ball();
    const auto noise = [&](bool guided) {
        double sum = 0.0;
        for (std::uint32_t seed = 0; seed < 4; ++seed)
            sum += mean_square_difference(render(scene, with(guided, 2 * seed, 128)).image, render(scene, with(guided, 2 * seed + 1, 128)).image);
        return sum;
    };
    EXPECT_LT(noise(true), 0.5 * noise(false));
}

// The maps, and so each bit, are the same however the work is divided.
TEST(Caustics, AreTheSameForEveryDriverAndWidth) {
    const Scene scene = glass_ball();
    RenderSettings settings = with(true, 3, 4);
    const std::vector<float> expected = render(scene, settings).image.rgb;
    settings.driver = Driver::staged;
    EXPECT_EQ(render(scene, settings).image.rgb, expected);
    settings.driver = Driver::one_kernel;
    settings.lanes = 8;
    settings.block_slots = 64;
    EXPECT_EQ(render(scene, settings).image.rgb, expected);
}

TEST(Caustics, AWindowIsAPartOfTheWhole) {
    Scene scene = glass_ball();
    const Image whole = render(scene, with(true, 3, 4)).image;
    scene.film.crop_x = 7;
    scene.film.crop_y = 5;
    scene.film.crop_width = 16;
    scene.film.crop_height = 21;
    const Image window = render(scene, with(true, 3, 4)).image;
    ASSERT_EQ(window.width, 16);
    for (int y = 0; y < window.height; ++y) {
        for (int x = 0; x < window.width; ++x) {
            const auto at = static_cast<std::size_t>(y * window.width + x), in_whole = static_cast<std::size_t>((y + 5) * whole.width + x + 7);
            ASSERT_EQ(pixel(window, at), pixel(whole, in_whole)) << x << ", " << y;
        }
    }
}

bool has_caustics(const Scene& scene) { return flatten_scene(scene).features.caustics; }

TEST(Caustics, AreLookedForOnlyWhereThereCanBeAny) {
    EXPECT_TRUE(has_caustics(glass_ball()));
    Scene short_paths = glass_ball();
    short_paths.integrator.max_depth = 2;
    EXPECT_FALSE(has_caustics(short_paths));
    Scene point_light = glass_ball();
    for (Shape& shape : point_light.shapes) shape.emitter.reset();
    point_light.emitters.emplace_back(PointEmitter{{0, 3, 0}, Rgb{10.0F}});
    EXPECT_FALSE(has_caustics(point_light)) << "no path can hit the light";
    Scene no_glass = glass_ball();
    for (Shape& shape : no_glass.shapes) shape.material.front = shape.material.back = 0;
    EXPECT_FALSE(has_caustics(no_glass));
}

}  // namespace
}  // namespace wavelobe::test
