// Closed rooms in a bright environment, and covered lamps: what they let through is light that passed their walls.
#include <gtest/gtest.h>

#include <tuple>

#include "support/render.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {
namespace {

// Squares a side of the cube (with few, its triangles are tested without a hierarchy), and whether it is turned, so that
// no coordinate of a wall is exact.
class ClosedCube : public testing::TestWithParam<std::tuple<int, bool>> {};

// Paths make some twenty bounces and meet an edge to within the rounding of their positions now and then: of each bounce,
// on the order of 1e-8.
TEST_P(ClosedCube, LetsNothingIn) {
    const auto [squares, turned] = GetParam();
    Scene scene = empty_scene(256);
    look_at(scene, {0.1F, 0.2F, -0.3F}, {0.3F, 0.4F, 1.0F}, {0, 1, 0}, 90.0F);
    scene.integrator.max_depth = 64;
    scene.integrator.rr_depth = 1000;
    scene.emitters.emplace_back(ConstantEmitter{Rgb{1.0F}});
    TriangleMesh walls;
    const ClosedMesh cube = cube_mesh(squares);
    const glm::mat4 turn = glm::rotate(glm::mat4(1.0F), 0.7F, glm::normalize(glm::vec3{1.0F, 2.0F, 3.0F}));
    for (const glm::vec3& p : cube.vertices) walls.positions.push_back(turned ? glm::vec3(turn * glm::vec4(p, 1)) : p);
    walls.triangles = cube.faces;
    Shape& shape = add_shape(scene, walls, add_diffuse(scene, Rgb{0.8F}), "cube");
    shape.material.back = shape.material.front;
    Claim claim("Numerical stability", "Light that " + test_of_claim() + " (a closed cube of albedo 0.8) lets in", "of the light outside");
    const Rendering rendering = render(scene, quick_or_full(16, 256));
    claim.observe(picture_mean(rendering.image).mean.x);
    claim.count(rendering.stats.samples);
    claim.at_most(1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, ClosedCube, testing::Combine(testing::Values(1, 12), testing::Bool()), [](const auto& p) {
    return std::to_string(std::get<0>(p.param)) + (std::get<1>(p.param) ? "_turned" : "_aligned");
});

// Shadow rays see what covers a light if only their own rounding (SHADOW_REACH) tells it from the light: here 4e-6 of their length.
TEST(LightLeaks, CoveredLampLightsNothing) {
    Scene scene = empty_scene(16);
    const int black = add_diffuse(scene, Rgb{0});
    add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
    Shape& lamp = add_quad(scene, {-1, 4, -1}, {2, 0, 0}, {0, 0, 2}, black);
    lamp.emitter = AreaEmitter{constant(Rgb{1})};
    look_at_point(scene, {0.5F, 0.4F, 0}, {0, 0, 0});
    scene.integrator.max_depth = 2;
    EXPECT_GT(picture_mean(render(scene, 16).image).mean.x, 0.01);
    add_quad(scene, {-1.1F, 4.0F - 1.6e-5F, -1.1F}, {2.2F, 0, 0}, {0, 0, 2.2F}, black);
    expect_every_pixel(render(scene, 64).image, glm::dvec3(0.0));
}

}  // namespace
}  // namespace wavelobe::test
