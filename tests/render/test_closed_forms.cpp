// Radiance that is known exactly: furnaces, and a diffuse floor under each kind of light.
#include <gtest/gtest.h>

#include <numbers>

#include "support/light_models.h"
#include "render/flatten.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

constexpr double pi = std::numbers::pi;
const Rgb radiance{1.0F, 2.0F, 3.5F};
const Rgb albedo{0.2F, 0.5F, 0.8F};

glm::dvec3 radiance_of_irradiance(const glm::dvec3& irradiance) { return glm::dvec3(albedo) * irradiance / pi; }

// ---- furnaces: closed rooms whose walls all emit and reflect alike -----------------------------------------

Scene furnace(int pixels) {
    Scene scene = empty_scene(pixels);
    look_at(scene, {0.1F, 0.2F, -0.3F}, {0.3F, 0.4F, 1.0F}, {0, 1, 0}, 80.0F);
    return scene;
}

Scene sphere_furnace(int pixels) {
    Scene scene = furnace(pixels);
    Shape& wall = add_sphere(scene, {0, 0, 0}, 1.0F, add_diffuse(scene, albedo));
    wall.flip_normals = true;
    make_emitter(wall, radiance);
    return scene;
}

Scene box_furnace(int pixels) {
    Scene scene = furnace(pixels);
    const int material = add_diffuse(scene, albedo);
    const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; ++i) {
        const glm::vec3 n = axes[i];
        const glm::vec3 a = axes[(i + 1) % 3];
        const glm::vec3 b = axes[(i + 2) % 3];
        make_emitter(add_quad(scene, -n - a - b, 2.0F * a, 2.0F * b, material), radiance);
        make_emitter(add_quad(scene, n - a - b, 2.0F * b, 2.0F * a, material), radiance);
    }
    return scene;
}

const glm::dvec3 furnace_radiance = glm::dvec3(radiance) / (1.0 - glm::dvec3(albedo));

TEST(Furnace, Sphere) { expect_closed_form(sphere_furnace(32), 64, furnace_radiance); }

TEST(Furnace, Box) { expect_closed_form(box_furnace(32), 64, furnace_radiance); }

// A cylinder closed by two disks.
TEST(Furnace, CylinderAndDisks) {
    Scene scene = furnace(32);
    const int material = add_diffuse(scene, albedo);
    const auto add = [&](AnalyticShape::Kind kind, float bottom, float height, bool flip) {
        const glm::mat4 to_world = glm::scale(glm::translate(glm::mat4(1.0F), {0, 0, bottom}), glm::vec3(1, 1, height));
        Shape& wall = add_shape(scene, AnalyticShape{kind, to_world}, material, "wall");
        wall.flip_normals = flip;
        make_emitter(wall, radiance);
    };
    add(AnalyticShape::Kind::cylinder, -1.5F, 3.0F, true);
    add(AnalyticShape::Kind::disk, -1.5F, 1.0F, false);
    add(AnalyticShape::Kind::disk, 1.5F, 1.0F, true);
    expect_closed_form(scene, 64, furnace_radiance);
}

class FurnaceDepth : public testing::TestWithParam<int> {};

// Paths of n edges see n terms of the geometric series.
TEST_P(FurnaceDepth, TruncatesTheSeries) {
    Scene scene = sphere_furnace(16);
    scene.integrator.max_depth = GetParam();
    glm::dvec3 expected{0.0};
    for (int i = 0; i < GetParam(); ++i) expected = glm::dvec3(radiance) + glm::dvec3(albedo) * expected;
    if (GetParam() <= 1) {
        expect_every_pixel(render(scene, 64).image, expected);
    } else {
        expect_closed_form(scene, 64, expected);
    }
}

INSTANTIATE_TEST_SUITE_P(All, FurnaceDepth, testing::Values(0, 1, 2, 3, 4));

// Russian roulette may end paths at any depth without changing the mean.
TEST(Furnace, RouletteFromTheFirstVertex) {
    Scene scene = sphere_furnace(32);
    scene.integrator.rr_depth = 1;
    expect_closed_form(scene, 128, furnace_radiance);
}

// ---- a floor under one light, direct light alone -----------------------------------------------------------

// The pixels see the origin of a diffuse floor from the side, at 45 degrees.
Scene floor_scene() {
    Scene scene = empty_scene(32);
    look_at_point(scene, {-3, 3, 0}, {0, 0, 0});
    scene.integrator.max_depth = 2;
    add_floor(scene, 20.0F, add_diffuse(scene, albedo));
    return scene;
}

glm::dvec3 under_polygon(const std::vector<glm::dvec3>& vertices) {
    return radiance_of_irradiance(glm::dvec3(radiance) * polygon_irradiance(vertices, {0, 0, 0}, {0, 1, 0}));
}

