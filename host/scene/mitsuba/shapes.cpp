// The shape plugins.
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "scene/mesh.h"
#include "scene/mitsuba/query.h"
#include "scene/mitsuba/transforms.h"

namespace wavelobe::mitsuba {

namespace {

using Kind = AnalyticShape::Kind;

constexpr const char* attribute_naming = "`vertex_color` is made of `red`, `green` and `blue`, `vertex_a` of `a_x`, `a_y` and `a_z`";

MeshOptions mesh_options(Query& query) {
    MeshOptions options;
    options.to_world = query.transform("to_world");
    options.flip_normals = query.boolean("flip_normals", false);
    options.face_normals = query.boolean("face_normals", false);
    return options;
}

// A flat shape whose outside stays outside under mirroring; it needs no shading normals of its own.
TriangleMesh prepare_flat(MeshSource&& source, MeshOptions options) {
    if (glm::determinant(glm::dmat3(options.to_world)) < 0.0) options.flip_normals = !options.flip_normals;
    options.face_normals = true;
    return prepare_mesh(std::move(source), options).mesh;
}

// [-1, 1]^2 in z = 0, normal +z.
bool read_rectangle(Query& query, Shape& shape) {
    MeshSource source;
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
        source.positions.emplace_back(2.0F * corner - 1.0F, 0.0F);
        source.uvs.push_back(corner);
    }
    source.triangles = {{0, 1, 2}, {0, 2, 3}};
    TriangleMesh mesh = prepare_flat(std::move(source), mesh_options(query));
    mesh.parallelogram = mesh.triangles.size() == 2;
    // Where the winding was turned around, renumber the corners so that the triangles are (0,1,2) (0,2,3) again.
    if (mesh.parallelogram && mesh.triangles[0] != glm::uvec3(0, 1, 2)) {
        std::swap(mesh.positions[1], mesh.positions[3]);
        std::swap(mesh.uvs[1], mesh.uvs[3]);
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    }
    shape.geometry = std::move(mesh);
    return true;
}

// [-1, 1]^3, each face with the whole of the texture.
bool read_cube(Query& query, Shape& shape) {
    // For each face the corners around it; bit k of a corner is the sign of its coordinate k.
    constexpr std::array<std::array<int, 4>, 6> faces{
        {{1, 5, 4, 0}, {3, 2, 6, 7}, {1, 3, 7, 5}, {5, 7, 6, 4}, {4, 6, 2, 0}, {3, 1, 0, 2}}};
    const std::array<glm::vec2, 4> uvs{glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)};
    MeshSource source;
    for (const auto& corners : faces) {
        const auto first = static_cast<std::uint32_t>(source.positions.size());
        for (std::size_t k = 0; k < 4; ++k) {
            const int corner = corners[k];
            source.positions.emplace_back((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                          (corner & 4) != 0 ? 1 : -1);
            source.uvs.push_back(uvs[k]);
        }
        source.triangles.emplace_back(first, first + 1, first + 2);
        source.triangles.emplace_back(first + 3, first, first + 2);
    }
    shape.geometry = prepare_flat(std::move(source), mesh_options(query));
    return true;
}

// Gives the mesh the attributes that what it shows asks for.
void place_attributes(Query& query, PreparedMesh& prepared) {
    Context& context = query.context();
    if (context.attributes.empty()) return;
    for (const AttributeUse& use : context.attributes) {
        const auto found = std::find_if(prepared.attributes.begin(), prepared.attributes.end(),
                                        [&](const MeshAttribute& attribute) { return attribute.name == use.name; });
        if (found == prepared.attributes.end())
            query.fault("the mesh has no attribute `" + use.name + "`, which its BSDF or emitter asks for",
                        "use a PLY file that has it; " + std::string(attribute_naming));
        else if (use.scalar && found->channels != 1)
            query.fault("the attribute `" + use.name + "` is a colour where one number is asked for", "use an attribute of one channel");
    }
    context.mesh_attributes.add_mesh(prepared.mesh, prepared.attributes);
}

bool read_mesh_file(Query& query, Shape& shape, const std::function<MeshSource(const std::string&)>& load) {
    const std::string path = query.file("filename");
    const MeshOptions options = mesh_options(query);
    if (path.empty()) return false;
    try {
        PreparedMesh prepared = prepare_mesh(load(path), options);
        if (prepared.dropped > 0)
            query.warn(fmt::format("left out {} triangles of {} without area or with positions that are not finite",
                                   prepared.dropped, path));
        if (prepared.mesh.triangles.empty()) {
            query.warn("the shape has no triangles and is left out");
            return false;
        }
        place_attributes(query, prepared);
        shape.geometry = std::move(prepared.mesh);
        return true;
    } catch (const InputError& error) {
        query.context().faults.add(error, query.object().place, query.object().label());
        return false;
    }
}

bool read_obj(Query& query, Shape& shape) {
    const bool flip = query.boolean("flip_tex_coords", true);
    return read_mesh_file(query, shape, [flip](const std::string& path) { return load_obj(path, flip); });
}

bool read_ply(Query& query, Shape& shape) {
    const bool flip = query.boolean("flip_tex_coords", false);
    std::vector<std::string> attributes;
    for (const AttributeUse& use : query.context().attributes)
        if (attributes.empty() || attributes.back() != use.name) attributes.push_back(use.name);
    return read_mesh_file(query, shape, [&](const std::string& path) { return load_ply(path, flip, attributes); });
}

bool read_serialized(Query& query, Shape& shape) {
    const auto index = static_cast<std::uint32_t>(query.integer("shape_index", 0, 0, std::numeric_limits<std::int32_t>::max()));
    return read_mesh_file(query, shape, [index](const std::string& path) { return load_serialized(path, index); });
}

bool read_sphere(Query& query, Shape& shape) {
    const glm::dmat4 to_world = query.transform("to_world");
    const double radius = query.real("radius", 1.0);
    const glm::dmat4 placed =
        to_world * translation(query.triple("center", glm::dvec3(0.0))) * scaling(glm::dvec3(radius));
    if (radius == 0.0) query.fault_at("radius", "the radius is zero", "expected a positive number");
    else if (!is_similarity(placed))
        query.fault_at("to_world", "a sphere cannot be scaled unevenly or sheared",
                       "use the same scale for all axes, or a mesh");
    // A mirrored sphere shows its inside.
    shape.flip_normals = query.boolean("flip_normals", false) != (glm::determinant(placed) < 0.0);
    shape.geometry = AnalyticShape{Kind::sphere, glm::mat4(placed)};
    return true;
}

bool read_disk(Query& query, Shape& shape) {
    shape.flip_normals = query.boolean("flip_normals", false);
    shape.geometry = AnalyticShape{Kind::disk, glm::mat4(query.transform("to_world"))};
    return true;
}

bool read_cylinder(Query& query, Shape& shape) {
    const glm::dmat4 to_world = query.transform("to_world");
    const glm::dvec3 p0 = query.triple("p0", glm::dvec3(0.0));
    const glm::dvec3 axis = query.triple("p1", glm::dvec3(0.0, 0.0, 1.0)) - p0;
    const double radius = query.real("radius", 1.0, positive);
    const double length = glm::length(axis);
    shape.flip_normals = query.boolean("flip_normals", false);
    if (!(length > 0.0)) {
        query.fault("the end points `p0` and `p1` coincide", "move them apart");
        return false;
    }
    const Tangents tangents = coordinate_system(axis / length);
    const glm::dmat4 frame(glm::dvec4(tangents.s, 0.0), glm::dvec4(tangents.t, 0.0), glm::dvec4(axis / length, 0.0),
                           glm::dvec4(p0, 1.0));
    const glm::dmat4 placed = to_world * frame * scaling({radius, radius, length});
    const glm::dvec3 x(placed[0]), y(placed[1]), z(placed[2]);
    const double r2 = glm::dot(x, x);
    const bool round = std::abs(glm::dot(y, y) - r2) <= 1e-3 * r2 && std::abs(glm::dot(x, y)) <= 1e-3 * r2;
    const double tolerance = 1e-3 * std::sqrt(r2 * glm::dot(z, z));
    if (!round || std::abs(glm::dot(x, z)) > tolerance || std::abs(glm::dot(y, z)) > tolerance)
        query.fault_at("to_world", "a cylinder cannot be sheared, nor scaled unevenly across its axis",
                       "use the same scale across the axis, or a mesh");
    shape.geometry = AnalyticShape{Kind::cylinder, glm::mat4(placed)};
    return true;
}

struct Plugin {
    const char* name;
    // Fills in the geometry; false for a shape that does not enter the scene.
    bool (*read)(Query&, Shape&);
    bool from_file = false;
};
constexpr std::array<Plugin, 11> plugins{{
    {"cube", read_cube},
    {"cylinder", read_cylinder},
    {"disk", read_disk},
    {"instance", nullptr},  // instances.cpp
    {"merge", nullptr},
    {"obj", read_obj, true},
    {"ply", read_ply, true},
    {"rectangle", read_rectangle},
    {"serialized", read_serialized, true},
    {"shapegroup", nullptr},
    {"sphere", read_sphere},
}};

int material_index(Context& context, const std::shared_ptr<const Material>& material) {
    if (material == nullptr) return -1;
    auto& materials = context.scene.materials;
    const auto [entry, fresh] =
        context.material_indices.emplace(material.get(), static_cast<int>(materials.size()));
    if (fresh) materials.push_back(*material);
    return entry->second;
}

const Object* only_child(Query& query, const std::string& tag) {
    const std::vector<const Child*> children = query.children(tag);
    if (children.size() > 1) query.fault("holds more than one " + tag, "keep one of them");
    return children.empty() ? nullptr : children.front()->object;
}

}  // namespace

