#include "scene/gltf_reader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "scene/gltf/animation.h"
#include "scene/gltf/backs.h"
#include "scene/gltf/cameras.h"
#include "scene/gltf/environment.h"
#include "scene/gltf/instancing.h"
#include "scene/gltf/lights.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/pose.h"
#include "scene/gltf/validity.h"
#include "scene/gltf/volumes.h"

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
        animate(document_, accessors_, options_.frame_time, tree_);
        tree_.place();
        check_extension_objects(document_);
        check_primitives(document_, accessors_);
        check_skins(document_, accessors_, tree_);
        meshes_.check();
        materials_.check();
        add_shapes();
        add_punctual_lights(document_, tree_, scene_);
        place_camera(document_, tree_, {options_.width, options_.height}, scene_);
        if (!document_.faults.empty()) document_.faults.raise();
        if (const std::size_t count = leave_out_backs(scene_, single_sided_); count > 0)
            document_.warn(fmt::format("{}: {} triangles of single-sided materials show the camera their backs alone and are left out", document_.file, count));
        clear_backs(scene_, single_sided_);
        part_media(scene_, volumes_);
        add_light();
        if (dropped_ > 0) document_.warn(fmt::format("{}: {} triangles without area are left out", document_.file, dropped_));
        scene_.warnings.insert(scene_.warnings.begin(), document_.warnings.begin(), document_.warnings.end());
        return std::move(scene_);
    }

