#include "render/flatten_caustics.h"

#include <algorithm>
#include <cmath>

#include "render/feature_tables.h"

namespace wavelobe {
namespace {

// Cells along the longest side of the grid.
constexpr float grid_cells = 48.0F;
// How far the grid reaches beyond the targets, by their radii: further off caustics are wide and faint.
constexpr float reach = 4.0F;
// More of them would share too few photons; the largest are kept.
constexpr std::size_t most_targets = 256;
constexpr std::uint64_t most_batches = 128;
constexpr std::uint64_t samples_per_photon = 16;

double area_of(const TriangleVertices& t) {
    return 0.5 * glm::length(glm::cross(glm::dvec3(t[1]) - glm::dvec3(t[0]), glm::dvec3(t[2]) - glm::dvec3(t[0])));
}

double area_of(const DeviceScene& scene) {
    double sum = 0.0;
    for (const TriangleVertices& t : scene.triangles) sum += area_of(t);
    for (const Analytic& a : scene.analytics) sum += static_cast<double>(a.area);
    return sum;
}

// A light that paths can hit.
bool has_visible_light(const FeatureSet& f) {
    if (f.light_count == 0) return false;
    for (std::size_t i = 0; i < light_list.size(); ++i) {
        if (((f.light_kinds >> i) & 1U) != 0 && light_list[i].reach != Reach::DELTA) return true;
    }
    return false;
}

// Bounds of what has delta lobes alone (what a coat of plastic mirrors is faint), of shapes that stand in the world.
std::vector<Bounds> delta_bounds(const DeviceScene& scene) {
    constexpr std::uint32_t all_classes = SHAPE_HAS_DELTA | SHAPE_HAS_GLOSSY | SHAPE_HAS_DIFFUSE;
    std::vector<Bounds> of_shape(scene.shapes.size());
    const auto extend = [&](std::size_t primitive, const glm::vec3& p) {
        const std::uint32_t shape = scene.primitive_shapes[primitive];
        if ((scene.shapes[shape].flags & all_classes) == SHAPE_HAS_DELTA) of_shape[shape].extend(p);
    };
    const GeometryRange& world = scene.world;
    for (std::size_t i = world.first_triangle; i < world.first_triangle + world.triangle_count; ++i) {
        for (const glm::vec3& p : scene.triangles[i]) extend(i, p);
    }
    for (std::size_t i = world.first_analytic; i < world.first_analytic + world.analytic_count; ++i) {
        extend(scene.triangles.size() + i, scene.analytic_bounds[i].lower);
        extend(scene.triangles.size() + i, scene.analytic_bounds[i].upper);
    }
    std::erase_if(of_shape, [](const Bounds& b) { return b.lower.x > b.upper.x; });
    return of_shape;
}

CausticTarget target_about(const Bounds& b) {
    const glm::vec3 c = 0.5F * (b.lower + b.upper);
    return {{c.x, c.y, c.z}, 0.5F * glm::length(b.upper - b.lower), 0.0F, 0.0F};
}

// Each is aimed at as often as its disk is large.
void share_photons(std::vector<CausticTarget>& targets) {
    const auto weight = [](const CausticTarget& t) { return static_cast<double>(t.radius) * static_cast<double>(t.radius); };
    double sum = 0.0, before = 0.0;
    for (const CausticTarget& t : targets) sum += weight(t);
    for (CausticTarget& t : targets) {
        before += weight(t);
        t.cumulative = static_cast<float>(before / sum);
        t.inverse_chance = static_cast<float>(sum / weight(t));
    }
}

// About the targets, within the scene.
CausticGrid grid_about(const std::vector<CausticTarget>& targets, const Bounds& scene) {
    Bounds b;
    for (const CausticTarget& t : targets) {
        const glm::vec3 c(t.center[0], t.center[1], t.center[2]);
        b.extend(c - reach * t.radius);
        b.extend(c + reach * t.radius);
    }
    b.lower = glm::max(b.lower, scene.lower);
    const glm::vec3 size = glm::min(b.upper, scene.upper) - b.lower;
    const float step = std::max({size.x, size.y, size.z}) / grid_cells;
    CausticGrid grid{};
    grid.inverse_step = 1.0F / step;
    for (glm::length_t k = 0; k < 3; ++k) {
        grid.origin[k] = b.lower[k];
        // A plane at the end of the box is inside.
        grid.size[k] = static_cast<std::uint32_t>(size[k] / step) + 1;
    }
    grid.target_count = static_cast<std::uint32_t>(targets.size());
    return grid;
}

}  // namespace

void flatten_caustics(DeviceScene& out, const Bounds& bounds, const LightFlattener& lights) {
    FeatureSet& f = out.features;
    // Camera, surface, two of the glass, light: four edges; a mirror takes three.
    if (!has_visible_light(f) || !f.has_lobe_class(LOBE_CLASS_DELTA) || !f.has_lobe_class(LOBE_CLASS_DIFFUSE)) return;
    if (out.parameters.max_depth < 3 || f.estimator == Estimator::light) return;
    std::vector<Bounds> glass = delta_bounds(out);
    const auto size = [](const Bounds& b) { return glm::length(b.upper - b.lower); };
    std::stable_sort(glass.begin(), glass.end(), [&](const Bounds& a, const Bounds& b) { return size(a) > size(b); });
    if (glass.size() > most_targets) glass.resize(most_targets);
    for (const Bounds& b : glass) {
        if (size(b) > 0.0F) out.caustic_targets.push_back(target_about(b));
    }
    if (out.caustic_targets.empty()) return;
    share_photons(out.caustic_targets);
    out.caustic_grid = grid_about(out.caustic_targets, bounds);
    out.caustic_grid.scene_size = glm::length(bounds.upper - bounds.lower);
    out.caustic_grid.mean_irradiance = static_cast<float>(lights.placed_flux() / area_of(out) + lights.infinite_irradiance());
    f.caustics = true;
}

void set_photon_count(DeviceScene& scene, std::uint64_t samples) {
    const std::uint64_t batches = samples / samples_per_photon / PHOTONS_A_BATCH;
    scene.caustic_grid.batches = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(batches, 8, most_batches));
}

std::size_t caustic_cells(const CausticGrid& grid) { return std::size_t{grid.size[0]} * grid.size[1] * grid.size[2]; }

std::uint64_t caustic_bytes(const CausticGrid& grid) {
    return caustic_cells(grid) * 2 * sizeof(std::uint32_t) +
           std::uint64_t{CAUSTIC_MAPS} * ((CAUSTIC_BINS + 1) * sizeof(std::uint64_t) + CAUSTIC_MAP_FLOATS * sizeof(float));
}

}  // namespace wavelobe
