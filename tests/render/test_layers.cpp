// Channels beside the colours, in whole pictures, against what the geometry says.
#include <algorithm>
#include <cstring>

#include "support/render.h"

namespace wavelobe::test {
namespace {

void ask(Scene& scene, LayerKind kind, int width, bool squared = false) {
    for (int i = 0; i < width; ++i)
        scene.integrator.channels.push_back({std::to_string(static_cast<int>(kind)) + "." + std::to_string(i) + (squared ? "^2" : ""), kind, i, squared});
}

const std::vector<float>& values(const Image& image, const Scene& scene, LayerKind kind, int component, bool squared = false) {
    for (std::size_t i = 0; i < scene.integrator.channels.size(); ++i) {
        const PictureChannel& c = scene.integrator.channels[i];
        if (c.kind == kind && c.component == component && c.squared == squared) return image.channels.at(i).values;
    }
    throw std::runtime_error("no such channel");
}

void ask_for_all(Scene& scene) {
    using K = LayerKind;
    for (const auto& [kind, width] : std::vector<std::pair<K, int>>{{K::coverage, 1}, {K::albedo, 3}, {K::depth, 1}, {K::position, 3}, {K::uv, 2},
                                                                     {K::geo_normal, 3}, {K::sh_normal, 3}, {K::dp_du, 3}, {K::dp_dv, 3},
                                                                     {K::duv_dx, 2}, {K::duv_dy, 2}, {K::prim_index, 1}, {K::shape_index, 1}})
        ask(scene, kind, width);
}

// A wall of 8 x 8 at z = 2, more than fills the picture, its texture coordinates growing with -x and y, and a light.
Scene wall_scene() {
    Scene scene = empty_scene(16);
    look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90.0F);
    add_quad(scene, {4, -4, 2}, {-8, 0, 0}, {0, 8, 0}, add_diffuse(scene, {0.2F, 0.5F, 0.7F}));
    scene.emitters.emplace_back(PointEmitter{{0, 0, 0}, Rgb{1}});
    return scene;
}

TEST(Layers, OfAWallThatFillsThePicture) {
    Scene scene = wall_scene();
    ask_for_all(scene);
    ask(scene, LayerKind::depth, 1, true);
    const int samples = 64;
    const Image image = render(scene, samples).image;
    ASSERT_EQ(image.channels.size(), scene.integrator.channels.size());
    using K = LayerKind;
    const auto at = [&](K kind, int component, std::size_t i, bool squared = false) {
        return static_cast<double>(values(image, scene, kind, component, squared)[i]);
    };
    for (std::size_t i = 0; i < 256; ++i) {
        // Means over a pixel, which a stratified sample knows to a few hundredths of it.
        const double x = 2.0 - 4.0 * (static_cast<double>(i % 16) + 0.5) / 16, y = 2.0 - 4.0 * (static_cast<double>(i / 16) + 0.5) / 16;
        const double slack = 0.02;
        EXPECT_EQ(at(K::coverage, 0, i), 1.0);
        EXPECT_NEAR(at(K::albedo, 0, i), 0.2, 1e-6);
        EXPECT_NEAR(at(K::albedo, 1, i), 0.5, 1e-6);
        EXPECT_NEAR(at(K::albedo, 2, i), 0.7, 1e-6);
        EXPECT_NEAR(at(K::position, 0, i), x, slack);
        EXPECT_NEAR(at(K::position, 1, i), y, slack);
        EXPECT_NEAR(at(K::position, 2, i), 2.0, 1e-6);
        EXPECT_NEAR(at(K::uv, 0, i), 0.5 - x / 8, slack / 8);
        EXPECT_NEAR(at(K::uv, 1, i), 0.5 + y / 8, slack / 8);
        // Seen from where the near plane is.
        const double depth = std::sqrt(x * x + y * y + 4.0) * (1.0 - 0.5 * 1e-4);
        EXPECT_NEAR(at(K::depth, 0, i), depth, slack);
        EXPECT_NEAR(at(K::depth, 0, i, true), depth * depth, 6 * slack);
        EXPECT_GT(at(K::depth, 0, i, true), at(K::depth, 0, i) * at(K::depth, 0, i)) << "there is some variance";
        for (const K normal : {K::geo_normal, K::sh_normal}) {
            EXPECT_NEAR(at(normal, 0, i), 0.0, 1e-6);
            EXPECT_NEAR(at(normal, 2, i), -1.0, 1e-6);
        }
        EXPECT_NEAR(at(K::dp_du, 0, i), -8.0, 1e-5);
        EXPECT_NEAR(at(K::dp_dv, 1, i), 8.0, 1e-5);
        // A pixel is 1/32 of u; the step is that between samples.
        EXPECT_NEAR(at(K::duv_dx, 0, i), 1.0 / 32 / 8, 1e-5);
        EXPECT_NEAR(at(K::duv_dx, 1, i), 0.0, 1e-5);
        EXPECT_NEAR(at(K::duv_dy, 0, i), 0.0, 1e-5);
        EXPECT_NEAR(at(K::duv_dy, 1, i), -1.0 / 32 / 8, 1e-5);
        if (std::abs(x + y) > 0.3) {
            EXPECT_EQ(at(K::prim_index, 0, i), -x > y ? 0.0 : 1.0);
        }
        EXPECT_EQ(at(K::shape_index, 0, i), 1.0);
    }
}

// A unit sphere about (0, 0, 5) behind half a wall: partials are tangent, shape numbers tell what is seen, nothing is zero.
TEST(Layers, OfASphere) {
    Scene scene = empty_scene(16);
    look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 30.0F);
    scene.camera.near_clip = 1e-4F;
    add_sphere(scene, {0, 0, 5}, 1.0F, add_material(scene, Plastic{1.5F, constant(Rgb{0.3F, 0.2F, 0.1F}), constant(1.0F), false}));
    ask_for_all(scene);
    const Image image = render(scene, 1).image;
    using K = LayerKind;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < 256; ++i) {
        const auto vector = [&](K kind) {
            return glm::dvec3(values(image, scene, kind, 0)[i], values(image, scene, kind, 1)[i], values(image, scene, kind, 2)[i]);
        };
        if (values(image, scene, K::coverage, 0)[i] == 0.0F) {
            for (const ImageChannel& channel : image.channels) ASSERT_EQ(channel.values[i], 0.0F);
            continue;
        }
        ++hits;
        const glm::dvec3 n = vector(K::position) - glm::dvec3(0, 0, 5);
        EXPECT_LT(glm::distance(vector(K::geo_normal), n), 1e-5);
        EXPECT_LT(glm::distance(vector(K::sh_normal), n), 1e-5);
        EXPECT_LT(std::abs(glm::dot(vector(K::dp_du), n)), 1e-4);
        EXPECT_LT(std::abs(glm::dot(vector(K::dp_dv), n)), 1e-4);
        EXPECT_NEAR(glm::length(vector(K::dp_du)), 2.0 * 3.14159265 * std::hypot(n.x, n.y), 1e-4);
        EXPECT_NEAR(glm::length(vector(K::dp_dv)), 3.14159265, 1e-4);
        EXPECT_LT(glm::distance(vector(K::albedo), glm::dvec3(0.3, 0.2, 0.1)), 1e-6) << "of the base, whatever the coat lets through";
        const double z = std::acos(n.z) / 3.14159265358979;
        EXPECT_NEAR(values(image, scene, K::uv, 1)[i], z, 1e-5);
        EXPECT_EQ(values(image, scene, K::shape_index, 0)[i], 1.0F);
    }
    EXPECT_GT(hits, 60U);
    EXPECT_LT(hits, 200U);
}

