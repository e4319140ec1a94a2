#include "render/flatten.h"

#include <cmath>
#include <span>

#include "render/emission_rays.h"
#include "render/flatten_caustics.h"
#include "render/flatten_instances.h"
#include "render/flatten_layers.h"
#include "render/flatten_lights.h"
#include "render/flatten_materials.h"
#include "render/flatten_media.h"
#include "render/vertex_coordinates.h"
#include "scene/fault.h"
#include "scene/presence.h"
#include "tables/filter_table.h"

namespace wavelobe {
namespace {

Bounds bounds_of_scene(const DeviceScene& scene) {
    Bounds b = bounds_of_range(scene, scene.world);
    for (const Bounds& i : scene.instance_bounds) {
        b.extend(i.lower);
        b.extend(i.upper);
    }
    return b;
}

class Flattener {
public:
    Flattener(const Scene& scene, Estimator estimator)
        : scene_(scene), materials_(scene, out_), media_(scene, out_), lights_(materials_, out_) {
        out_.features.estimator = estimator;
    }

    DeviceScene run() {
        const std::vector<std::size_t> groups = groups_in_use();
        out_.groups.resize(groups.size());
        // All triangles, then all analytic shapes in the numbering of primitives; in both the world's before the groups'.
        add_triangles(scene_.shapes, out_.world);
        for (std::size_t i = 0; i < groups.size(); ++i) add_triangles(scene_.groups[groups[i]].shapes, out_.groups[i]);
        add_analytics(scene_.shapes, out_.world);
        for (std::size_t i = 0; i < groups.size(); ++i) add_analytics(scene_.groups[groups[i]].shapes, out_.groups[i]);
        add_instances(groups);
        const Bounds bounds = bounds_of_scene(out_);
        const double radius = out_.primitive_shapes.empty() ? 1.0 : 0.5 * glm::length(glm::dvec3(bounds.upper) - glm::dvec3(bounds.lower));
        // Lights with a place go before those at infinity.
        for (const bool placed : {true, false}) {
            for (const Emitter& emitter : scene_.emitters) {
                if (LightFlattener::has_place(emitter) == placed) lights_.add_emitter(emitter);
            }
        }
        lights_.finish(radius);
        set_parameters();
        flatten_caustics(out_, bounds, lights_);
        out_.filter_table = build_filter_table(scene_.film.filter);
        flatten_layers(scene_, out_);
        finish_features();
        out_.features.emission_rays = emission_rays(out_, scene_.camera, scene_.film);
        return std::move(out_);
    }

private:
    void add_triangles(const std::vector<Shape>& shapes, GeometryRange& range) {
        range.first_triangle = out_.triangles.size();
        for (const Shape& shape : shapes) {
            const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
            if (mesh != nullptr && is_there(shape)) add_mesh(shape, *mesh);
        }
        range.triangle_count = out_.triangles.size() - range.first_triangle;
    }

    void add_analytics(const std::vector<Shape>& shapes, GeometryRange& range) {
        range.first_analytic = out_.analytics.size();
        for (const Shape& shape : shapes) {
            const auto* analytic = std::get_if<AnalyticShape>(&shape.geometry);
            if (analytic != nullptr && is_there(shape)) add_analytic(shape, *analytic);
        }
        range.analytic_count = out_.analytics.size() - range.first_analytic;
    }

    std::vector<std::size_t> groups_in_use() const;
    void add_instances(const std::vector<std::size_t>& groups);

    void finish_features() {
        FeatureSet& f = out_.features;
        f.textures = !out_.textures.empty();
        f.orthographic = scene_.camera.projection == Camera::Projection::orthographic;
        f.thin_lens = !f.orthographic && scene_.camera.aperture_radius > 0.0F;
        f.signed_filter = scene_.film.filter.is_signed();
        f.hide_emitters = scene_.integrator.hide_emitters;
        f.environment_covers = scene_.integrator.environment_covers && !f.hide_emitters;
        if (!f.masks && !f.veiled_emitters) out_.opacities = {};
        f.uvs = !out_.uvs.empty() && (f.textures || f.anisotropy || f.normal_maps || f.coat_normals || f.vertex_opacity || f.layers != 0);
        if (f.uvs) return;
        // Texture coordinates that nothing looks up.
        out_.uvs = {};
        for (DeviceShape& shape : out_.shapes) shape.first_uv = shape.first_second_uv = WAVELOBE_NONE;
        for (DeviceOpacity& opacity : out_.opacities) opacity.first_uv = WAVELOBE_NONE;
    }

