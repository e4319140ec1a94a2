// Pictures of instances.
#include <gtest/gtest.h>

#include "render/flatten.h"
#include "support/instances.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

// A floor under an open sky, and a group of a box, a ball and a half-there sheet to place on it.
Scene meadow(int pixels) {
    Scene scene = empty_scene(pixels);
    look_at(scene, {0, 6, 9}, {0, 0, 0}, {0, 1, 0}, 40.0F);
    add_floor(scene, 20.0F, add_diffuse(scene, Rgb{0.5F}));
    scene.emitters.emplace_back(ConstantEmitter{{1, 1.5F, 2}});
    const int red = add_diffuse(scene, {0.7F, 0.2F, 0.1F});
    add_group(scene, mesh_of(cube_mesh(2).triangles()), red);
    Shape ball;
    ball.geometry = AnalyticShape{AnalyticShape::Kind::sphere, glm::translate(glm::mat4(1.0F), {0, 1.5F, 0})};
    ball.material.front = add_material(scene, RoughConductor{});
    scene.groups[0].shapes.push_back(ball);
    Shape sheet = add_quad(scene, {-2, 0, 1.2F}, {4, 0, 0}, {0, 2, 0}, red);
    scene.shapes.pop_back();
    sheet.material.back = red;
    sheet.material.opacity.value.value = Rgb{0.5F};
    scene.groups[0].shapes.push_back(sheet);
    return scene;
}

std::vector<glm::mat4> places() {
    std::vector<glm::mat4> maps;
    for (int i = 0; i < 9; ++i) {
        const glm::mat4 at = glm::translate(glm::mat4(1.0F), {static_cast<float>(i % 3) * 3 - 3, 0.6F, static_cast<float>(i / 3) * 3 - 3});
        const glm::mat4 turned = glm::rotate(at, 0.5F * static_cast<float>(i), {0, 1, 0});
        maps.push_back(glm::scale(turned, glm::vec3(i % 2 == 0 ? 0.5F : -0.5F, 0.5F, 0.5F)));
    }
    return maps;
}

// Every instance as shapes of its own.
Scene baked(Scene scene) {
    for (const Instance& instance : scene.instances) {
        for (Shape shape : scene.groups[static_cast<std::size_t>(instance.group)].shapes) {
            if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
                for (glm::vec3& p : mesh->positions) p = glm::vec3(placed(instance.to_world, p));
                // Normals stay outside.
                if (glm::determinant(glm::mat3(instance.to_world)) < 0.0F) {
                    for (glm::uvec3& t : mesh->triangles) std::swap(t.y, t.z);
                    mesh->parallelogram = false;
                }
            } else {
                auto& analytic = std::get<AnalyticShape>(shape.geometry);
                analytic.to_world = instance.to_world * analytic.to_world;
            }
            scene.shapes.push_back(shape);
        }
    }
    scene.instances.clear();
    return scene;
}

TEST(InstancedScenes, LookAsIfTheirShapesStoodThere) {
    Scene scene = meadow(48);
    for (const glm::mat4& map : places()) add_instance(scene, map);
    const Image instanced = render(scene, 256).image;
    const Image plain = render(baked(scene), 256).image;
    const PictureMean a = picture_mean(instanced);
    const PictureMean b = picture_mean(plain);
    for (glm::length_t c = 0; c < 3; ++c) EXPECT_NEAR(a.mean[c], b.mean[c], 0.003 * b.mean[c]);
    // Pixel by pixel: the same geometry is seen, what is drawn for opacity differs.
    std::size_t unlike = 0;
    for (std::size_t i = 0; i < 48 * 48; ++i) {
        if (glm::length(pixel(instanced, i) - pixel(plain, i)) > 0.1 * glm::length(pixel(plain, i)) + 0.05) ++unlike;
    }
    EXPECT_LT(unlike, 5U);
}

TEST(InstancedScenes, AreTheSameAtEachWidth) {
    Scene scene = meadow(40);
    for (const glm::mat4& map : places()) add_instance(scene, map);
    std::vector<std::vector<float>> pictures;
    for (const int lanes : {1, 8, 16}) {
        RenderSettings settings;
        settings.samples_per_pixel = 4;
        settings.lanes = lanes;
        pictures.push_back(render(scene, settings).image.rgb);
    }
    EXPECT_EQ(pictures[0], pictures[2]);
    EXPECT_EQ(pictures[1], pictures[2]);
}

// The same sheet twice in a row: each instance is passed on its own.
TEST(InstancedScenes, MasksAreDrawnForEachInstance) {
    Scene scene = empty_scene(48);
    scene.emitters.emplace_back(ConstantEmitter{{1, 2, 3.5F}});
    look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 10.0F);
    TriangleMesh sheet;
    sheet.positions = {{-5, -5, 0}, {5, -5, 0}, {0, 9, 0}};
    sheet.triangles = {{0, 1, 2}};
    add_group(scene, sheet, add_diffuse(scene, Rgb{0})).material.opacity.value.value = Rgb{0.5F};
    for (const float z : {2.0F, 3.0F}) add_instance(scene, glm::translate(glm::mat4(1.0F), {0, 0, z}));
    expect_closed_form(scene, 64, glm::dvec3{1, 2, 3.5} * 0.25);
}

// A group is stored once; an instance takes its record and its share of the hierarchy.
TEST(InstancedScenes, StoreTheGroupOnce) {
    constexpr int side = 300;
    Scene scene = meadow(16);
    scene.groups[0].shapes.resize(1);
    for (int i = 0; i < side * side; ++i) {
        add_instance(scene, glm::scale(glm::translate(glm::mat4(1.0F), {static_cast<float>(i % side) * 0.1F - 15, 0.1F,
                                                                        static_cast<float>(i / side) * 0.1F - 15}),
                                       glm::vec3(0.02F)));
    }
    EXPECT_EQ(flatten_scene(scene).triangles.size(), 2U + std::get<TriangleMesh>(scene.groups[0].shapes[0].geometry).triangles.size());
    Scene one = scene;
    one.instances.resize(1);
    const std::uint64_t more = render(scene, 1).stats.device_bytes - render(one, 1).stats.device_bytes;
    EXPECT_LT(more, 160U * side * side);
    EXPECT_NEAR(static_cast<double>(summarize(scene).device_bytes - summarize(one).device_bytes), static_cast<double>(more),
                0.15 * static_cast<double>(more));
}

TEST(InstancedScenes, GroupsWithoutInstancesCostNothing) {
    Scene scene = meadow(16);
    Scene plain = scene;
    plain.groups.clear();
    EXPECT_EQ(scene_program(scene), scene_program(plain));
    EXPECT_NE(scene_program(scene).find("#define HAS_INSTANCES 0\n"), std::string::npos);
    EXPECT_EQ(render(scene, 4).image.rgb, render(plain, 4).image.rgb);
    // An instance of nothing is nothing.
    scene.groups[0].shapes.clear();
    add_instance(scene, glm::mat4(1.0F));
    EXPECT_EQ(scene_program(scene), scene_program(plain));
}

TEST(InstancedScenes, RefuseEmittersAndMapsWithoutInverse) {
    Scene scene = meadow(16);
    add_instance(scene, glm::scale(glm::mat4(1.0F), {1, 0, 1}));
    EXPECT_THROW(flatten_scene(scene), InputError);
    scene.instances[0].to_world = glm::mat4(1.0F);
    EXPECT_NO_THROW(flatten_scene(scene));
    make_emitter(scene.groups[0].shapes[0], {1, 1, 1});
    EXPECT_THROW(flatten_scene(scene), InputError);
}

}  // namespace
}  // namespace wavelobe::test
