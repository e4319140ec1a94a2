// What all meshes go through on the way into the scene.
#include "scene/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wavelobe {

namespace {

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// In double precision the products of single-precision edges are exact enough to tell a thin triangle
// from one without area.
bool has_area(const TriangleMesh& mesh, const glm::uvec3& triangle) {
    const glm::vec3& p0 = mesh.positions[triangle.x];
    const glm::vec3& p1 = mesh.positions[triangle.y];
    const glm::vec3& p2 = mesh.positions[triangle.z];
    if (!is_finite(p0) || !is_finite(p1) || !is_finite(p2)) return false;
    const glm::dvec3 normal = glm::cross(glm::dvec3(p1) - glm::dvec3(p0), glm::dvec3(p2) - glm::dvec3(p0));
    return glm::dot(normal, normal) > 0.0;
}

// Along with the values of their faces; how many.
std::size_t drop_empty_triangles(TriangleMesh& mesh, std::vector<MeshAttribute>& attributes) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!has_area(mesh, mesh.triangles[i])) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        for (MeshAttribute& attribute : attributes)
            if (attribute.of_faces) attribute.values[kept] = attribute.values[i];
        ++kept;
    }
    const std::size_t dropped = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    return dropped;
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets" (JGT 1998).
std::vector<glm::vec3> angle_weighted_normals(const TriangleMesh& mesh) {
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const std::array<glm::dvec3, 3> p{mesh.positions[triangle.x], mesh.positions[triangle.y],
                                          mesh.positions[triangle.z]};
        const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (std::size_t k = 0; k < 3; ++k)
            sums[triangle[static_cast<int>(k)]] +=
                normal * angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
    }
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums) {
        const double length = glm::length(sum);
        normals.push_back(length > 0.0 ? glm::vec3(sum / length) : glm::vec3(1.0F, 0.0F, 0.0F));
    }
    return normals;
}

// Normals follow the inverse transpose; those a file leaves out or spoils are computed.
void place_normals(std::vector<glm::vec3>& normals, const MeshOptions& options, const TriangleMesh& mesh) {
    const glm::dmat3 to_world =
        glm::transpose(glm::inverse(glm::dmat3(options.to_world))) * (options.flip_normals ? -1.0 : 1.0);
    bool spoiled = false;
    for (glm::vec3& normal : normals) {
        const glm::dvec3 world = to_world * glm::dvec3(normal);
        const double length = glm::length(world);
        const bool usable = std::isfinite(length) && length > 0.0;
        normal = usable ? glm::vec3(world / length) : glm::vec3(0.0F);
        spoiled = spoiled || !usable;
    }
    if (!spoiled) return;
    const std::vector<glm::vec3> computed = angle_weighted_normals(mesh);
    for (std::size_t i = 0; i < normals.size(); ++i)
        if (normals[i] == glm::vec3(0.0F)) normals[i] = computed[i];
}

}  // namespace

PreparedMesh prepare_mesh(MeshSource&& source, const MeshOptions& options) {
    PreparedMesh prepared;
    TriangleMesh& mesh = prepared.mesh;
    mesh.positions = std::move(source.positions);
    mesh.uvs = std::move(source.uvs);
    mesh.triangles = std::move(source.triangles);
    if (options.to_world != glm::dmat4(1.0))
        for (glm::vec3& position : mesh.positions)
            position = glm::vec3(options.to_world * glm::dvec4(glm::dvec3(position), 1.0));

    const bool keeps_normals = !options.face_normals && !source.normals.empty();
    const bool mirrored = glm::determinant(glm::dmat3(options.to_world)) < 0.0;
    if ((mirrored && keeps_normals) != options.flip_normals)
        for (glm::uvec3& triangle : mesh.triangles) std::swap(triangle.x, triangle.z);
    prepared.attributes = std::move(source.attributes);
    prepared.dropped = drop_empty_triangles(mesh, prepared.attributes);

    if (options.face_normals || mesh.triangles.empty()) return prepared;
    if (keeps_normals) {
        place_normals(source.normals, options, mesh);
        mesh.normals = std::move(source.normals);
    } else {
        mesh.normals = angle_weighted_normals(mesh);
    }
    return prepared;
}

}  // namespace wavelobe