std::optional<Shape> build_shape(Context& context, const Object& object) {
    const auto* plugin = find_plugin(context, object, plugins);
    if (plugin == nullptr) return {};
    Query query(context, object);
    Shape shape;
    shape.name = object.id;
    // What it shows says which attributes its mesh must have.
    context.attributes.clear();
    const Object* emitter = only_child(query, "emitter");
    const Object* bsdf_object = only_child(query, "bsdf");
    if (emitter != nullptr) shape.emitter = read_area_emitter(context, *emitter);
    const Bsdf bsdf =
        bsdf_object != nullptr ? read_bsdf(context, *bsdf_object) : default_bsdf(context, emitter != nullptr);
    const bool usable = plugin->read(query, shape);
    if (!context.attributes.empty() && !plugin->from_file)
        query.fault("the shape has no attribute `" + context.attributes.begin()->name + "`, which its BSDF or emitter asks for", "use a PLY file that has it");
    shape.media = read_boundary(query);
    if (shape.media && (bsdf.opacity.value.texture || (bsdf.opacity.value.value.r > 0.0F && bsdf.opacity.value.value.r < 1.0F)))
        query.fault("a mask cannot bound a medium", "use a BSDF that is all there, or `null`");
    query.accept({"silhouette_sampling_weight"});
    query.finish();
    if (!usable || bsdf.front == nullptr) return {};
    shape.material = {material_index(context, bsdf.front), material_index(context, bsdf.back), bsdf.opacity};
    return shape;
}

void read_shape(Context& context, const Object& object) {
    if (object.type == "shapegroup") {
        read_shape_group(context, object);
    } else if (object.type == "instance") {
        read_instance(context, object);
    } else if (object.type == "merge") {
        read_merged(context, object);
    } else if (std::optional<Shape> shape = build_shape(context, object)) {
        context.scene.shapes.push_back(std::move(*shape));
    }
}

std::vector<std::string> shape_types() { return names_of(plugins); }

}  // namespace wavelobe::mitsuba
