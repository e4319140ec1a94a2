// Scenes built in C++: for closed forms, which need no file.
#pragma once

#include <utility>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/scene.h"

namespace wavelobe::test {

inline Parameter constant(const Rgb& value) { return {value, nullptr}; }
inline Parameter constant(float value) { return {Rgb{value}, nullptr}; }

// A square picture, one sample a pixel of its own (box filter), paths of any length.
inline Scene empty_scene(int pixels) {
    Scene scene;
    scene.film.width = scene.film.crop_width = pixels;
    scene.film.height = scene.film.crop_height = pixels;
    scene.film.filter = {ReconstructionFilter::Kind::box, 0.5F, 0.0F};
    scene.camera.near_clip = 1e-4F;
    return scene;
}

inline void look_at(Scene& scene, const glm::vec3& origin, const glm::vec3& target, const glm::vec3& up,
                    float fov_degrees) {
    const glm::vec3 forward = glm::normalize(target - origin);
    const glm::vec3 left = glm::normalize(glm::cross(up, forward));
    const glm::vec3 above = glm::cross(forward, left);
    scene.camera.to_world =
        glm::mat4(glm::vec4(left, 0), glm::vec4(above, 0), glm::vec4(forward, 0), glm::vec4(origin, 1));
    scene.camera.fov_x_degrees = fov_degrees;
}

// All pixels see one point: at 1e-5 degrees they differ by no more than a few roundings of its coordinates.
inline void look_at_point(Scene& scene, const glm::vec3& origin, const glm::vec3& target) {
    const glm::vec3 forward = glm::normalize(target - origin);
    const glm::vec3 up = std::abs(forward.y) > 0.9F ? glm::vec3{0, 0, 1} : glm::vec3{0, 1, 0};
    look_at(scene, origin, target, up, 1e-5F);
}

inline int add_material(Scene& scene, MaterialModel model) {
    scene.materials.push_back({std::move(model), "m" + std::to_string(scene.materials.size())});
    return static_cast<int>(scene.materials.size()) - 1;
}

inline int add_diffuse(Scene& scene, const Rgb& albedo) { return add_material(scene, Diffuse{constant(albedo)}); }

inline Shape& add_shape(Scene& scene, std::variant<TriangleMesh, AnalyticShape> geometry, int material,
                        const char* name) {
    Shape& shape = scene.shapes.emplace_back();
    shape.geometry = std::move(geometry);
    shape.material.front = material;
    shape.name = name;
    return shape;
}

// A parallelogram with normal along edge1 x edge2.
inline Shape& add_quad(Scene& scene, const glm::vec3& corner, const glm::vec3& edge1, const glm::vec3& edge2,
                       int material) {
    TriangleMesh mesh;
    mesh.positions = {corner, corner + edge1, corner + edge1 + edge2, corner + edge2};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.parallelogram = true;
    return add_shape(scene, std::move(mesh), material, "quad");
}

// The square [-half, half]^2 of the plane y = 0, seen from above.
inline Shape& add_floor(Scene& scene, float half, int material) {
    return add_quad(scene, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, material);
}

inline Shape& add_triangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, int material) {
    TriangleMesh mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    return add_shape(scene, std::move(mesh), material, "triangle");
}

inline Shape& add_sphere(Scene& scene, const glm::vec3& center, float radius, int material) {
    const glm::mat4 to_world = glm::scale(glm::translate(glm::mat4(1.0F), center), glm::vec3(radius));
    return add_shape(scene, AnalyticShape{AnalyticShape::Kind::sphere, to_world}, material, "sphere");
}

// A disk whose normal is -y, facing the floor.
inline Shape& add_disk_facing_down(Scene& scene, const glm::vec3& center, float radius, int material) {
    glm::mat4 to_world(radius);
    to_world[1] = {0, 0, radius, 0};
    to_world[2] = {0, -radius, 0, 0};
    to_world[3] = glm::vec4(center, 1);
    return add_shape(scene, AnalyticShape{AnalyticShape::Kind::disk, to_world}, material, "disk");
}

inline void make_emitter(Shape& shape, const Rgb& radiance) { shape.emitter = AreaEmitter{constant(radiance)}; }

}  // namespace wavelobe::test
