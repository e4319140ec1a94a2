#include "scene/gltf_reader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "scene/gltf/cameras.h"
#include "scene/gltf/environment.h"
#include "scene/gltf/instancing.h"
#include "scene/gltf/lights.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/primitive.h"

namespace wavelobe {

namespace {

using namespace gltf;

// Kernels number vertices by 32-bit offsets; nodes may show one mesh any number of times.
constexpr std::size_t most_triangles = std::size_t{1} << 27;

class Reader {
public:
    Reader(const std::string& path, const GltfOptions& options)
        : document_(path), options_(options), accessors_(document_), tree_(document_), meshes_(document_, accessors_),
          materials_(document_, scene_) {
        scene_.name = std::filesystem::path(path).stem().string();
    }

    Scene run() {
        tree_.place();
        meshes_.check();
        materials_.check();
        add_shapes();
        add_punctual_lights(document_, tree_, scene_);
        place_camera(document_, tree_, {options_.width, options_.height}, scene_);
        if (!document_.faults.empty()) document_.faults.raise();
        add_light();
        if (dropped_ > 0) document_.warn(fmt::format("{}: {} triangles without area are left out", document_.file, dropped_));
        scene_.warnings = document_.warnings;
        return std::move(scene_);
    }

private:
    void add_shapes() {
        std::size_t triangles = 0;
        for (const Element& node : document_.nodes) node.index("mesh", document_.meshes.size(), "meshes");
        for (const std::size_t node : tree_.shown) {
            const auto mesh = document_.nodes[node].index("mesh", document_.meshes.size(), "meshes");
            if (!mesh) continue;
            const std::vector<glm::dmat4> copies = instances_of(document_, accessors_, node);
            for (const Primitive& primitive : meshes_.primitives(*mesh)) {
                triangles += primitive.mesh.triangles.size() * copies.size();
                if (triangles > most_triangles) {
                    document_.nodes[node].fault(fmt::format("brings the scene beyond {} triangles", most_triangles), "show less of it");
                    return;
                }
                if (!document_.faults.empty()) continue;
                for (const glm::dmat4& copy : copies) add_shape(node, *mesh, primitive, tree_.world[node] * copy);
            }
        }
    }

    void add_shape(std::size_t node, std::size_t mesh, const Primitive& primitive, const glm::dmat4& to_world) {
        MeshOptions options;
        options.to_world = to_world;
        const bool mirrored = glm::determinant(glm::dmat3(options.to_world)) < 0.0;
        options.face_normals = primitive.mesh.normals.empty();
        options.flip_normals = mirrored && options.face_normals;
        const Appearance& appearance = materials_.appearance(primitive.material);
        MeshSource source = primitive.mesh;
        if (appearance.uv_set == 1 && !primitive.second_uvs.empty()) source.uvs = primitive.second_uvs;
        PreparedMesh prepared = prepare_mesh(std::move(source), options);
        const std::string name = document_.nodes[node].text("name", document_.meshes[mesh].text("name", fmt::format("mesh {}", mesh)));
        dropped_ += prepared.dropped;
        if (prepared.mesh.triangles.empty()) return;
        for (const glm::vec4& color : primitive.colors) prepared.mesh.colors.emplace_back(color);
        Shape& shape = scene_.shapes.emplace_back();
        shape.geometry = std::move(prepared.mesh);
        shape.material = appearance.surface;
        shape.emitter = appearance.emitter;
        shape.name = name;
    }

    void add_light() {
        if (!scene_.emitters.empty()) return;
        scene_.notes.push_back("no light in " + document_.file + ": an environment of our own lights it");
        scene_.emitters.emplace_back(studio_environment());
    }

    Document document_;
    GltfOptions options_;
    Scene scene_;
    Accessors accessors_;
    NodeTree tree_;
    Meshes meshes_;
    Materials materials_;
    std::size_t dropped_ = 0;  // triangles without area
};

}  // namespace

Scene read_gltf_scene(const std::string& path, const GltfOptions& options) { return Reader(path, options).run(); }

bool is_gltf(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending == ".gltf" || ending == ".glb") return true;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;
    std::ifstream file(path, std::ios::binary);
    std::string start(64, '\0');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    const std::size_t first = start.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return start.starts_with("glTF") || (first != std::string::npos && start[first] == '{');
}

}  // namespace wavelobe
