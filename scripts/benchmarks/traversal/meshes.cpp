#include "meshes.h"

#include <cmath>
#include <numbers>
#include <random>

#include "render/flatten.h"
#include "scene/mitsuba_reader.h"

namespace wavelobe::benchmark {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

void add_block(BenchmarkMesh& mesh, const glm::vec3& center, const glm::vec3& half, float turn) {
    const auto corner = [&](int i) {
        const glm::vec3 p{(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y, (i & 4) != 0 ? half.z : -half.z};
        const float c = std::cos(turn);
        const float s = std::sin(turn);
        return center + glm::vec3{c * p.x + s * p.z, p.y, c * p.z - s * p.x};
    };
    constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& f : faces) {
        mesh.triangles.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
        mesh.triangles.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
    }
}

struct Ornament {
    glm::vec3 center;
    float radius, phase, waves, tilt;
    bool torus;

    glm::vec3 at(float u, float v) const {
        glm::vec3 p;
        if (torus) {
            const float d = 0.35F * radius * (1.0F + 0.15F * std::sin(std::floor(waves) * u + phase) * std::cos(3.0F * v));
            p = {(radius + d * std::cos(v)) * std::cos(u), d * std::sin(v), (radius + d * std::cos(v)) * std::sin(u)};
        } else {
            const float d = radius * (1.0F + 0.12F * std::sin(std::floor(waves) * u + phase) * std::sin(5.0F * v));
            p = {d * std::sin(v) * std::cos(u), d * std::cos(v), d * std::sin(v) * std::sin(u)};
        }
        const float c = std::cos(tilt);
        const float s = std::sin(tilt);
        return center + glm::vec3{p.x, c * p.y - s * p.z, s * p.y + c * p.z};
    }
};

void add_ornament(BenchmarkMesh& mesh, const Ornament& ornament, int cells) {
    const auto point = [&](int i, int j) {
        const auto n = static_cast<float>(cells);
        const float u = 2.0F * pi * static_cast<float>(i % cells) / n;
        const float v = ornament.torus ? 2.0F * pi * static_cast<float>(j % cells) / n : pi * static_cast<float>(j) / n;
        return ornament.at(u, v);
    };
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            const glm::vec3 a = point(i, j);
            const glm::vec3 b = point(i + 1, j);
            const glm::vec3 c = point(i, j + 1);
            const glm::vec3 d = point(i + 1, j + 1);
            // Squares at a sphere's poles are triangles.
            if (ornament.torus || j > 0) mesh.triangles.push_back({a, b, d});
            if (ornament.torus || j < cells - 1) mesh.triangles.push_back({a, d, c});
        }
    }
}

}  // namespace

BenchmarkMesh box_mesh() {
    BenchmarkMesh mesh{"box", {}, {0, 0, 0.97F}, {0, -0.1F, 0}, 70.0F, {-0.25F, 0.98F, -0.25F}, {0.5F, 0, 0}, {0, 0, 0.5F}};
    add_block(mesh, {0, 0, 0}, {1, 1, 1}, 0);
    add_block(mesh, {-0.35F, -0.4F, -0.3F}, {0.28F, 0.6F, 0.28F}, 0.35F);
    add_block(mesh, {0.35F, -0.7F, 0.3F}, {0.28F, 0.3F, 0.28F}, -0.3F);
    return mesh;
}

BenchmarkMesh room_mesh(const std::string& name, int cells) {
    BenchmarkMesh mesh{name, {}, {0, 0.5F, 9.7F}, {0, -0.3F, 0}, 70.0F, {-2, 4.9F, -2}, {4, 0, 0}, {0, 0, 4}};
    add_block(mesh, {0, 0, 0}, {10, 5, 10}, 0);
    std::mt19937 random(12345);
    const auto uniform = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
    for (int i = 0; i < 200; ++i) {
        Ornament o{};
        o.center = {18 * uniform() - 9, 8.4F * uniform() - 4.6F, 18 * uniform() - 9};
        // Nothing right before the camera.
        if (std::abs(o.center.x) < 1.6F && o.center.z > 6) o.center.x += o.center.x < 0 ? -2.0F : 2.0F;
        o.radius = 0.35F + 0.6F * uniform();
        o.phase = 2 * pi * uniform();
        o.waves = 3 + 6 * uniform();
        o.tilt = pi * uniform();
        o.torus = i % 2 == 1;
        add_ornament(mesh, o, cells);
    }
    return mesh;
}

BenchmarkMesh scene_mesh(const std::string& name, const std::string& file) {
    const Scene scene = read_mitsuba_scene(file);
    BenchmarkMesh mesh;
    mesh.name = name;
    mesh.triangles = flatten_scene(scene).triangles;
    mesh.eye = glm::vec3(scene.camera.to_world[3]);
    mesh.target = mesh.eye + glm::vec3(scene.camera.to_world[2]);
    mesh.fov_degrees = scene.camera.fov_x_degrees;
    Bounds bounds;
    for (const TriangleVertices& t : mesh.triangles) {
        for (const glm::vec3& p : t) bounds.extend(p);
    }
    const glm::vec3 size = bounds.upper - bounds.lower;
    mesh.light_corner = bounds.lower + size * glm::vec3{0.4F, 0.95F, 0.4F};
    mesh.light_edge1 = {0.2F * size.x, 0, 0};
    mesh.light_edge2 = {0, 0, 0.2F * size.z};
    return mesh;
}

}  // namespace wavelobe::benchmark
