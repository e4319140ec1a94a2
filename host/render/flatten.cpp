#include "render/flatten.h"

#include <cmath>

#include "render/flatten_materials.h"
#include "scene/fault.h"
#include "tables/alias_table.h"
#include "tables/environment_table.h"
#include "tables/filter_table.h"
#include "tables/light_power.h"

namespace wavelobe {
namespace {

Packed3 packed(const glm::vec3& v) { return {v.x, v.y, v.z}; }

Affine affine(const glm::mat4& m) {
    Affine a{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) a.m[4 * row + column] = m[column][row];
    }
    return a;
}

// A light record with nothing set but its kind.
Light light_of(LightIndex kind, const TexturedRgb& radiance) {
    Light light{};
    light.kind = kind;
    light.radiance = radiance;
    return light;
}

Bounds bounds_of_scene(const DeviceScene& scene) {
    Bounds b;
    for (const TriangleVertices& t : scene.triangles) {
        for (const glm::vec3& p : t) b.extend(p);
    }
    for (const Bounds& a : scene.analytic_bounds) {
        b.extend(a.lower);
        b.extend(a.upper);
    }
    return b;
}

class Flattener {
public:
    explicit Flattener(const Scene& scene) : scene_(scene), materials_(scene, out_) {}

    DeviceScene run() {
        for (const Shape& shape : scene_.shapes) {
            if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) add_mesh(shape, *mesh);
        }
        // Analytic shapes follow all triangles in the numbering of primitives.
        for (const Shape& shape : scene_.shapes) {
            if (const auto* analytic = std::get_if<AnalyticShape>(&shape.geometry)) add_analytic(shape, *analytic);
        }
        const Bounds bounds = bounds_of_scene(out_);
        const double radius = out_.primitive_shapes.empty() ? 1.0 : 0.5 * glm::length(glm::dvec3(bounds.upper) - glm::dvec3(bounds.lower));
        for (const Emitter& emitter : scene_.emitters) add_emitter(emitter, radius);
        finish_lights();
        set_parameters();
        out_.filter_table = build_filter_table(scene_.film.filter);
        finish_features();
        return std::move(out_);
    }

private:
    void finish_features() {
        FeatureSet& f = out_.features;
        f.textures = !out_.textures.empty();
        f.hide_emitters = scene_.integrator.hide_emitters;
        f.uvs = !out_.uvs.empty() && (f.textures || f.anisotropy);
        if (f.uvs) return;
        // Texture coordinates that nothing looks up.
        out_.uvs = {};
        for (DeviceShape& shape : out_.shapes) shape.first_uv = WAVELOBE_NONE;
    }

    bool emits(const Shape& shape) const {
        return shape.emitter && (shape.emitter->radiance.texture || shape.emitter->radiance.value != Rgb{0.0F});
    }