    bool emits(const Shape& shape) const {
        return shape.emitter && (shape.emitter->radiance.texture || shape.emitter->radiance.value != Rgb{0.0F});
    }

    bool is_visible(const Shape& shape) {
        return (emits(shape) && shape.emitter->sampled) || presence_.find(shape) != Presence::absent;
    }

    // What is nowhere and does not shine is left out, unless it parts media.
    bool is_there(const Shape& shape) { return is_visible(shape) || media_.parts_media(shape); }

    // The record of a shape with its materials and its opacity; geometry is added by the caller.
    DeviceShape device_shape(const Shape& shape) {
        DeviceShape s{};
        const bool visible = is_visible(shape);
        s.front_material = visible ? materials_.add(shape.material.front) : WAVELOBE_NONE;
        s.back_material = visible ? materials_.add(shape.material.back) : WAVELOBE_NONE;
        s.first_primitive = static_cast<std::uint32_t>(out_.primitive_shapes.size());
        s.first_normal = WAVELOBE_NONE;
        s.first_uv = s.first_second_uv = WAVELOBE_NONE;
        s.first_color = WAVELOBE_NONE;
        s.first_light = WAVELOBE_NONE;
        s.triangles_per_light = 1;
        const std::uint32_t front = classes(s.front_material);
        const std::uint32_t back = classes(s.back_material);
        s.flags = front | back | media_.add_shape(shape, visible);
        if (shape.material.culled_behind) s.flags |= SHAPE_CULLED_BEHIND;
        FeatureSet& f = out_.features;
        f.culled_backs = f.culled_backs || shape.material.culled_behind;
        f.unlike_sides = f.unlike_sides || s.back_material != s.front_material;
        // A black side ends a path in any queue; two sides of different classes must be told apart before.
        f.lobe_choice = f.lobe_choice || (front != 0 && back != 0 && front != back);
        if (emits(shape)) {
            s.flags |= emitter_flags(*shape.emitter);
            s.first_light = static_cast<std::uint32_t>(out_.lights.size());
            f.unsampled_emitters = f.unsampled_emitters || (s.flags & (SHAPE_UNSAMPLED | SHAPE_EMITS_BEHIND)) != 0;
            f.textured_emitters = f.textured_emitters || shape.emitter->radiance.texture != nullptr;
        }
        if (!visible || presence_.find(shape) == Presence::whole) {
            out_.opacities.push_back({{1.0F, WAVELOBE_NONE}, 1.0F, -1.0F, WAVELOBE_NONE, WAVELOBE_NONE});
        } else {
            out_.opacities.push_back(materials_.opacity(shape.material.opacity));
            const bool veiled = emits(shape) && shape.emitter->sampled;
            s.flags |= veiled ? SHAPE_VEILED : SHAPE_MASKED;
            if (media_.parts_media(shape) && !veiled)
                throw InputError(Fault{"", 0, 0, shape.name, "a shape that is only partly there cannot part media", "make it whole, or null"});
            (veiled ? f.veiled_emitters : f.masks) = true;
        }
        return s;
    }

    std::uint32_t classes(std::uint32_t material) const {
        std::uint32_t flags = 0;
        const std::uint32_t lobes = materials_.lobes(material);
        for (std::uint32_t i = 0; i < LOBE_COUNT; ++i) {
            if (((lobes >> i) & 1U) != 0) flags |= 1U << lobe_class(i);  // SHAPE_HAS_x is 1 << LOBE_CLASS_x
        }
        return flags;
    }

