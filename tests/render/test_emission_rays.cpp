// Emitters as small as a pixel, which the camera looks for with rays of their own: the same picture with less noise.
#include <gtest/gtest.h>

#include <random>

#include "render/emission_rays.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

constexpr int width = 40;
constexpr int height = 30;

// A floor under lamps of half a pixel a side that look up at the camera, one in four pixels, beneath a dim sky.
Scene small_lamps(int lamps = 300) {
    Scene scene = empty_scene(width);
    scene.film.height = scene.film.crop_height = height;
    look_at(scene, {0, 8, 0}, {0, 0, 0}, {0, 0, 1}, 53.13F);  // the floor's square of 8, 0.2 a pixel
    scene.emitters.emplace_back(ConstantEmitter{Rgb{0.3F, 0.2F, 0.1F}});
    add_floor(scene, 10.0F, add_diffuse(scene, Rgb{0.6F}));
    const int black = add_diffuse(scene, Rgb{0.0F});
    std::mt19937 random{5};
    std::uniform_real_distribution<float> place{-3.9F, 3.8F};
    for (int i = 0; i < lamps; ++i) {
        const glm::vec3 corner{place(random), 0.1F, 0.75F * place(random)};
        make_emitter(add_quad(scene, corner, {0, 0, 0.1F}, {0.1F, 0, 0}, black), {4, 8, 16});
    }
    return scene;
}

RenderSettings settings_of(std::optional<int> rays, int samples, std::uint32_t seed = 0) {
    RenderSettings settings;
    settings.emission_rays = rays;
    settings.samples_per_pixel = samples;
    settings.seed = seed;
    return settings;
}

int rays_of(const Scene& scene) { return emission_rays(flatten_scene(scene), scene.camera, scene.film); }
double coverage_of(const Scene& scene) { return partial_coverage(flatten_scene(scene), scene.camera, scene.film); }

double mean_square_difference(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        const double d = static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]);
        sum += d * d;
    }
    return sum / static_cast<double>(a.rgb.size());
}

TEST(EmissionRays, ServeEmittersOfAboutAPixel) {
    EXPECT_GT(rays_of(small_lamps()), 0);
    EXPECT_EQ(rays_of(small_lamps(0)), 0) << "no emitter has a shape";
    EXPECT_EQ(rays_of(small_lamps(5)), 0) << "too few to be worth it";
    Scene window = small_lamps();
    window.film.crop_width = 3;
    EXPECT_EQ(rays_of(window), rays_of(small_lamps())) << "whatever part of the film is rendered";
    Scene turned = small_lamps();
    look_at(turned, {0, 8, 0}, {0, 16, 0}, {0, 0, 1}, 53.13F);
    EXPECT_EQ(rays_of(turned), 0) << "they are behind the camera";
    Scene below = small_lamps();
    look_at(below, {0, -8, 0}, {0, 0, 0}, {0, 0, 1}, 53.13F);
    EXPECT_EQ(rays_of(below), 0) << "they look away";
}

// What is covered wholly is no matter of luck, however small the triangles.
TEST(EmissionRays, DenseMeshesAreNoSmallEmitters) {
    Scene scene = small_lamps(0);
    TriangleMesh mesh;
    constexpr unsigned side = 100;
    for (unsigned i = 0; i <= side; ++i)
        for (unsigned j = 0; j <= side; ++j) mesh.positions.emplace_back(0.1F * static_cast<float>(i) - 5, 0.1F, 0.1F * static_cast<float>(j) - 5);
    for (unsigned i = 0; i < side; ++i) {
        for (unsigned j = 0; j < side; ++j) {
            const unsigned at = i * (side + 1) + j;
            mesh.triangles.emplace_back(at, at + 1, at + side + 2);
            mesh.triangles.emplace_back(at, at + side + 2, at + side + 1);
        }
    }
    TriangleMesh half = mesh;
    half.triangles.clear();
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 2) half.triangles.push_back(mesh.triangles[i]);
    Scene sparse = scene;
    make_emitter(add_shape(sparse, half, add_diffuse(sparse, Rgb{0}), "half of them"), Rgb{1});
    EXPECT_GT(coverage_of(sparse), 0.1);
    make_emitter(add_shape(scene, mesh, add_diffuse(scene, Rgb{0}), "all"), Rgb{1});
    EXPECT_LT(coverage_of(scene), 0.01);
}