private:
    void add_shapes() {
        std::size_t triangles = 0;
        for (const Element& node : document_.nodes) {
            node.index("mesh", document_.meshes.size(), "meshes");
            node.index("skin", document_.skins.size(), "skins");
            const auto mesh = node.index("mesh", document_.meshes.size(), "meshes");
            if (!mesh) continue;
            meshes_.check_weights(*mesh, node);
            const std::vector<Primitive>& primitives = meshes_.primitives(*mesh);
            const bool bends = std::any_of(primitives.begin(), primitives.end(), [](const Primitive& p) { return !p.influences.empty(); });
            if (node.has("skin") && !primitives.empty() && !bends) node.fault("has a `skin`, and its mesh no JOINTS_0 that follow it");
        }
        for (std::size_t skin = 0; skin < document_.skins.size(); ++skin) joint_matrices(document_, accessors_, skin, tree_);
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
                show(node, *mesh, primitive, copies);
            }
        }
    }

    // Morphed, and then where its joints or its node take it.
    void show(std::size_t node, std::size_t mesh, const Primitive& primitive, const std::vector<glm::dmat4>& copies) {
        std::vector<double> weights = tree_.local[node].weights;
        if (weights.empty()) weights = document_.meshes[mesh].numbers("weights");
        const auto skin = document_.nodes[node].index("skin", document_.skins.size(), "skins");
        const bool bends = skin && !primitive.influences.empty();
        const bool morphs = !primitive.targets.empty() && std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0.0; });
        if (!bends && !morphs) {
            for (const glm::dmat4& copy : copies) add_shape(node, mesh, primitive, tree_.world[node] * copy);
            return;
        }
        Primitive posed = primitive;
        if (morphs) morph(posed, weights);
        if (bends) bend(document_, joint_matrices(document_, accessors_, *skin, tree_), primitive.path, posed);
        if (!document_.faults.empty()) return;
        for (const glm::dmat4& copy : copies) add_shape(node, mesh, posed, bends ? copy : tree_.world[node] * copy);
    }

    void add_shape(std::size_t node, std::size_t mesh, const Primitive& primitive, const glm::dmat4& to_world) {
        MeshOptions options;
        options.to_world = to_world;
        const bool mirrored = glm::determinant(glm::dmat3(options.to_world)) < 0.0;
        options.face_normals = primitive.mesh.normals.empty();
        options.flip_normals = mirrored && options.face_normals;
        const Appearance& appearance = materials_.appearance(primitive.material);
        MeshSource source = primitive.mesh;
        const auto coordinates = [&](std::size_t slot) -> std::vector<glm::vec2> {
            const bool used = slot < appearance.uv_sets.size();
            const std::size_t set = used ? static_cast<std::size_t>(appearance.uv_sets[slot]) : slot;
            if (set < primitive.uv_sets.size() && (used || slot == 0)) return primitive.uv_sets[set];
            if (!used) return {};
            document_.faults.add(primitive.path, fmt::format("its material looks up TEXCOORD_{}, which it does not have", set));
            return {};
        };
        source.uvs = coordinates(0);
        PreparedMesh prepared = prepare_mesh(std::move(source), options);
        const std::string name = document_.nodes[node].text("name", document_.meshes[mesh].text("name", fmt::format("mesh {}", mesh)));
        dropped_ += prepared.dropped;
        if (prepared.mesh.triangles.empty()) return;
        prepared.mesh.second_uvs = coordinates(1);
        add_colors(primitive, appearance, prepared.mesh);
        Shape shape;
        shape.material = appearance.surface;
        shape.emitter = appearance.emitter;
        shape.name = name;
        if (appearance.needs_tangents) {
            // The bitangent goes with the handedness of the tangents, and without any with the winding of the texture coordinates.
            add_tangents(primitive, to_world, prepared.mesh);
            if (prepared.mesh.uvs.empty() && prepared.mesh.tangents.empty())
                document_.warn(fmt::format("{}: {}: its material asks for tangents, and it has neither TANGENT nor texture coordinates", document_.file, primitive.path));
            TriangleMesh other = split_mirrored(prepared.mesh, mirrored ? -1.0F : 1.0F, primitive.tangents);
            if (!other.triangles.empty()) {
                Shape half = shape;
                half.material = materials_.mirrored(primitive.material);
                add_whole(std::move(half), std::move(other), appearance);
            }
        }
        if (!prepared.mesh.triangles.empty()) add_whole(std::move(shape), std::move(prepared.mesh), appearance);
    }

    void add_whole(Shape shape, TriangleMesh mesh, const Appearance& appearance) {
        if (appearance.single_sided) single_sided_.push_back(scene_.shapes.size());
        if (appearance.is_volume) volumes_.push_back({scene_.shapes.size(), appearance.medium});
        shape.geometry = std::move(mesh);
        scene_.shapes.push_back(std::move(shape));
    }

    static void add_tangents(const Primitive& primitive, const glm::dmat4& to_world, TriangleMesh& mesh) {
        if (mesh.normals.empty()) return;  // the specification has them ignored then
        for (const glm::vec4& tangent : primitive.tangents) {
            const glm::dvec3 world = glm::dmat3(to_world) * glm::dvec3(tangent);
            const double length = glm::length(world);
            mesh.tangents.push_back(length > 0.0 ? glm::vec3(world / length) : glm::vec3(0.0F));
        }
    }

    // Takes the triangles whose tangents are left-handed out of a mesh; `side` is -1 where a mirrored node turns all of them over.
    // Without tangents, those whose texture coordinates run the other way round. Those of an image go down: seen from the front,
    // triangles that are not mirrored turn against them.
    static TriangleMesh split_mirrored(TriangleMesh& mesh, float side, const std::vector<glm::vec4>& tangents) {
        if (mesh.uvs.empty() && mesh.tangents.empty()) return {};
        const auto is_right_handed = [&](const glm::uvec3& t) {
            if (!mesh.tangents.empty()) return side * tangents[t.x].w >= 0.0F;
            const glm::dvec2 a = glm::dvec2(mesh.uvs[t.y]) - glm::dvec2(mesh.uvs[t.x]);
            const glm::dvec2 b = glm::dvec2(mesh.uvs[t.z]) - glm::dvec2(mesh.uvs[t.x]);
            return a.x * b.y - a.y * b.x <= 0.0;
        };
        const auto middle = std::stable_partition(mesh.triangles.begin(), mesh.triangles.end(), is_right_handed);
        if (middle == mesh.triangles.end()) return {};
        TriangleMesh other = mesh;
        other.triangles.assign(middle, mesh.triangles.end());
        mesh.triangles.erase(middle, mesh.triangles.end());
        return other;
    }

    static void add_colors(const Primitive& primitive, const Appearance& appearance, TriangleMesh& mesh) {
        for (const glm::vec4& color : primitive.colors) mesh.colors.emplace_back(color);
        if (!appearance.blends) return;
        for (const glm::vec4& color : primitive.colors) mesh.alphas.push_back(color.a);
        if (std::all_of(mesh.alphas.begin(), mesh.alphas.end(), [](float a) { return a == 1.0F; })) mesh.alphas.clear();
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
    std::vector<std::size_t> single_sided_;  // shapes
    std::vector<Volume> volumes_;
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
