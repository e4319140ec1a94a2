// Mesh primitives: triangles with their attributes, in the space of their node.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "scene/gltf/accessor.h"
#include "scene/mesh.h"

namespace wavelobe::gltf {

// Attributes are empty or one a vertex.
struct Primitive {
    MeshSource mesh;
    std::vector<glm::vec4> tangents;
    std::vector<glm::vec4> colors;  // linear, alpha last
    std::vector<glm::vec2> second_uvs;
    std::optional<std::size_t> material;
};

// What of a mesh can be shown: a primitive of points or lines, or without positions, is passed over with a warning.
// Faults go to the document.
class Meshes {
public:
    Meshes(Document& document, const Accessors& accessors) : document_(document), accessors_(accessors) {}

    // Checks all meshes, also those that no node shows.
    void check();
    // The primitives of a mesh; read once.
    const std::vector<Primitive>& primitives(std::size_t mesh);

private:
    Primitive read(const Element& primitive);
    void read_triangles(const Element& primitive, Primitive& out);
    std::vector<std::uint32_t> vertex_order(const Element& primitive, std::size_t vertices);
    // Numbers of an attribute; empty when it is absent or faulty. `types` are those it may have.
    std::vector<float> attribute(const Element& attributes, const char* name, std::initializer_list<const char*> types,
                                 std::size_t vertices);

    Document& document_;
    const Accessors& accessors_;
    std::vector<std::unique_ptr<std::vector<Primitive>>> read_;
};

}  // namespace wavelobe::gltf