    void add_mesh(const Shape& shape, const TriangleMesh& mesh) {
        if (mesh.triangles.empty()) return;
        DeviceShape s = device_shape(shape);
        if (!mesh.normals.empty()) {
            s.first_normal = vertex_offset(out_.normals.size(), shape);
            out_.features.smooth_normals = true;
        }
        const bool tangents = !mesh.tangents.empty() && !mesh.normals.empty();
        if (tangents) {
            s.flags |= SHAPE_HAS_TANGENTS;
            out_.features.vertex_tangents = true;
        }
        add_vertex_coordinates(shape, mesh, s, out_);
        if (!mesh.colors.empty()) {
            s.first_color = vertex_offset(out_.colors.size(), shape);
            out_.features.vertex_colors = true;
        }
        const auto index = static_cast<std::uint32_t>(out_.shapes.size());
        for (const glm::uvec3& t : mesh.triangles) {
            out_.triangles.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
            out_.primitive_shapes.push_back(index);
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = t[corner];
                if (!mesh.normals.empty()) append(out_.normals, mesh.normals[vertex]);
                if (!mesh.colors.empty()) append(out_.colors, mesh.colors[vertex]);
            }
            if (!tangents) continue;
            for (int corner = 0; corner < 3; ++corner) append(out_.normals, mesh.tangents[t[corner]]);
        }
        if (emits(shape)) {
            if (shape.emitter->sampled) lights_.add_mesh(*shape.emitter, mesh);
            else lights_.add_unsampled(*shape.emitter, out_.shapes.size());
            if (mesh.parallelogram) s.triangles_per_light = 2;
        }
        push_shape(s, shape);
    }

    static void append(std::vector<float>& out, const glm::vec3& v) { out.insert(out.end(), {v.x, v.y, v.z}); }

    void add_analytic(const Shape& shape, const AnalyticShape& analytic);

    void push_shape(const DeviceShape& s, const Shape& shape) {
        out_.shapes.push_back(s);
        out_.shape_sources.push_back(&shape);
    }

    void set_parameters();

    const Scene& scene_;
    DeviceScene out_;
    MaterialFlattener materials_;
    MediaFlattener media_;
    LightFlattener lights_;
    PresenceFinder presence_;
};

// Bounds of the unit shapes under an affine map, a few roundings wider than exact.
Bounds analytic_bounds(const AnalyticShape& shape) {
    const glm::mat4& m = shape.to_world;
    const glm::vec3 x{m[0]};
    const glm::vec3 y{m[1]};
    const glm::vec3 z{m[2]};
    const glm::vec3 origin{m[3]};
    glm::vec3 reach = glm::sqrt(x * x + y * y);
    if (shape.kind == AnalyticShape::Kind::sphere) reach = glm::sqrt(x * x + y * y + z * z);
    Bounds b{origin - reach, origin + reach};
    if (shape.kind == AnalyticShape::Kind::cylinder) {
        b.extend(origin + z - reach);
        b.extend(origin + z + reach);
    }
    constexpr float slack = 8.0F * std::numeric_limits<float>::epsilon();
    const glm::vec3 margin = slack * (glm::max(glm::abs(b.lower), glm::abs(b.upper)) + reach);
    return {b.lower - margin, b.upper + margin};
}

// World-space area: disks by the determinant of their plane, cylinders and spheres under similarity maps.
double analytic_area(const AnalyticShape& shape) {
    const glm::dvec3 x{shape.to_world[0]};
    const glm::dvec3 y{shape.to_world[1]};
    const glm::dvec3 z{shape.to_world[2]};
    constexpr double pi = 3.14159265358979323846;
    switch (shape.kind) {
        case AnalyticShape::Kind::sphere: return 4.0 * pi * glm::dot(x, x);
        case AnalyticShape::Kind::disk: return pi * glm::length(glm::cross(x, y));
        case AnalyticShape::Kind::cylinder: return 2.0 * pi * glm::length(x) * glm::length(z);
    }
    return 0.0;
}

void Flattener::add_analytic(const Shape& shape, const AnalyticShape& analytic) {
    constexpr std::uint32_t kinds[] = {ANALYTIC_SPHERE, ANALYTIC_DISK, ANALYTIC_CYLINDER};
    constexpr LightIndex lights[] = {LIGHT_SPHERE, LIGHT_DISK, LIGHT_CYLINDER};
    const auto kind = static_cast<std::size_t>(analytic.kind);
    DeviceShape s = device_shape(shape);
    out_.features.analytic = true;

    Analytic a{};
    a.to_world = affine(analytic.to_world);
    a.to_object = affine(glm::mat4(glm::inverse(glm::dmat4(analytic.to_world))));
    a.kind = kinds[kind];
    a.flip = shape.flip_normals ? -1.0F : 1.0F;
    const double area = analytic_area(analytic);
    a.area = static_cast<float>(area);
    a.radius = static_cast<float>(glm::length(glm::dvec3(analytic.to_world[0])));
    const auto index = static_cast<std::uint32_t>(out_.analytics.size());
    out_.analytics.push_back(a);
    out_.analytic_bounds.push_back(analytic_bounds(analytic));
    if (emits(shape)) lights_.add_analytic(*shape.emitter, lights[kind], index, area, out_.analytic_bounds.back());
    out_.primitive_shapes.push_back(static_cast<std::uint32_t>(out_.shapes.size()));
    push_shape(s, shape);
}

// Those with instances and something in them.
std::vector<std::size_t> Flattener::groups_in_use() const {
    std::vector<bool> used(scene_.groups.size());
    for (const Instance& instance : scene_.instances) used.at(static_cast<std::size_t>(instance.group)) = true;
    std::vector<std::size_t> groups;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        groups.push_back(i);
        for (const Shape& shape : scene_.groups[i].shapes) {
            if (!emits(shape)) continue;
            throw InputError(Fault{"", 0, 0, shape.name, "an instanced shape emits light; only shapes outside of groups can",
                                   "place the emitter without instancing"});
        }
    }
    return groups;
}

