// Scenes of one group in several places.
#pragma once

#include "support/scenes.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {

inline TriangleMesh mesh_of(const Triangles& triangles) {
    TriangleMesh mesh;
    for (const TriangleVertices& t : triangles) {
        const auto first = static_cast<unsigned>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), t.begin(), t.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

// One shape, which enters the scene through instances alone.
inline Shape& add_group(Scene& scene, std::variant<TriangleMesh, AnalyticShape> geometry, int material) {
    ShapeGroup& group = scene.groups.emplace_back();
    Shape& shape = group.shapes.emplace_back();
    shape.geometry = std::move(geometry);
    shape.material.front = shape.material.back = material;
    return shape;
}

inline void add_instance(Scene& scene, const glm::mat4& to_world) {
    scene.instances.push_back({static_cast<int>(scene.groups.size()) - 1, to_world});
}

struct InstancePlacement {
    const char* name;
    glm::vec3 scale;   // mirrored where negative
    glm::vec3 offset;  // world space
};

inline void PrintTo(const InstancePlacement& placement, std::ostream* out) { *out << placement.name; }

inline glm::mat4 map_of(const InstancePlacement& placement) {
    const glm::mat4 turned = glm::rotate(glm::translate(glm::mat4(1.0F), placement.offset), 0.7F, glm::vec3{0.36F, 0.48F, 0.8F});
    return glm::scale(turned, placement.scale);
}

inline glm::dvec3 placed(const glm::mat4& map, const glm::vec3& p) { return glm::dvec3(glm::dmat4(map) * glm::dvec4(p, 1.0)); }

// Straight, tiny, huge, uneven, mirrored, and far from the origin.
inline std::vector<InstancePlacement> instance_placements() {
    return {{"unit", {1, 1, 1}, {0, 0, 0}},
            {"tiny", {1e-6F, 1e-6F, 1e-6F}, {3e-6F, 2e-6F, -1e-6F}},
            {"huge", {1e6F, 1e6F, 1e6F}, {-4e6F, 1e6F, 2e6F}},
            {"uneven", {20, 0.3F, 2}, {1, 2, 3}},
            {"mirrored", {-1, 1, 1}, {0.5F, 0.25F, -2}},
            {"mirrored_uneven", {3, -0.1F, 1}, {-5, 0.25F, -2}},
            {"away", {1, 1, 1}, {1000, -300, 500}},
            {"uneven_away", {0.01F, 1, 4}, {-700, 30, 80}}};
}

}  // namespace wavelobe::test
