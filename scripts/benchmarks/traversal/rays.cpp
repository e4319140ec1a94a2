#include "rays.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

namespace wavelobe::benchmark {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t none = 0xffffffffU;

class Uniform {
public:
    explicit Uniform(unsigned seed) : random_(seed) {}
    float operator()() { return static_cast<float>(random_() >> 8U) * 0x1p-24F; }
    glm::vec3 direction() {
        const float z = 2 * (*this)() - 1;
        const float phi = 2 * std::numbers::pi_v<float> * (*this)();
        const float r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }

private:
    std::mt19937 random_;
};

RaySet camera_rays(const BenchmarkMesh& mesh, std::size_t side) {
    RaySet rays("camera", false, side * side);
    const glm::vec3 forward = glm::normalize(mesh.target - mesh.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3{0, 1, 0}));
    const glm::vec3 up = glm::cross(right, forward);
    const float half = std::tan(0.5F * glm::radians(mesh.fov_degrees));
    Uniform uniform(777);
    for (std::size_t i = 0; i < rays.count; ++i) {
        const std::size_t square = i / 16;
        const std::size_t x = square % (side / 4) * 4 + i % 4;
        const std::size_t y = square / (side / 4) * 4 + i / 4 % 4;
        const float u = 2 * (static_cast<float>(x) + uniform()) / static_cast<float>(side) - 1;
        const float v = 1 - 2 * (static_cast<float>(y) + uniform()) / static_cast<float>(side);
        rays.set(i, mesh.eye, glm::normalize(forward + half * (u * right + v * up)), infinity, none);
    }
    return rays;
}

struct Vertex {
    glm::vec3 position, normal;  // the normal on the side that is seen
    std::uint32_t primitive;
};

// Where the rays end, a little off the surface. Rays that escape stay at their origin and turn around.
std::vector<Vertex> vertices_of(const BenchmarkMesh& mesh, const EmbreeScene& scene, const RaySet& rays) {
    std::vector<float> t(rays.count);
    std::vector<std::uint32_t> primitives(rays.count, none);
    scene.trace(rays, 0, rays.count, EmbreeScene::Mode::single, false, t.data(), primitives.data());
    std::vector<Vertex> vertices(rays.count);
    for (std::size_t i = 0; i < rays.count; ++i) {
        const glm::vec3 origin{rays.field(0)[i], rays.field(1)[i], rays.field(2)[i]};
        const glm::vec3 direction{rays.field(3)[i], rays.field(4)[i], rays.field(5)[i]};
        if (primitives[i] == none) {
            vertices[i] = {origin, -direction, none};
            continue;
        }
        const TriangleVertices& triangle = mesh.triangles[primitives[i]];
        glm::vec3 n = glm::normalize(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
        if (glm::dot(n, direction) > 0) n = -n;
        vertices[i] = {origin + t[i] * direction + 1e-5F * t[i] * n, n, primitives[i]};
    }
    return vertices;
}

RaySet diffuse_rays(const std::vector<Vertex>& from, const std::string& name, unsigned seed) {
    RaySet rays(name, false, from.size());
    Uniform uniform(seed);
    for (std::size_t i = 0; i < from.size(); ++i) {
        glm::vec3 d = from[i].normal + 0.9999F * uniform.direction();
        rays.set(i, from[i].position, glm::normalize(d), infinity, from[i].primitive);
    }
    return rays;
}

RaySet shadow_rays(const std::vector<Vertex>& from, const BenchmarkMesh& mesh) {
    RaySet rays("shadow", true, from.size());
    Uniform uniform(99);
    for (std::size_t i = 0; i < from.size(); ++i) {
        const glm::vec3 light = mesh.light_corner + uniform() * mesh.light_edge1 + uniform() * mesh.light_edge2;
        const glm::vec3 way = light - from[i].position;
        rays.set(i, from[i].position, glm::normalize(way), 0.999F * glm::length(way), from[i].primitive);
    }
    return rays;
}

RaySet random_rays(const BenchmarkMesh& mesh, std::size_t count) {
    RaySet rays("random", false, count);
    Bounds bounds;
    for (const TriangleVertices& t : mesh.triangles) {
        for (const glm::vec3& p : t) bounds.extend(p);
    }
    const glm::vec3 center = 0.5F * (bounds.lower + bounds.upper);
    const float radius = 0.5F * glm::length(bounds.upper - bounds.lower);
    Uniform uniform(4);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 a = center + radius * uniform.direction();
        rays.set(i, a, glm::normalize(center + radius * uniform.direction() - a), infinity, none);
    }
    return rays;
}

}  // namespace

void RaySet::set(std::size_t i, const glm::vec3& origin, const glm::vec3& direction, float limit, std::uint32_t from) {
    for (std::size_t k = 0; k < 3; ++k) {
        field(k)[i] = origin[static_cast<glm::length_t>(k)];
        field(3 + k)[i] = direction[static_cast<glm::length_t>(k)];
    }
    field(6)[i] = limit;
    std::memcpy(field(7) + i, &from, sizeof from);
}

std::vector<RaySet> ray_sets(const BenchmarkMesh& mesh, const EmbreeScene& scene, std::size_t side) {
    std::vector<RaySet> sets;
    sets.push_back(camera_rays(mesh, side));
    const std::vector<Vertex> first = vertices_of(mesh, scene, sets[0]);
    sets.push_back(diffuse_rays(first, "bounce1", 1));
    const RaySet second = diffuse_rays(vertices_of(mesh, scene, sets[1]), "bounce2", 2);
    sets.push_back(diffuse_rays(vertices_of(mesh, scene, second), "bounce3", 3));
    sets.push_back(shadow_rays(first, mesh));
    sets.push_back(random_rays(mesh, side * side));
    return sets;
}

}  // namespace wavelobe::benchmark
