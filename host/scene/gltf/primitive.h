// Mesh primitives: triangles with their attributes, in the space of their node.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "scene/gltf/draco.h"
#include "scene/mesh.h"

namespace wavelobe::gltf {

struct MorphTarget {  // what a weight of one adds
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec3> tangents;
    std::vector<glm::vec4> colors;
    std::vector<std::vector<glm::vec2>> uv_sets;
};

struct Influence {  // four joints of a skin a vertex
    std::vector<glm::vec4> joints;
    std::vector<glm::vec4> weights;
};

// Attributes are empty or one a vertex.
struct Primitive {
    MeshSource mesh;  // without texture coordinates
    std::vector<std::vector<glm::vec2>> uv_sets;
    std::vector<glm::vec4> tangents;
    std::vector<glm::vec4> colors;  // linear, alpha last
    std::vector<MorphTarget> targets;
    std::vector<Influence> influences;
    std::optional<std::size_t> material;
    std::string path;  // in the document
};

// What of a mesh can be shown: a primitive of points or lines, or without positions, is passed over with a warning.
// Faults go to the document.
class Meshes {
public:
    Meshes(Document& document, const Accessors& accessors);

    // Checks all meshes, also those that no node shows.
    void check();
    // A fault where `owner`, a node of the mesh or the mesh itself, has not as many weights as the mesh has morph targets.
    void check_weights(std::size_t mesh, const Element& owner);
    // The primitives of a mesh; read once.
    const std::vector<Primitive>& primitives(std::size_t mesh);

private:
    Primitive read(const Element& primitive);
    void read_triangles(const Element& primitive, Primitive& out);
    void read_influences(const Element& attributes, Primitive& out);
    MorphTarget read_target(const Element& attributes, const Element& target, std::size_t vertices);
    std::vector<std::vector<glm::vec2>> read_uv_sets(const Element& attributes, std::size_t vertices);
    std::vector<glm::vec4> read_colors(const Element& attributes, std::size_t vertices, float alpha);
    void check_format(const Element& attributes, const std::string& name, std::size_t accessor);
    void check_bounds(const Element& attributes, std::size_t accessor, const std::vector<float>& values);
    std::vector<std::uint32_t> vertex_order(const Element& primitive, std::size_t vertices);
    // Numbers of an attribute; empty when it is absent or faulty. `types` are those it may have.
    std::vector<float> attribute(const Element& attributes, const std::string& name, std::initializer_list<const char*> types,
                                 std::size_t vertices);

    Document& document_;
    const Accessors& accessors_;
    std::optional<UnpackedPrimitive> unpacked_;  // of the primitive that is being read, where it is compressed
    bool quantized_ = false;  // KHR_mesh_quantization: more number formats
    std::vector<std::unique_ptr<std::vector<Primitive>>> read_;
};

}  // namespace wavelobe::gltf