void Flattener::add_instances(const std::vector<std::size_t>& groups) {
    std::vector<Bounds> bounds;
    std::map<std::size_t, std::uint32_t> number;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        number[groups[i]] = static_cast<std::uint32_t>(i);
        bounds.push_back(bounds_of_range(out_, out_.groups[i]));
    }
    for (const Instance& instance : scene_.instances) {
        const auto found = number.find(static_cast<std::size_t>(instance.group));
        if (found == number.end() || bounds[found->second].lower.x > bounds[found->second].upper.x) continue;
        out_.instances.push_back(device_instance(instance.to_world, found->second));
        out_.instance_bounds.push_back(instance_bounds(instance.to_world, bounds[found->second]));
    }
    out_.features.instances = !out_.instances.empty();
    if (out_.instances.empty()) out_.groups = {};
}

void Flattener::set_parameters() {
    const Camera& camera = scene_.camera;
    const Film& film = scene_.film;
    RenderParameters& p = out_.parameters;
    p.camera_to_world = affine(camera.to_world);
    // The plane z = 1 of the camera (z = 0 of an orthographic one), +x to the left and +y up, over the whole film.
    const bool orthographic = camera.projection == Camera::Projection::orthographic;
    const double half_width = orthographic ? 1.0 : std::tan(glm::radians(0.5 * static_cast<double>(camera.fov_x_degrees)));
    const double half_height = half_width * film.height / film.width;
    p.x_scale = static_cast<float>(-2.0 * half_width / film.width);
    p.x_offset = static_cast<float>(half_width * (1.0 - 2.0 * static_cast<double>(camera.principal_point_offset.x)));
    p.y_scale = static_cast<float>(-2.0 * half_height / film.height);
    p.y_offset = static_cast<float>(half_height * (1.0 - 2.0 * static_cast<double>(camera.principal_point_offset.y)));
    p.near_clip = camera.near_clip;
    p.far_clip = camera.far_clip;
    p.aperture_radius = camera.aperture_radius;
    p.focus_distance = camera.focus_distance;
    p.window_x = static_cast<std::uint32_t>(film.crop_x);
    p.window_y = static_cast<std::uint32_t>(film.crop_y);
    p.window_width = static_cast<std::uint32_t>(film.crop_width);
    p.window_height = static_cast<std::uint32_t>(film.crop_height);
    p.sequence.digits = SEQUENCE_A_PIXEL;
    p.max_depth = scene_.integrator.max_depth < 0 ? 0x7fffffffU : static_cast<std::uint32_t>(scene_.integrator.max_depth);
    p.rr_depth = static_cast<std::uint32_t>(std::max(scene_.integrator.rr_depth, 1));
    p.light_count = lights_.count();
    p.finite_light_count = lights_.finite_count();
    p.triangle_count = static_cast<std::uint32_t>(out_.triangles.size());
}

}  // namespace

DeviceScene flatten_scene(const Scene& scene, Estimator estimator) { return Flattener(scene, estimator).run(); }

}  // namespace wavelobe
