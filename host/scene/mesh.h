// Triangle meshes from files, and what all of them go through on the way into the scene.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace wavelobe {

struct MeshOptions {
    glm::dmat4 to_world{1.0};
    bool face_normals = false;  // no shading normals, not even those of the file
    bool flip_normals = false;  // turn the surface inside out
};

// Values of a mesh beside its positions, normals and texture coordinates.
struct MeshAttribute {
    std::string name;  // such as `vertex_color`
    int channels = 3;  // 1: all three are the same
    bool of_faces = false;
    std::vector<glm::vec3> values;  // one a vertex, or one a triangle
};

// A mesh in the space of its file.
struct MeshSource {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  // empty, or one a vertex: zero where there is none
    std::vector<glm::vec2> uvs;      // empty, or one a vertex
    std::vector<glm::uvec3> triangles;
    std::vector<MeshAttribute> attributes;
};

struct PreparedMesh {
    TriangleMesh mesh;
    std::vector<MeshAttribute> attributes;
    std::size_t dropped = 0;  // triangles without area or with positions that are not finite
};

// Moves the mesh into world space. Without normals in the file, and unless `face_normals` is set, the
// vertex normals are the face normals around, weighted by the angle of each corner. Under a mirroring
// transform normals of the file stay on their side of the surface, and the winding follows them; without
// them the winding is kept, and the surface shows its other side. So does Mitsuba 3.9.1.
PreparedMesh prepare_mesh(MeshSource&& source, const MeshOptions& options);

// Throw InputError naming the file, and the line where that is known.
MeshSource load_obj(const std::string& path, bool flip_tex_coords);
// The attributes of these names, where the file has them.
MeshSource load_ply(const std::string& path, bool flip_tex_coords, const std::vector<std::string>& attributes = {});
// Mesh `index` of a file of Mitsuba's own.
MeshSource load_serialized(const std::string& path, std::uint32_t index);

}  // namespace wavelobe