// Of lamps that cover the share c of each pixel by themselves: c (1 - c), by hand.
TEST(EmissionRays, CoverageIsThatOfTheFilm) {
    Scene scene = small_lamps(0);
    make_emitter(add_quad(scene, {0.05F, 0, 0.05F}, {0, 0, 0.1F}, {0.1F, 0, 0}, add_diffuse(scene, Rgb{0})), Rgb{1});
    EXPECT_NEAR(coverage_of(scene), 0.25 * 0.75 / (width * height), 1e-3 / (width * height));
    make_emitter(add_triangle(scene, {-0.05F, 0, 0.05F}, {-0.05F, 0, 0.15F}, {0.05F, 0, 0.15F}, 0), Rgb{1});
    // Half of two boxes of 0.05 by 0.1, one in each of two pixels: in the right one beside the square.
    const double left = 0.0625, right = 0.25 + 0.0625;
    EXPECT_NEAR(coverage_of(scene), (left * (1 - left) + right * (1 - right)) / (width * height), 1e-3 / (width * height));
}

TEST(EmissionRays, ChangeNoMeanAndTakeMostOfTheNoise) {
    const Scene scene = small_lamps();
    const Image truth = render(scene, settings_of(0, 8192)).image;
    const Image with = render(scene, settings_of(std::nullopt, 1024, 1)).image;
    const PictureMean expected = picture_mean(truth), found = picture_mean(with);
    const double difference = mean_square_difference(truth, with);
    for (glm::length_t c = 0; c < 3; ++c) EXPECT_NEAR(found.mean[c] / expected.mean[c], 1.0, 0.002) << "channel " << c;
    const double noise = mean_square_difference(render(scene, settings_of(0, 16, 2)).image, truth);
    const double less = mean_square_difference(render(scene, settings_of(std::nullopt, 16, 2)).image, truth);
    EXPECT_LT(less, 0.25 * noise);
    EXPECT_LT(difference, 0.05 * noise);
}

TEST(EmissionRays, SameBitsHoweverTheWorkIsDivided) {
    const Scene scene = small_lamps();
    RenderSettings settings = settings_of(std::nullopt, 18);
    const Image reference = render(scene, settings).image;
    settings.driver = Driver::staged;
    settings.block_slots = 64;
    EXPECT_EQ(render(scene, settings).image.rgb, reference.rgb);
    settings.driver = Driver::one_kernel;
    settings.lanes = 1;
    settings.block_slots = 8192;
    EXPECT_EQ(render(scene, settings).image.rgb, reference.rgb);
    Scene window = scene;
    window.film.crop_x = 7;
    window.film.crop_y = 5;
    window.film.crop_width = window.film.crop_height = 20;
    const Image part = render(window, settings_of(std::nullopt, 18)).image;
    for (std::size_t i = 0; i < 400; ++i) ASSERT_EQ(pixel(part, i), pixel(reference, (i / 20 + 5) * width + i % 20 + 7));
}

TEST(EmissionRays, ReplayFollowsThemToo) {
    const Scene scene = small_lamps();
    RenderSettings settings = settings_of(std::nullopt, 1);
    const Image picture = render(scene, settings).image;
    settings.driver = Driver::replay;
    std::size_t told = 0;
    for (int i = 0; i < width * height; i += 37) {
        settings.replayed = {i % width, i / width, 0};
        Renderer renderer(device(), scene, settings);
        EXPECT_TRUE(renderer.render());
        const Replay& replay = renderer.stats().replay;
        ASSERT_EQ(glm::dvec3(replay.radiance), pixel(picture, static_cast<std::size_t>(i))) << i;
        for (const Replay::Vertex& v : replay.vertices) told += v.emission_ray ? 1 : 0;
    }
    EXPECT_GT(told, 30U);
}

// Layers show what the paths meet.
TEST(EmissionRays, LeaveLayersAsTheyAre) {
    Scene scene = small_lamps();
    scene.integrator.channels = {{"depth", LayerKind::depth, 0, false}, {"nn.X", LayerKind::sh_normal, 0, false}};
    const Image with = render(scene, settings_of(std::nullopt, 20)).image, without = render(scene, settings_of(0, 20)).image;
    ASSERT_FALSE(with.channels.empty());
    for (std::size_t c = 0; c < with.channels.size(); ++c) EXPECT_EQ(with.channels[c].values, without.channels[c].values);
}

}  // namespace
}  // namespace wavelobe::test
