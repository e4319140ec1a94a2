#include "render/flatten_lights.h"

#include <cmath>
#include <numbers>

#include "tables/environment_table.h"
#include "tables/luminance.h"

namespace wavelobe {
namespace {

// A light record with nothing set but its kind.
Light light_of(LightIndex kind, const TexturedRgb& radiance) {
    Light light{};
    light.kind = kind;
    light.radiance = radiance;
    light.triangle = WAVELOBE_NONE;
    return light;
}

// Unit vectors along which a picture varies, over half its size at distance one along the axis: rows of the inverse, which also tell
// where a sheared transform puts a direction.
void set_picture_ways(Light& light, const glm::mat4& to_world, double half_width, double half_height) {
    const glm::dmat3 rows = glm::transpose(glm::inverse(glm::dmat3(to_world)));
    const double along = glm::length(rows[2]);
    light.edge2 = packed(glm::vec3(rows[0] / (along * half_width)));
    light.normal = packed(glm::vec3(rows[1] / (along * half_height)));
}

bool is_black(double luminance) { return !(luminance > 0.0); }

LightBounds bounds_about(std::initializer_list<glm::vec3> points) {
    LightBounds b;
    b.lower = glm::dvec3(*points.begin());
    b.upper = b.lower;
    for (const glm::vec3& p : points) {
        b.lower = glm::min(b.lower, glm::dvec3(p));
        b.upper = glm::max(b.upper, glm::dvec3(p));
    }
    return b;
}

}  // namespace

Affine affine(const glm::mat4& m) {
    Affine a{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) a.m[4 * row + column] = m[column][row];
    }
    return a;
}

void LightFlattener::add_light(const Light& light) {
    out_.lights.push_back(light);
    out_.features.light_kinds |= 1U << light.kind;
    ++count_;
}

void LightFlattener::add_placed_light(const Light& light, const LightBounds& bounds) {
    add_light(light);
    bounds_.push_back(bounds);
}

void LightFlattener::add_mesh(const AreaEmitter& emitter, const TriangleMesh& mesh) {
    const MeshRadiance radiance{materials_.rgb(emitter.radiance), mean_luminance(emitter.radiance), uvs_of(emitter, mesh)};
    auto number = static_cast<std::uint32_t>(out_.triangles.size() - mesh.triangles.size());
    if (mesh.parallelogram) {
        const glm::dvec3 p(mesh.positions[0]);
        const glm::dvec3 e1 = glm::dvec3(mesh.positions[1]) - p;
        const glm::dvec3 e2 = glm::dvec3(mesh.positions[3]) - p;
        // Perpendicular to the rounding of the corners.
        const bool rectangle = std::abs(glm::dot(e1, e2)) <= 1e-6 * glm::length(e1) * glm::length(e2);
        add_planar(mesh, rectangle ? LIGHT_RECTANGLE : LIGHT_PARALLELOGRAM, radiance, {0, 1, 3}, number);
        return;
    }
    for (const glm::uvec3& t : mesh.triangles) add_planar(mesh, LIGHT_TRIANGLE, radiance, t, number++);
}

const std::vector<glm::vec2>& LightFlattener::uvs_of(const AreaEmitter& emitter, const TriangleMesh& mesh) {
    const auto& texture = emitter.radiance.texture;
    return texture && texture->second_uvs && !mesh.second_uvs.empty() ? mesh.second_uvs : mesh.uvs;
}

void LightFlattener::add_planar(const TriangleMesh& mesh, LightIndex kind, const MeshRadiance& radiance, const glm::uvec3& t,
                                 std::uint32_t number) {
    Light light = light_of(kind, radiance.value);
    const glm::vec3 p = mesh.positions[t.x];
    const glm::vec3 e1 = mesh.positions[t.y] - p;
    const glm::vec3 e2 = mesh.positions[t.z] - p;
    const glm::dvec3 cross = glm::cross(glm::dvec3(e1), glm::dvec3(e2));
    const double area = glm::length(cross) * (kind == LIGHT_TRIANGLE ? 0.5 : 1.0);
    light.triangle = number;
    light.position = packed(p);
    light.edge1 = packed(e1);
    light.edge2 = packed(e2);
    light.normal = packed(glm::vec3(glm::normalize(cross)));
    light.inverse_area = static_cast<float>(1.0 / area);
    light.inverse_length1 = static_cast<float>(1.0 / glm::length(glm::dvec3(e1)));
    light.inverse_length2 = static_cast<float>(1.0 / glm::length(glm::dvec3(e2)));
    const glm::vec2 barycentric[3] = {{0, 0}, {1, 0}, {0, 1}};
    for (int i = 0; i < 3; ++i) {
        const glm::vec2 uv = radiance.uvs.empty() ? barycentric[i] : radiance.uvs[t[i]];
        light.uv[2 * i] = uv.x;
        light.uv[2 * i + 1] = uv.y;
    }
    LightBounds bounds = bounds_about({p, p + e1, p + e2});
    if (kind != LIGHT_TRIANGLE) bounds = bounds_about({p, p + e1, p + e2, p + e1 + e2});
    bounds.axis = glm::normalize(cross);
    bounds.emission = 0.5 * std::numbers::pi;
    bounds.intensity = area * radiance.mean;
    add_placed_light(light, bounds);
}