// `path` counts an environment as covered, `direct` what is there alone.
TEST(Layers, CoverageUnderAnEnvironment) {
    for (const bool covers : {true, false}) {
        for (const bool hidden : {true, false}) {
            Scene scene = empty_scene(8);
            look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90.0F);
            add_quad(scene, {4, -4, 2}, {-4, 0, 0}, {0, 8, 0}, add_diffuse(scene, {0.2F, 0.5F, 0.7F}));
            scene.emitters.emplace_back(ConstantEmitter{Rgb{1}});
            scene.integrator.environment_covers = covers;
            scene.integrator.hide_emitters = hidden;
            ask(scene, LayerKind::coverage, 1);
            const Image image = render(scene, 4).image;
            EXPECT_EQ(values(image, scene, LayerKind::coverage, 0)[8 * 4], 1.0F);
            EXPECT_EQ(values(image, scene, LayerKind::coverage, 0)[8 * 4 + 7], covers && !hidden ? 1.0F : 0.0F);
        }
    }
}

TEST(Layers, MomentsOfTheLight) {
    Scene scene = wall_scene();
    scene.film.filter = {.kind = ReconstructionFilter::Kind::mitchell};
    scene.integrator.channels = {{"x.Y", LayerKind::xyz, 1, false}, {"m2_x.Y", LayerKind::xyz, 1, true}, {"m2_x.G", LayerKind::rgb, 1, true}};
    const Image image = render(scene, 256).image;
    for (std::size_t i = 0; i < 256; ++i) {
        const glm::dvec3 rgb = pixel(image, i);
        const double luminance = 0.212671 * rgb.r + 0.715160 * rgb.g + 0.072169 * rgb.b;
        EXPECT_NEAR(image.channels[0].values[i], luminance, 1e-6 * luminance);
        // The light hardly varies within the filter's reach: its second moment is near the square.
        EXPECT_NEAR(image.channels[1].values[i] / (luminance * luminance), 1.0, 0.2);
        EXPECT_NEAR(image.channels[2].values[i] / (rgb.g * rgb.g), 1.0, 0.2);
    }
}

Image render_all(const Driver driver, int lanes, int slots, bool layers, bool few) {
    Scene scene = wall_scene();
    if (!few) add_sphere(scene, {0.3F, 0.2F, 1.5F}, 0.3F, 0);
    scene.film.width = scene.film.crop_width = 37;
    scene.film.filter = {.kind = ReconstructionFilter::Kind::gaussian};
    if (layers) {
        ask_for_all(scene);
        ask(scene, LayerKind::xyz, 3, true);
        ask(scene, LayerKind::position, 3, true);
    }
    RenderSettings settings;
    settings.samples_per_pixel = 20;
    settings.driver = driver;
    settings.lanes = lanes;
    settings.block_slots = slots;
    return render(scene, settings).image;
}

TEST(Layers, SameBitsHoweverRendered) {
    for (const bool few : {true, false}) {
        const Image reference = render_all(Driver::one_kernel, 16, 0, true, few);
        for (const Image& other : {render_all(Driver::staged, 16, 0, true, few), render_all(Driver::one_kernel, 1, 64, true, few),
                                   render_all(Driver::staged, 8, 128, true, few)}) {
            ASSERT_EQ(other.rgb, reference.rgb);
            for (std::size_t i = 0; i < reference.channels.size(); ++i)
                ASSERT_EQ(other.channels[i].values, reference.channels[i].values) << reference.channels[i].name;
        }
        // ... and the colours do not know of the layers.
        ASSERT_EQ(render_all(Driver::one_kernel, 16, 0, false, few).rgb, reference.rgb);
    }
}

}  // namespace
}  // namespace wavelobe::test