    // The record of a shape with its materials; geometry is added by the caller.
    DeviceShape device_shape(const Shape& shape) {
        DeviceShape s{};
        s.front_material = materials_.add(shape.material.front);
        s.back_material = materials_.add(shape.material.back);
        s.first_primitive = static_cast<std::uint32_t>(out_.primitive_shapes.size());
        s.first_normal = WAVELOBE_NONE;
        s.first_uv = WAVELOBE_NONE;
        s.first_light = WAVELOBE_NONE;
        s.triangles_per_light = 1;
        const std::uint32_t front = classes(s.front_material);
        const std::uint32_t back = classes(s.back_material);
        s.flags = front | back;
        FeatureSet& f = out_.features;
        f.unlike_sides = f.unlike_sides || s.back_material != s.front_material;
        // A black side ends a path in any queue; two sides of different classes must be told apart before.
        f.lobe_choice = f.lobe_choice || (front != 0 && back != 0 && front != back);
        if (emits(shape)) {
            s.flags |= SHAPE_EMITS;
            s.first_light = static_cast<std::uint32_t>(out_.lights.size());
            f.textured_emitters = f.textured_emitters || shape.emitter->radiance.texture != nullptr;
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
            s.first_normal = offset(out_.normals.size(), shape);
            out_.features.smooth_normals = true;
        }
        if (!mesh.uvs.empty()) s.first_uv = offset(out_.uvs.size(), shape);
        const auto index = static_cast<std::uint32_t>(out_.shapes.size());
        for (const glm::uvec3& t : mesh.triangles) {
            out_.triangles.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
            out_.primitive_shapes.push_back(index);
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = t[corner];
                if (!mesh.normals.empty()) append(out_.normals, mesh.normals[vertex]);
                if (!mesh.uvs.empty()) append(out_.uvs, mesh.uvs[vertex]);
            }
        }
        if (emits(shape)) add_mesh_lights(shape, mesh, s);
        out_.shapes.push_back(s);
    }

    static void append(std::vector<float>& out, const glm::vec3& v) { out.insert(out.end(), {v.x, v.y, v.z}); }
    static void append(std::vector<float>& out, const glm::vec2& v) { out.insert(out.end(), {v.x, v.y}); }

    // Kernels gather by signed 32-bit offsets.
    static std::uint32_t offset(std::size_t value, const Shape& shape) {
        if (value > 0x7fffffffU) throw InputError(Fault{"", 0, 0, shape.name, "the scene has more vertex data than 32-bit offsets reach", "reduce the meshes"});
        return static_cast<std::uint32_t>(value);
    }

    void add_mesh_lights(const Shape& shape, const TriangleMesh& mesh, DeviceShape& s) {
        const TexturedRgb radiance = materials_.rgb(shape.emitter->radiance);
        if (mesh.parallelogram) {
            s.triangles_per_light = 2;
            add_planar_light(shape, mesh, LIGHT_PARALLELOGRAM, radiance, {0, 1, 3});
            return;
        }
        for (const glm::uvec3& t : mesh.triangles) add_planar_light(shape, mesh, LIGHT_TRIANGLE, radiance, t);
    }

    void add_planar_light(const Shape& shape, const TriangleMesh& mesh, LightIndex kind, const TexturedRgb& radiance,
                          const glm::uvec3& t) {
        Light light = light_of(kind, radiance);
        const glm::vec3 p = mesh.positions[t.x];
        const glm::vec3 e1 = mesh.positions[t.y] - p;
        const glm::vec3 e2 = mesh.positions[t.z] - p;
        const glm::dvec3 cross = glm::cross(glm::dvec3(e1), glm::dvec3(e2));
        const double area = glm::length(cross) * (kind == LIGHT_TRIANGLE ? 0.5 : 1.0);
        light.position = packed(p);
        light.edge1 = packed(e1);
        light.edge2 = packed(e2);
        light.normal = packed(glm::vec3(glm::normalize(cross)));
        light.inverse_area = static_cast<float>(1.0 / area);
        const glm::vec2 barycentric[3] = {{0, 0}, {1, 0}, {0, 1}};
        for (int i = 0; i < 3; ++i) {
            const glm::vec2 uv = mesh.uvs.empty() ? barycentric[i] : mesh.uvs[t[i]];
            light.uv[2 * i] = uv.x;
            light.uv[2 * i + 1] = uv.y;
        }
        add_light(light, area_power(*shape.emitter, area));
    }

    void add_analytic(const Shape& shape, const AnalyticShape& analytic);

    void add_light(const Light& light, double power) {
        out_.lights.push_back(light);
        out_.features.light_kinds |= 1U << light.kind;
        powers_.push_back(power);
    }

    void add_emitter(const Emitter& emitter, double radius);
    void add(const ConstantEmitter& e, double power);
    void add_environment_map(const EnvironmentMap& e, double radius);
    void add(const PointEmitter& e, double power);
    void add(const SpotEmitter& e, double power);
    void add(const DirectionalEmitter& e, double power);

    // Probabilities and the alias table, by power; alike if no light has any.
    void finish_lights() {
        out_.features.light_count = static_cast<int>(out_.lights.size());
        if (out_.lights.empty()) return;
        const std::vector<AliasEntry> alias = build_alias_table(powers_);
        double sum = 0.0;
        for (const double power : powers_) sum += power;
        for (std::size_t i = 0; i < out_.lights.size(); ++i) {
            out_.lights[i].alias = alias[i];
            const double p = sum > 0.0 ? powers_[i] / sum : 1.0 / static_cast<double>(powers_.size());
            out_.lights[i].selection_probability = static_cast<float>(p);
        }
    }

    void set_parameters();

    const Scene& scene_;
    DeviceScene out_;
    MaterialFlattener materials_;
    std::vector<double> powers_;
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
    if (emits(shape)) {
        Light light = light_of(lights[kind], materials_.rgb(shape.emitter->radiance));
        light.analytic = static_cast<std::uint32_t>(out_.analytics.size());
        light.inverse_area = static_cast<float>(1.0 / area);
        add_light(light, area_power(*shape.emitter, area));
    }
    out_.primitive_shapes.push_back(static_cast<std::uint32_t>(out_.shapes.size()));
    out_.shapes.push_back(s);
    out_.analytics.push_back(a);
    out_.analytic_bounds.push_back(analytic_bounds(analytic));
}

void Flattener::add(const ConstantEmitter& e, double power) {
    Environment environment{};
    environment.radiance = packed(e.radiance);
    environment.to_world = environment.to_object = affine(glm::mat4(1.0F));
    environment.light = static_cast<std::uint32_t>(out_.lights.size());
    out_.environment.push_back(environment);
    add_light(light_of(LIGHT_CONSTANT, {packed(e.radiance), WAVELOBE_NONE}), power);
}

