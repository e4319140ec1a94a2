// A scene that needs nearly every branch of every stage: all classes of lobes, alone and together, both sides of
// surfaces, all kinds of primitives, and lights of each reach.
#pragma once

#include "support/scenes.h"

namespace wavelobe::test {

inline Scene many_features_scene(int width, int height) {
    Scene scene = empty_scene(1);
    scene.film.width = scene.film.crop_width = width;
    scene.film.height = scene.film.crop_height = height;
    scene.film.filter = {ReconstructionFilter::Kind::gaussian, 2.0F, 0.5F};
    look_at(scene, {0.3F, 1.6F, 5.0F}, {0, 0.7F, 0}, {0, 1, 0}, 45.0F);

    const auto board = std::make_shared<Texture>();
    board->source = Checkerboard{{0.8F, 0.7F, 0.6F}, {0.1F, 0.2F, 0.3F}};
    board->to_uv = glm::mat3(6.0F);
    board->to_uv[2] = {0, 0, 1};
    add_floor(scene, 3.0F, add_material(scene, Diffuse{{Rgb{0.0F}, board}}));

    const int glass = add_material(scene, Dielectric{});
    add_sphere(scene, {-1.2F, 0.5F, 1.0F}, 0.5F, glass).material.back = glass;
    const int rough_glass = add_material(scene, RoughDielectric{1.5F, constant(1.0F), constant(1.0F), constant(0.2F),
                                                                constant(0.2F), Distribution::beckmann});
    add_sphere(scene, {1.3F, 0.5F, 1.2F}, 0.5F, rough_glass).material.back = rough_glass;
    add_sphere(scene, {0, 0.5F, 0.2F}, 0.5F,
               add_material(scene, Plastic{1.5F, constant(Rgb{0.6F, 0.1F, 0.1F}), constant(1.0F), true}));
    add_sphere(scene, {0.9F, 1.5F, -0.6F}, 0.4F, add_material(scene, Conductor{}));
    add_sphere(scene, {-0.9F, 1.5F, -0.6F}, 0.4F, add_material(scene, Phong{}));

    // A wall of brushed metal with paint behind, and shading normals that bend it.
    Shape& wall = add_quad(scene, {-2, 0, -1.5F}, {4, 0, 0}, {0, 2.5F, 0},
                           add_material(scene, RoughConductor{{0.2F, 0.9F, 1.1F},
                                                              {3.9F, 2.4F, 2.2F},
                                                              constant(1.0F),
                                                              constant(0.1F),
                                                              constant(0.3F),
                                                              Distribution::beckmann}));
    wall.material.back = add_diffuse(scene, {0.3F, 0.4F, 0.5F});
    auto& mesh = std::get<TriangleMesh>(wall.geometry);
    for (const float x : {-0.2F, 0.2F, 0.2F, -0.2F}) mesh.normals.push_back(glm::normalize(glm::vec3{x, 0.1F, 1}));
    mesh.parallelogram = false;
    const int pane = add_material(scene, ThinDielectric{});
    add_quad(scene, {-2.2F, 0, 0.5F}, {0, 0, 1}, {0, 1.5F, 0}, pane).material.back = pane;

    // Only partly there: a screen by its texture, a sphere and, below, a light by a number.
    Opacity& screen = add_quad(scene, {0.6F, 0, 2.2F}, {1, 0, 0}, {0, 0.8F, 0}, add_diffuse(scene, {0.7F, 0.6F, 0.2F})).material.opacity;
    screen.value.texture = board;
    screen.texture_scale = 1.2F;
    add_sphere(scene, {-0.3F, 0.3F, 2.2F}, 0.3F, add_diffuse(scene, {0.2F, 0.7F, 0.3F})).material.opacity.value.value = Rgb{0.5F};

    const int black = add_diffuse(scene, Rgb{0});
    make_emitter(add_quad(scene, {-0.5F, 2.8F, 0}, {1, 0, 0}, {0, 0, 1}, black), {8, 7, 6});
    make_emitter(add_sphere(scene, {-1.8F, 2.2F, 0.5F}, 0.15F, black), {20, 10, 5});
    scene.shapes.back().material.opacity.value.value = Rgb{0.5F};
    scene.emitters.emplace_back(ConstantEmitter{{0.1F, 0.15F, 0.2F}});
    // With these as many lights as are chosen by a tree.
    scene.emitters.emplace_back(PointEmitter{{0, 2.2F, 2.5F}, {1, 1, 1}});
    scene.emitters.emplace_back(PointEmitter{{1.5F, 2.0F, 1.0F}, {0.3F, 0.2F, 0.1F}});
    scene.emitters.emplace_back(PointEmitter{{-1.5F, 1.0F, 2.0F}, {0.1F, 0.2F, 0.3F}});
    scene.emitters.emplace_back(DirectionalEmitter{glm::normalize(glm::vec3{0.4F, -1, -0.3F}), {0.5F, 0.5F, 0.4F}});
    return scene;
}

}  // namespace wavelobe::test
