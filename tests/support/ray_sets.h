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

// Rays from inside a closed mesh to its vertices, to points of its edges, and anywhere.
inline std::vector<TestRay> rays_from_inside(const ClosedMesh& mesh, float inner_half, const glm::vec3& center, std::size_t count) {
    Generator random(7);
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 origin = center + (i % 5 == 0 ? glm::vec3{0.0F} : uniform_in_cube(random, inner_half));
        const glm::uvec3& f = mesh.faces[i % mesh.faces.size()];
        const glm::vec3 a = mesh.vertices[f[static_cast<int>(i % 3)]];
        const glm::vec3 b = mesh.vertices[f[static_cast<int>((i + 1) % 3)]];
        switch (i % 4) {
            case 0: rays.push_back(ray_to(origin, a)); break;
            case 1: rays.push_back(ray_to(origin, 0.5F * (a + b))); break;
            case 2: rays.push_back(ray_to(origin, glm::mix(a, b, uniform(random, 0.0F, 1.0F)))); break;
            default: rays.push_back({origin, uniform_direction(random)}); break;
        }
    }
    return rays;
}

}  // namespace wavelobe::test