TEST(FloorUnder, Rectangle) {
    Scene scene = floor_scene();
    const int black = add_diffuse(scene, Rgb{0});
    const glm::vec3 corner{-0.5F, 1.5F, -0.2F};
    const glm::vec3 edge1{2.0F, 0.3F, 0.0F};
    const glm::vec3 edge2{0.0F, 0.4F, 1.5F};
    make_emitter(add_quad(scene, corner, edge1, edge2, black), radiance);
    const glm::dvec3 p{corner};
    const glm::dvec3 a{edge1};
    const glm::dvec3 b{edge2};
    expect_closed_form(scene, 64, under_polygon({p, p + a, p + a + b, p + b}));
}

TEST(FloorUnder, Triangle) {
    Scene scene = floor_scene();
    const glm::vec3 corners[3] = {{-0.3F, 1.0F, -0.8F}, {1.2F, 1.4F, -0.5F}, {0.2F, 0.9F, 1.1F}};
    make_emitter(add_triangle(scene, corners[0], corners[1], corners[2], add_diffuse(scene, Rgb{0})), radiance);
    expect_closed_form(scene, 64,
                under_polygon({glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])}));
}

// So large that it is sampled by solid angle.
TEST(FloorUnder, WideTriangle) {
    Scene scene = floor_scene();
    const glm::vec3 corners[3] = {{-8, 4, -8}, {8, 3.5F, -8}, {0, 5, 9}};
    make_emitter(add_triangle(scene, corners[0], corners[1], corners[2], add_diffuse(scene, Rgb{0})), radiance);
    const std::vector<std::string> names = flatten_scene(scene).features.names();
    EXPECT_NE(std::find(names.begin(), names.end(), "light:spherical_triangle"), names.end());
    expect_closed_form(scene, 64, under_polygon({glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])}));
}

// Half of it lies below the floor and is hidden.
TEST(FloorUnder, RectangleThatCrossesTheHorizon) {
    Scene scene = floor_scene();
    make_emitter(add_quad(scene, {2, -1.5F, -1}, {0, 0, 2}, {0, 3, 0}, add_diffuse(scene, Rgb{0})), radiance);
    expect_closed_form(scene, 128, under_polygon({{2, 0, -1}, {2, 0, 1}, {2, 1.5, 1}, {2, 1.5, -1}}));
}

// Radius r at height h and distance d from the axis: E = pi L / 2 (1 - (d^2 + h^2 - r^2) / sqrt((d^2 + h^2 + r^2)^2 - 4
// r^2 d^2)) (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-32).
TEST(FloorUnder, Disk) {
    for (const double d : {0.0, 1.3}) {
        constexpr double r = 0.75;
        constexpr double h = 1.25;
        Scene scene = floor_scene();
        make_emitter(add_disk_facing_down(scene, {static_cast<float>(d), h, 0}, r, add_diffuse(scene, Rgb{0})),
                     radiance);
        const double sum = d * d + h * h + r * r;
        const double factor = 0.5 * (1.0 - (sum - 2.0 * r * r) / std::sqrt(sum * sum - 4.0 * r * r * d * d));
        expect_closed_form(scene, 64, radiance_of_irradiance(glm::dvec3(radiance) * pi * factor));
    }
}

// A sphere wholly above the horizon: E = pi L (r / d)^2 cos.
TEST(FloorUnder, Sphere) {
    Scene scene = floor_scene();
    const glm::vec3 center{1.0F, 2.0F, -0.5F};
    make_emitter(add_sphere(scene, center, 0.5F, add_diffuse(scene, Rgb{0})), radiance);
    const double d2 = glm::dot(glm::dvec3(center), glm::dvec3(center));
    const double irradiance = pi * 0.25 / d2 * static_cast<double>(center.y) / std::sqrt(d2);
    expect_closed_form(scene, 64, radiance_of_irradiance(glm::dvec3(radiance) * irradiance));
}

TEST(FloorUnder, Point) {
    Scene scene = floor_scene();
    const glm::vec3 position{1.0F, 2.0F, -0.5F};
    scene.emitters.emplace_back(PointEmitter{position, radiance});
    const double d2 = glm::dot(glm::dvec3(position), glm::dvec3(position));
    const double factor = static_cast<double>(position.y) / std::pow(d2, 1.5);
    expect_every_pixel(render(scene, 16).image, radiance_of_irradiance(glm::dvec3(radiance) * factor));
}

// Within the beam, and where the intensity falls linearly in the angle.
TEST(FloorUnder, Spot) {
    for (const double angle : {0.0, 20.0}) {
        Scene scene = floor_scene();
        const glm::dvec3 position{0.5, 2.0, 0.0};
        const glm::dvec3 to_floor = glm::normalize(-position);
        const glm::dvec3 side{0, 0, 1};
        const glm::dvec3 axis = std::cos(angle * pi / 180.0) * to_floor + std::sin(angle * pi / 180.0) * side;
        SpotEmitter spot;
        spot.to_world[2] = glm::vec4(glm::vec3(axis), 0);
        spot.to_world[3] = glm::vec4(glm::vec3(position), 1);
        spot.intensity = radiance;
        spot.cutoff_degrees = 25.0F;
        spot.beam_width_degrees = 10.0F;
        scene.emitters.emplace_back(spot);
        const double falloff = angle < 10.0 ? 1.0 : (25.0 - angle) / (25.0 - 10.0);
        const double d2 = glm::dot(position, position);
        const double factor = falloff * position.y / std::pow(d2, 1.5);
        const Image image = render(scene, 16).image;
        // An angle's rounding is that of turns, over the width of the ramp.
        const double tolerance = path_rounding * (angle < 10.0 ? 1.0 : 180.0 / (25.0 - angle));
        const glm::dvec3 expected = radiance_of_irradiance(glm::dvec3(radiance) * factor);
        for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(pixel(image, i)[c], expected[c], tolerance * expected[c]);
        }
    }
}