void LightFlattener::add_analytic(const AreaEmitter& emitter, LightIndex kind, std::uint32_t analytic, double area,
                                  const Bounds& box) {
    Light light = light_of(kind, materials_.rgb(emitter.radiance));
    light.analytic = analytic;
    light.inverse_area = static_cast<float>(1.0 / area);
    LightBounds bounds = bounds_about({box.lower, box.upper});
    const Analytic& shape = out_.analytics[analytic];
    // The greatest share of its area that any direction sees.
    double seen = 1.0;
    bounds.spread = std::numbers::pi;
    if (kind == LIGHT_SPHERE) seen = 0.25;
    if (kind == LIGHT_CYLINDER) seen = 1.0 / std::numbers::pi;
    if (kind == LIGHT_DISK) {
        // Normals go with the inverse transpose.
        const float* inverse = shape.to_object.m + 8;
        bounds.axis = glm::normalize(glm::dvec3(inverse[0], inverse[1], inverse[2])) * static_cast<double>(shape.flip);
        bounds.spread = 0.0;
    }
    bounds.emission = 0.5 * std::numbers::pi;
    bounds.intensity = area * seen * mean_luminance(emitter.radiance);
    add_placed_light(light, bounds);
}

double LightFlattener::placed_flux() const {
    double sum = 0.0;
    for (const LightBounds& b : bounds_) sum += std::numbers::pi * b.intensity;
    return sum;
}

bool LightFlattener::has_place(const Emitter& emitter) {
    return std::holds_alternative<PointEmitter>(emitter) || std::holds_alternative<SpotEmitter>(emitter) ||
           std::holds_alternative<ProjectorEmitter>(emitter);
}

void LightFlattener::add_unsampled(const AreaEmitter& emitter, std::size_t shape) {
    unsampled_.emplace_back(shape, materials_.rgb(emitter.radiance));
    out_.features.light_kinds |= 1U << LIGHT_TRIANGLE;
}

// Triangles that are large in their scene are sampled by solid angle; of small ones the density over area is as even, and costs less.
void LightFlattener::widen_triangles(double radius) {
    constexpr double least_share = 0.1;  // of the longest edge: from half the radius away seen under some 0.02 sr
    bool small = false;
    for (Light& light : out_.lights) {
        if (light.kind != LIGHT_TRIANGLE) continue;
        const glm::vec3 e1 = vector_of(light.edge1), e2 = vector_of(light.edge2);
        const float longest = std::max({glm::length(e1), glm::length(e2), glm::length(e2 - e1)});
        const bool wide = static_cast<double>(longest) > least_share * radius;
        if (wide) light.kind = LIGHT_SPHERICAL_TRIANGLE;
        out_.features.light_kinds |= 1U << light.kind;
        small = small || !wide;
    }
    if (!small && unsampled_.empty()) out_.features.light_kinds &= ~(1U << LIGHT_TRIANGLE);
}

void LightFlattener::finish(double radius) {
    // The stages of lights want one.
    if (out_.lights.empty() && !unsampled_.empty()) add_placed_light(light_of(LIGHT_POINT, {{}, WAVELOBE_NONE}), bounds_about({glm::vec3(0.0F)}));
    out_.features.light_count = static_cast<int>(out_.lights.size());
    if (out_.lights.empty()) return;
    widen_triangles(radius);
    share_out();
    if (bounds_.size() > 1) build_tree();
    for (const auto& [shape, radiance] : unsampled_) {
        out_.shapes[shape].first_light = static_cast<std::uint32_t>(out_.lights.size());
        out_.lights.push_back(light_of(LIGHT_TRIANGLE, radiance));
    }
}

// Each light at infinity counts as much as all that have a place.
void LightFlattener::share_out() {
    const std::size_t infinite = out_.lights.size() - bounds_.size();
    const float share = 1.0F / static_cast<float>(infinite + (bounds_.empty() ? 0 : 1));
    for (Light& light : out_.lights) light.selection_probability = share;
}

void LightFlattener::build_tree() {
    out_.features.placed_lights = static_cast<int>(bounds_.size());
    LightTree tree = build_light_tree(bounds_);
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        out_.lights[i].selection_probability = 0.0F;
        out_.lights[i].place = tree.places[i];
    }
    out_.light_tree = std::move(tree.nodes);
}

void LightFlattener::add(const ConstantEmitter& e) {
    if (is_black(luminance(e.radiance))) return;
    Environment environment{};
    environment.radiance = packed(e.radiance);
    environment.to_world = environment.to_object = affine(glm::mat4(1.0F));
    environment.light = static_cast<std::uint32_t>(out_.lights.size());
    out_.environment.push_back(environment);
    infinite_irradiance_ += std::numbers::pi * luminance(e.radiance);
    add_light(light_of(LIGHT_CONSTANT, {packed(e.radiance), WAVELOBE_NONE}));
}