void Flattener::add_environment_map(const EnvironmentMap& e, double radius) {
    const Bitmap image = with_three_rows(e.image);
    EnvironmentTable table = build_environment_table(image, "envmap");
    const double power = environment_power(static_cast<double>(e.scale) * table.luminance_integral, radius);
    if (!(power > 0.0)) return;
    Environment environment{};
    environment.to_world = affine(e.to_world);
    environment.to_object = affine(glm::mat4(glm::inverse(glm::dmat4(e.to_world))));
    environment.width = static_cast<std::uint32_t>(image.width);
    environment.height = static_cast<std::uint32_t>(image.height);
    environment.cell_columns = table.cell_columns;
    environment.cell_rows = table.cell_rows;
    environment.radiance = {e.scale, e.scale, e.scale};
    environment.light = static_cast<std::uint32_t>(out_.lights.size());
    out_.environment.push_back(environment);
    out_.environment_texels = image.rgb;
    out_.environment_alias = std::move(table.alias);
    out_.environment_density = std::move(table.density);
    add_light(light_of(LIGHT_ENVMAP, {environment.radiance, WAVELOBE_NONE}), power);
}

void Flattener::add(const PointEmitter& e, double power) {
    Light light = light_of(LIGHT_POINT, {packed(e.intensity), WAVELOBE_NONE});
    light.position = packed(e.position);
    add_light(light, power);
}

void Flattener::add(const SpotEmitter& e, double power) {
    Light light = light_of(LIGHT_SPOT, {packed(e.intensity), WAVELOBE_NONE});
    light.position = packed(glm::vec3(e.to_world[3]));
    light.edge1 = packed(glm::normalize(glm::vec3(e.to_world[2])));
    light.cos_cutoff = static_cast<float>(std::cos(glm::radians(static_cast<double>(e.cutoff_degrees))));
    light.cos_beam = static_cast<float>(std::cos(glm::radians(static_cast<double>(e.beam_width_degrees))));
    add_light(light, power);
}

void Flattener::add(const DirectionalEmitter& e, double power) {
    Light light = light_of(LIGHT_DIRECTIONAL, {packed(e.irradiance), WAVELOBE_NONE});
    light.edge1 = packed(e.direction);
    add_light(light, power);
}

void Flattener::add_emitter(const Emitter& emitter, double radius) {
    if (const auto* map = std::get_if<EnvironmentMap>(&emitter)) {
        add_environment_map(*map, radius);
        return;
    }
    const double power = emitter_power(emitter, radius);
    if (!(power > 0.0)) return;  // black: nothing it could add
    std::visit(
        [this, power](const auto& e) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(e)>, EnvironmentMap>) add(e, power);
        },
        emitter);
}

void Flattener::set_parameters() {
    const PerspectiveCamera& camera = scene_.camera;
    const Film& film = scene_.film;
    RenderParameters& p = out_.parameters;
    p.camera_to_world = affine(camera.to_world);
    // The plane z = 1 of the camera, +x to the left and +y up, over the whole film.
    const double half_width = std::tan(glm::radians(0.5 * static_cast<double>(camera.fov_x_degrees)));
    const double half_height = half_width * film.height / film.width;
    p.x_scale = static_cast<float>(-2.0 * half_width / film.width);
    p.x_offset = static_cast<float>(half_width * (1.0 - 2.0 * static_cast<double>(camera.principal_point_offset.x)));
    p.y_scale = static_cast<float>(-2.0 * half_height / film.height);
    p.y_offset = static_cast<float>(half_height * (1.0 - 2.0 * static_cast<double>(camera.principal_point_offset.y)));
    p.near_clip = camera.near_clip;
    p.far_clip = camera.far_clip;
    p.window_x = static_cast<std::uint32_t>(film.crop_x);
    p.window_y = static_cast<std::uint32_t>(film.crop_y);
    p.window_width = static_cast<std::uint32_t>(film.crop_width);
    p.window_height = static_cast<std::uint32_t>(film.crop_height);
    p.max_depth = scene_.integrator.max_depth < 0 ? 0x7fffffffU : static_cast<std::uint32_t>(scene_.integrator.max_depth);
    p.rr_depth = static_cast<std::uint32_t>(std::max(scene_.integrator.rr_depth, 1));
    p.light_count = static_cast<std::uint32_t>(out_.lights.size());
    p.triangle_count = static_cast<std::uint32_t>(out_.triangles.size());
}

}  // namespace

DeviceScene flatten_scene(const Scene& scene) { return Flattener(scene).run(); }

}  // namespace wavelobe
