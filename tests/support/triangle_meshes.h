// Triangles to trace rays against: soups, closed meshes, grids.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "accel/bvh.h"

namespace wavelobe::test {

using Triangles = std::vector<TriangleVertices>;
using Generator = std::mt19937;

inline float uniform(Generator& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

inline glm::vec3 uniform_in_cube(Generator& random, float half) {
    return {uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half)};
}

inline glm::vec3 uniform_direction(Generator& random) {
    const float z = uniform(random, -1.0F, 1.0F);
    const float phi = uniform(random, 0.0F, 2.0F * std::numbers::pi_v<float>);
    const float r = std::sqrt(1.0F - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Triangles of about `size` about points of the cube [-1, 1]^3, under p * scale + offset.
inline Triangles triangle_soup(std::size_t count, float size, float scale, const glm::vec3& offset, unsigned seed) {
    Generator random(seed);
    Triangles triangles(count);
    for (TriangleVertices& t : triangles) {
        const glm::vec3 center = uniform_in_cube(random, 1.0F);
        for (glm::vec3& v : t) v = (center + uniform_in_cube(random, size)) * scale + offset;
    }
    return triangles;
}

// A closed mesh by its vertices, so that neighbours share them to the bit.
struct ClosedMesh {
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> faces;

    Triangles triangles() const {
        Triangles out;
        for (const glm::uvec3& f : faces) out.push_back({vertices[f.x], vertices[f.y], vertices[f.z]});
        return out;
    }
};

// An octahedron whose faces are cut in four `levels` times and blown up to a sphere.
inline ClosedMesh sphere_mesh(int levels, float radius, const glm::vec3& center) {
    std::vector<glm::dvec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<glm::uvec3> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                  {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<unsigned, unsigned>, unsigned> middles;
        const auto middle = [&](unsigned a, unsigned b) {
            const auto key = std::minmax(a, b);
            const auto [entry, added] = middles.try_emplace(key, static_cast<unsigned>(points.size()));
            if (added) points.push_back(glm::normalize(points[a] + points[b]));
            return entry->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& f : faces) {
            const unsigned ab = middle(f.x, f.y);
            const unsigned bc = middle(f.y, f.z);
            const unsigned ca = middle(f.z, f.x);
            for (const glm::uvec3& g : {glm::uvec3{f.x, ab, ca}, {ab, f.y, bc}, {ca, bc, f.z}, {ab, bc, ca}})
                finer.push_back(g);
        }
        faces = std::move(finer);
    }
    ClosedMesh mesh{{}, std::move(faces)};
    for (const glm::dvec3& p : points) mesh.vertices.emplace_back(glm::vec3(p * static_cast<double>(radius)) + center);
    return mesh;
}

// The surface of the cube [-1, 1]^3, each side cut into n x n squares of two triangles; normals point inwards.
inline ClosedMesh cube_mesh(int n) {
    ClosedMesh mesh;
    std::map<std::array<int, 3>, unsigned> known;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [entry, added] = known.try_emplace(p, static_cast<unsigned>(mesh.vertices.size()));
        const auto at = [n](int i) { return 2.0F * static_cast<float>(i) / static_cast<float>(n) - 1.0F; };
        if (added) mesh.vertices.emplace_back(at(p[0]), at(p[1]), at(p[2]));
        return entry->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {0, n}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> p{};
                        p[axis] = side;
                        p[(axis + 1) % 3] = i + (side == 0 ? a : b);
                        p[(axis + 2) % 3] = j + (side == 0 ? b : a);
                        return vertex(p);
                    };
                    mesh.faces.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
                    mesh.faces.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
                }
            }
        }
    }
    return mesh;
}

// A room with a turned block in it, `lift` above its floor: rectangles whose corners are rounded.
inline Triangles furnished_room(float scale, const glm::vec3& offset, float lift) {
    Triangles triangles = cube_mesh(1).triangles();
    const float sine = std::sin(0.3F), cosine = std::cos(0.3F);
    for (const TriangleVertices& t : cube_mesh(1).triangles()) {
        TriangleVertices turned;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 p = 0.3F * t[k];
            turned[k] = {cosine * p.x - sine * p.z + 0.2F, p.y - 0.7F + lift, sine * p.x + cosine * p.z - 0.1F};
        }
        triangles.push_back(turned);
    }
    for (TriangleVertices& t : triangles) {
        for (glm::vec3& v : t) v = scale * v + offset;
    }
    return triangles;
}

// Unit squares of two triangles in y = 0 over [-n, n]^2.
inline Triangles floor_grid(int n) {
    Triangles out;
    for (int x = -n; x < n; ++x) {
        for (int z = -n; z < n; ++z) {
            const auto p = [](int a, int b) { return glm::vec3{static_cast<float>(a), 0.0F, static_cast<float>(b)}; };
            out.push_back({p(x, z), p(x, z + 1), p(x + 1, z + 1)});
            out.push_back({p(x, z), p(x + 1, z + 1), p(x + 1, z)});
        }
    }
    return out;
}

}  // namespace wavelobe::test