void LightFlattener::add(const EnvironmentMap& e) {
    const Bitmap image = with_three_rows(e.image);
    EnvironmentTable table = build_environment_table(image, "envmap", out_.features.estimator != Estimator::light);
    if (is_black(static_cast<double>(e.scale) * table.luminance_integral)) return;
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
    infinite_irradiance_ += 0.25 * static_cast<double>(e.scale) * table.luminance_integral;
    out_.environment_texels = image.rgb;
    out_.environment_sums = std::move(table.sums);
    out_.environment_density = std::move(table.density);
    add_light(light_of(LIGHT_ENVMAP, {environment.radiance, WAVELOBE_NONE}));
}

void LightFlattener::set_range(Light& light, float range) {
    light.inverse_range = range > 0.0F ? 1.0F / range : 0.0F;
    out_.features.light_range = out_.features.light_range || range > 0.0F;
}

void LightFlattener::add(const PointEmitter& e) {
    if (is_black(luminance(e.intensity))) return;
    Light light = light_of(LIGHT_POINT, {packed(e.intensity), WAVELOBE_NONE});
    light.position = packed(e.position);
    set_range(light, e.range);
    LightBounds bounds = bounds_about({e.position});
    bounds.spread = std::numbers::pi;
    bounds.emission = 0.5 * std::numbers::pi;
    bounds.intensity = luminance(e.intensity);
    add_placed_light(light, bounds);
}

void LightFlattener::add(const SpotEmitter& e) {
    if (is_black(mean_luminance(Parameter{e.intensity, e.texture}))) return;
    Light light = light_of(LIGHT_SPOT, {packed(e.intensity), WAVELOBE_NONE});
    light.position = packed(glm::vec3(e.to_world[3]));
    light.edge1 = packed(glm::normalize(glm::vec3(e.to_world[2])));
    light.cos_cutoff = static_cast<float>(std::cos(glm::radians(static_cast<double>(e.cutoff_degrees))));
    light.cos_beam = static_cast<float>(std::cos(glm::radians(static_cast<double>(e.beam_width_degrees))));
    light.smooth_cone = e.smooth ? 1 : 0;
    out_.features.smooth_cones = out_.features.smooth_cones || e.smooth;
    set_range(light, e.range);
    if (e.texture != nullptr) {
        light.radiance.texture = materials_.rgb(Parameter{e.intensity, e.texture}).texture;
        out_.features.textured_emitters = true;
        const double reach = std::tan(glm::radians(static_cast<double>(e.cutoff_degrees)));
        set_picture_ways(light, e.to_world, reach, reach);
    }
    LightBounds bounds = bounds_about({glm::vec3(e.to_world[3])});
    bounds.axis = glm::normalize(glm::dvec3(e.to_world[2]));
    bounds.emission = glm::radians(static_cast<double>(e.cutoff_degrees));
    bounds.intensity = luminance(e.intensity);
    add_placed_light(light, bounds);
}

void LightFlattener::add(const ProjectorEmitter& e) {
    if (is_black(static_cast<double>(e.scale) * mean_luminance(e.irradiance))) return;
    Light light = light_of(LIGHT_PROJECTOR, materials_.rgb(e.irradiance));
    out_.features.textured_emitters = out_.features.textured_emitters || e.irradiance.texture != nullptr;
    light.position = packed(glm::vec3(e.to_world[3]));
    light.edge1 = packed(glm::normalize(glm::vec3(e.to_world[2])));
    const double half_width = std::tan(0.5 * glm::radians(static_cast<double>(e.fov_x_degrees)));
    const double half_height = half_width / static_cast<double>(e.aspect);
    set_picture_ways(light, e.to_world, half_width, half_height);
    const double unit = glm::length(glm::dvec3(e.to_world[2]));
    light.inverse_area = static_cast<float>(std::numbers::pi * static_cast<double>(e.scale) * unit);
    LightBounds bounds = bounds_about({glm::vec3(e.to_world[3])});
    bounds.axis = glm::normalize(glm::dvec3(e.to_world[2]));
    bounds.emission = std::atan(std::hypot(half_width, half_height));
    // Brightest towards the corners.
    bounds.intensity = static_cast<double>(light.inverse_area) * mean_luminance(e.irradiance) / std::pow(std::cos(bounds.emission), 3.0);
    add_placed_light(light, bounds);
}

void LightFlattener::add(const DirectionalEmitter& e) {
    if (is_black(luminance(e.irradiance))) return;
    Light light = light_of(LIGHT_DIRECTIONAL, {packed(e.irradiance), WAVELOBE_NONE});
    light.edge1 = packed(e.direction);
    add_light(light);
}

void LightFlattener::add_emitter(const Emitter& emitter) {
    std::visit([this](const auto& e) { add(e); }, emitter);
}

}  // namespace wavelobe