TEST(FloorUnder, Directional) {
    Scene scene = floor_scene();
    const glm::vec3 direction = glm::normalize(glm::vec3{0.5F, -0.8F, 0.3F});
    scene.emitters.emplace_back(DirectionalEmitter{direction, radiance});
    const double cosine = -static_cast<double>(direction.y);
    expect_every_pixel(render(scene, 16).image, radiance_of_irradiance(glm::dvec3(radiance) * cosine));
}

TEST(FloorUnder, ConstantEnvironment) {
    Scene scene = floor_scene();
    scene.emitters.emplace_back(ConstantEmitter{radiance});
    expect_closed_form(scene, 64, glm::dvec3(albedo) * glm::dvec3(radiance));
}

TEST(FloorUnder, EnvironmentMap) {
    Scene scene = floor_scene();
    EnvironmentMap map;
    map.image.width = 8;
    map.image.height = 5;
    std::mt19937 random(1);
    for (int i = 0; i < 8 * 5 * 3; ++i)
        map.image.rgb.push_back(std::uniform_real_distribution<float>(0.1F, 4.0F)(random));
    map.scale = 0.5F;
    map.to_world = glm::rotate(glm::mat4(1.0F), 0.7F, glm::vec3(0.3F, 0.5F, -0.8F));
    scene.emitters.emplace_back(map);
    EnvironmentReference reference;
    reference.image = map.image;
    reference.to_world = glm::dmat3(map.to_world);
    const glm::dvec3 irradiance = 0.5 * reference.integral([](const glm::dvec3& d) { return std::max(d.y, 0.0); });
    expect_closed_form(scene, 64, radiance_of_irradiance(irradiance));
}

// Light adds up, whatever the chances with which one of them is chosen.
TEST(FloorUnder, LightsOfAllKindsTogether) {
    Scene scene = floor_scene();
    const int black = add_diffuse(scene, Rgb{0});
    make_emitter(add_quad(scene, {2, 0.5F, -1}, {0, 0, 2}, {0, 1, 0}, black), radiance);
    make_emitter(add_sphere(scene, {0, 2, 2}, 0.4F, black), 3.0F * radiance);
    scene.emitters.emplace_back(PointEmitter{{-1.0F, 1.0F, -1.0F}, radiance});
    scene.emitters.emplace_back(DirectionalEmitter{{0, -1, 0}, 0.5F * radiance});
    const double quad =
        polygon_irradiance({{2, 0.5, -1}, {2, 0.5, 1}, {2, 1.5, 1}, {2, 1.5, -1}}, {0, 0, 0}, {0, 1, 0});
    const double sphere = 3.0 * pi * 0.16 / 8.0 * std::sqrt(0.5);
    const double point = 1.0 / std::pow(3.0, 1.5);
    expect_closed_form(scene, 256, radiance_of_irradiance(glm::dvec3(radiance) * (quad + sphere + point + 0.5)));
}

// The camera looks through a light at the floor that it lights.
TEST(FloorUnder, HiddenEmitter) {
    Scene scene = floor_scene();
    scene.integrator.hide_emitters = true;
    make_emitter(add_disk_facing_down(scene, {0, 1, 0}, 1.0F, add_diffuse(scene, albedo)), radiance);
    look_at_point(scene, {0.3F, 3, 0}, {0, 0, 0});
    expect_closed_form(scene, 64, radiance_of_irradiance(glm::dvec3(radiance) * pi * 0.5));
}

// A light inside a diffuse sphere: direct light, and what all the wall's reflections add to it.
TEST(IntegratingSphere, PointInTheMiddle) {
    for (const bool direct : {true, false}) {
        Scene scene = furnace(32);
        scene.integrator.max_depth = direct ? 2 : -1;
        add_sphere(scene, {0, 0, 0}, 2.0F, add_diffuse(scene, albedo)).flip_normals = true;
        scene.emitters.emplace_back(PointEmitter{{0, 0, 0}, radiance});
        const glm::dvec3 once = radiance_of_irradiance(glm::dvec3(radiance) / 4.0);
        if (direct) {
            expect_every_pixel(render(scene, 16).image, once);
        } else {
            expect_closed_form(scene, 64, once / (1.0 - glm::dvec3(albedo)));
        }
    }
}

}  // namespace
}  // namespace wavelobe::test
