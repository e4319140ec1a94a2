// Sets of rays that traversal is tested with.
#pragma once

#include "support/traversal_probe.h"

namespace wavelobe::test {

inline TestRay ray_to(const glm::vec3& origin, const glm::vec3& target) { return {origin, glm::normalize(target - origin)}; }

inline std::vector<TestRay> random_rays(std::size_t count, float scale, const glm::vec3& offset, unsigned seed) {
    Generator random(seed);
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        TestRay ray{uniform_in_cube(random, 1.5F) * scale + offset, uniform_direction(random)};
        if (i % 4 == 0) ray.limit = uniform(random, 0.0F, 2.0F) * scale;
        rays.push_back(ray);
    }
    return rays;
}

enum class Aim { corner, middle_of_edge, edge, anywhere };

// A ray to what `aim` says of a face's corner and of the edge that starts there.
inline TestRay aimed_ray(const glm::vec3& origin, const ClosedMesh& mesh, std::size_t face, std::size_t corner, Aim aim, Generator& random) {
    const glm::uvec3& f = mesh.faces[face];
    const glm::vec3 a = mesh.vertices[f[static_cast<int>(corner % 3)]];
    const glm::vec3 b = mesh.vertices[f[static_cast<int>((corner + 1) % 3)]];
    switch (aim) {
        case Aim::corner: return ray_to(origin, a);
        case Aim::middle_of_edge: return ray_to(origin, 0.5F * (a + b));
        case Aim::edge: return ray_to(origin, glm::mix(a, b, uniform(random, 0.0F, 1.0F)));
        default: return {origin, uniform_direction(random)};
    }
}

// Rays from inside a closed mesh to its vertices, to points of its edges, and anywhere.
inline std::vector<TestRay> rays_from_inside(const ClosedMesh& mesh, float inner_half, const glm::vec3& center, std::size_t count) {
    Generator random(7);
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 origin = center + (i % 5 == 0 ? glm::vec3{0.0F} : uniform_in_cube(random, inner_half));
        rays.push_back(aimed_ray(origin, mesh, i % mesh.faces.size(), i % 3, static_cast<Aim>(i % 4), random));
    }
    return rays;
}

}  // namespace wavelobe::test
