// What the traversal benchmark traces rays through.
#pragma once

#include <string>
#include <vector>

#include "accel/bvh.h"

namespace wavelobe::benchmark {

struct BenchmarkMesh {
    std::string name;
    std::vector<TriangleVertices> triangles;
    glm::vec3 eye{0.0F};
    glm::vec3 target{0.0F};
    float fov_degrees = 70.0F;
    glm::vec3 light_corner{0.0F};  // a parallelogram to aim shadow rays at
    glm::vec3 light_edge1{0.0F};
    glm::vec3 light_edge2{0.0F};
};

// A closed room with two blocks: 36 triangles.
BenchmarkMesh box_mesh();

// A closed room of 200 bumpy spheres and tori, each of about `cells` x `cells` squares of two triangles.
BenchmarkMesh room_mesh(const std::string& name, int cells);

// The triangles of a Mitsuba scene, from its camera; the light hangs below the middle of the top of its bounds.
BenchmarkMesh scene_mesh(const std::string& name, const std::string& file);

}  // namespace wavelobe::benchmark
