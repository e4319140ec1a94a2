// Absorbing media: what Beer's law leaves of light, along paths and along rays to lights.
#include <gtest/gtest.h>

#include <numbers>

#include "support/render.h"

namespace wavelobe::test {
namespace {

constexpr double pi = std::numbers::pi;
const Rgb thin{0.5F, 0.2F, 0.0F};
const Rgb dense{0.3F, 1.2F, 2.0F};
const Rgb light{2.0F, 3.0F, 4.0F};

glm::dvec3 left_of(const Rgb& absorption, double distance) { return glm::exp(-glm::dvec3(absorption) * distance); }

int add_medium(Scene& scene, const Rgb& absorption) {
    scene.media.push_back({absorption, "medium"});
    return static_cast<int>(scene.media.size()) - 1;
}

// There for media alone.
Shape& make_clear(Shape& shape, int interior, int exterior = -1) {
    shape.material.back = shape.material.front;
    shape.material.opacity.value.value = Rgb{0.0F};
    shape.media = MediumBoundary{interior, exterior};
    return shape;
}

Scene lit_scene(int pixels, const glm::vec3& from = {0.02F, 0.03F, 5.0F}) {
    Scene scene = empty_scene(pixels);
    look_at_point(scene, from, {0.02F, 0.03F, 0.0F});
    scene.emitters.emplace_back(ConstantEmitter{light});
    return scene;
}

double chord(double radius) { return 2.0 * std::sqrt(radius * radius - 0.02 * 0.02 - 0.03 * 0.03); }

TEST(Media, ClearSphere) {
    Scene scene = lit_scene(4);
    make_clear(add_sphere(scene, {0, 0, 0}, 1.0F, add_diffuse(scene, Rgb{0.5F})), add_medium(scene, dense));
    expect_every_pixel(render(scene, 16).image, glm::dvec3(light) * left_of(dense, chord(1.0)));
}

// A slab between two faces of which the path meets one from either side; no hierarchy.
TEST(Media, ClearSlabOfTriangles) {
    Scene scene = lit_scene(4);
    const int medium = add_medium(scene, thin);
    const int material = add_diffuse(scene, Rgb{0.5F});
    make_clear(add_quad(scene, {-1, -1, 0.75F}, {2, 0, 0}, {0, 2, 0}, material), medium);
    make_clear(add_quad(scene, {-1, -1, -0.5F}, {0, 2, 0}, {2, 0, 0}, material), medium);
    expect_every_pixel(render(scene, 16).image, glm::dvec3(light) * left_of(thin, 1.25));
}

TEST(Media, NestedSpheres) {
    Scene scene = lit_scene(4);
    const int outer = add_medium(scene, thin), inner = add_medium(scene, dense);
    const int material = add_diffuse(scene, Rgb{0.5F});
    make_clear(add_sphere(scene, {0, 0, 0}, 2.0F, material), outer);
    make_clear(add_sphere(scene, {0, 0, 0}, 0.5F, material), inner, outer);
    const glm::dvec3 left = left_of(thin, chord(2.0) - chord(0.5)) * left_of(dense, chord(0.5));
    expect_every_pixel(render(scene, 16).image, glm::dvec3(light) * left);
}

TEST(Media, CameraInside) {
    Scene scene = lit_scene(4, {0.02F, 0.03F, 0.0F + 0.5F});
    const int medium = add_medium(scene, dense);
    scene.camera_medium = medium;
    make_clear(add_sphere(scene, {0, 0, 0}, 1.0F, add_diffuse(scene, Rgb{0.5F})), medium);
    expect_every_pixel(render(scene, 16).image,
                       glm::dvec3(light) * left_of(dense, 0.5 * chord(1.0) + 0.5 - static_cast<double>(scene.camera.near_clip)));
}

// What fills all of space leaves nothing of a light at infinity, but where it does not absorb.
TEST(Media, EnvironmentAtInfinity) {
    Scene scene = lit_scene(4);
    scene.camera_medium = add_medium(scene, thin);
    expect_every_pixel(render(scene, 16).image, {0, 0, light.b});
    add_floor(scene, 1.0F, add_diffuse(scene, Rgb{1.0F}));
    look_at_point(scene, {0.02F, 2.0F, 0.03F}, {0.02F, 0.0F, 0.03F});
    const PictureMean floor = picture_mean(render(scene, 64).image);
    EXPECT_EQ(floor.mean.r + floor.mean.g, 0.0);
    EXPECT_NEAR(floor.mean.b, light.b, 4.5 * floor.standard_error.b + path_rounding * light.b);
}

// Index-matched or not, glass on its axis: reflections between its two sides lose by each crossing.
TEST(Media, GlassSphere) {
    Scene scene = lit_scene(64);
    look_at_point(scene, {0, 0, 5}, {0, 0, 0});
    Shape& ball = add_sphere(scene, {0, 0, 0}, 1.0F, add_material(scene, Dielectric{1.5F, constant(1.0F), constant(1.0F)}));
    ball.material.back = ball.material.front;
    ball.media = MediumBoundary{add_medium(scene, thin), -1};
    const double r = 0.04;
    const glm::dvec3 a = left_of(thin, 2.0);
    expect_mean(render(scene, 256).image, glm::dvec3(light) * (r + (1 - r) * (1 - r) * a / (1.0 - r * a)));
}

// The middle of a shining sphere, all of whose light has the same way to go: half through one medium, half through another.
// `walls` clear spheres part the second medium from itself.
Scene shining_room(int walls) {
    Scene scene = empty_scene(32);
    const int near = add_medium(scene, thin), far = add_medium(scene, dense * 0.3F);
    const int material = add_diffuse(scene, Rgb{0.8F});
    add_quad(scene, {-1e-3F, 0, 1e-3F}, {2e-3F, 0, 0}, {0, 0, -2e-3F}, material);
    Shape& room = add_sphere(scene, {0, 0, 0}, 2.0F, add_diffuse(scene, Rgb{0.0F}));
    room.flip_normals = true;
    make_emitter(room, light);
    make_clear(add_sphere(scene, {0, 0, 0}, 1.0F, material), near, far);
    for (int i = 0; i < walls; ++i) make_clear(add_sphere(scene, {0, 0, 0}, 1.2F + 0.1F * static_cast<float>(i), material), far, far);
    scene.camera_medium = near;
    look_at_point(scene, {0, 0.5F, 0}, {0, 0, 0});
    return scene;
}

class ShiningRoom : public testing::TestWithParam<int> {};

TEST_P(ShiningRoom, LightOfEveryDirectionIsLessenedAlike) {
    const Scene scene = shining_room(GetParam());
    const glm::dvec3 expected = 0.8 * glm::dvec3(light) * left_of(thin, 1.5) * left_of(dense * 0.3F, 1.0);
    const Image image = render(scene, 256).image;
    const PictureMean found = picture_mean(image);
    // The patch is a thousandth of a unit wide.
    for (glm::length_t c = 0; c < 3; ++c) EXPECT_NEAR(found.mean[c], expected[c], 4.5 * found.standard_error[c] + 1e-4 * expected[c]);
}

INSTANTIATE_TEST_SUITE_P(Walls, ShiningRoom, testing::Values(0, 3));

// A point light above a floor, with a slab between them: light sampling alone can find it.
TEST(Media, ShadowRaysThroughSlabs) {
    Scene scene = empty_scene(4);
    add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
    scene.emitters.emplace_back(PointEmitter{{0.1F, 2.0F, 0.1F}, light});
    const int medium = add_medium(scene, dense);
    const int material = add_diffuse(scene, Rgb{0.5F});
    make_clear(add_quad(scene, {-1, 1.5F, 1}, {2, 0, 0}, {0, 0, -2}, material), medium);
    make_clear(add_quad(scene, {-1, 1.1F, 1}, {0, 0, -2}, {2, 0, 0}, material), medium);
    look_at_point(scene, {0.1F, 1.0F, 0.6F}, {0.1F, 0.0F, 0.1F});
    const glm::dvec3 irradiance = glm::dvec3(light) / 4.0 * left_of(dense, static_cast<double>(1.5F) - static_cast<double>(1.1F));
    expect_every_pixel(render(scene, 16).image, 0.5 / pi * irradiance);
}

// Everything in one medium, no boundary at all.
TEST(Media, ShadowRaysInsideAMedium) {
    Scene scene = empty_scene(4);
    add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
    scene.emitters.emplace_back(PointEmitter{{0.1F, 2.0F, 0.1F}, light});
    scene.camera_medium = add_medium(scene, thin);
    look_at_point(scene, {0.1F, 1.0F, 0.1F}, {0.1F, 0.0F, 0.1F});
    expect_every_pixel(render(scene, 16).image, 0.5 / pi * glm::dvec3(light) / 4.0 * left_of(thin, 3.0 - static_cast<double>(scene.camera.near_clip)));
}

// A glowing boundary which is not there otherwise: its light is added to what comes through.
TEST(Media, EmittingBoundary) {
    Scene scene = lit_scene(4);
    const Rgb glow{1.0F, 0.5F, 0.25F};
    Shape& ball = make_clear(add_sphere(scene, {0, 0, 0}, 1.0F, add_diffuse(scene, Rgb{0.0F})), add_medium(scene, dense));
    make_emitter(ball, glow);
    expect_every_pixel(render(scene, 16).image, glm::dvec3(glow) + glm::dvec3(light) * left_of(dense, chord(1.0)));
}

TEST(Media, OfNoEffectCostNothing) {
    Scene scene = lit_scene(4);
    const int nothing = add_medium(scene, Rgb{0.0F});
    add_medium(scene, dense);  // in no use
    make_clear(add_sphere(scene, {0, 0, 0}, 1.0F, add_diffuse(scene, Rgb{0.5F})), nothing);
    const Rendering rendering = render(scene, 16);
    expect_every_pixel(rendering.image, light);
    EXPECT_EQ(rendering.stats.features, std::vector<std::string>{"light:constant"});
}

// Both drivers and all widths follow the same rays.
TEST(Media, SameBitsForEachWidthAndDriver) {
    const Scene scene = shining_room(2);
    RenderSettings settings;
    settings.samples_per_pixel = 16;
    const std::vector<float> expected = render(scene, settings).image.rgb;
    for (const int lanes : {1, 8}) {
        settings.lanes = lanes;
        EXPECT_EQ(render(scene, settings).image.rgb, expected) << lanes;
    }
    settings.lanes = 16;
    settings.driver = Driver::staged;
    EXPECT_EQ(render(scene, settings).image.rgb, expected);
}

}  // namespace
}  // namespace wavelobe::test
