#include "render/emission_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace wavelobe {
namespace {

// A camera ray costs a few percent of a path: eight leave an eighth of the noise or, being well distributed, less.
constexpr int rays_a_sample = 8;
// Least partial coverage that is worth that.
constexpr double least_coverage = 0.0015;
// Emitters that are longer, in pixels, have few of theirs at their edges.
constexpr double longest_side = 16.0;
// Of larger films nothing is worked out: their pixels are small beside what is in the picture.
constexpr std::size_t most_pixels = std::size_t{1} << 24U;

glm::dvec3 vector_of(const Packed3& p) { return {p.x, p.y, p.z}; }

// Where points of the world are on the film, in pixels.
class Projection {
public:
    Projection(const RenderParameters& p, bool orthographic) : p_(p), orthographic_(orthographic) {
        glm::dmat4 to_world(1.0);
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 4; ++column) to_world[column][row] = p.camera_to_world.m[4 * row + column];
        }
        to_camera_ = glm::inverse(to_world);
        eye_ = glm::dvec3(to_world[3]);
        axis_ = glm::dvec3(to_world[2]);
    }

    // Nothing of points that are not before the camera.
    std::optional<glm::dvec2> film(const glm::dvec3& point) const {
        const glm::dvec3 c(to_camera_ * glm::dvec4(point, 1.0));
        if (!(c.z > static_cast<double>(p_.near_clip))) return std::nullopt;
        const glm::dvec2 on_plane = orthographic_ ? glm::dvec2(c) : glm::dvec2(c) / c.z;
        return glm::dvec2((on_plane.x - static_cast<double>(p_.x_offset)) / static_cast<double>(p_.x_scale),
                          (on_plane.y - static_cast<double>(p_.y_offset)) / static_cast<double>(p_.y_scale));
    }

    bool faces_camera(const glm::dvec3& point, const glm::dvec3& normal) const {
        return glm::dot(normal, orthographic_ ? -axis_ : eye_ - point) > 0.0;
    }

private:
    RenderParameters p_;
    bool orthographic_;
    glm::dmat4 to_camera_{1.0};
    glm::dvec3 eye_{0.0}, axis_{0.0};
};

bool is_planar(std::uint32_t kind) {
    return kind == LIGHT_TRIANGLE || kind == LIGHT_SPHERICAL_TRIANGLE || kind == LIGHT_RECTANGLE || kind == LIGHT_PARALLELOGRAM;
}

// A planar light on the film: the box about it, and how much of that it fills.
struct Footprint {
    glm::dvec2 lower{0.0}, upper{0.0};
    double share = 0.0;
};

std::optional<Footprint> footprint(const Light& light, const Projection& projection) {
    const glm::dvec3 p = vector_of(light.position), e1 = vector_of(light.edge1), e2 = vector_of(light.edge2);
    if (!is_planar(light.kind) || !projection.faces_camera(p, vector_of(light.normal))) return std::nullopt;
    const bool triangle = light.kind == LIGHT_TRIANGLE || light.kind == LIGHT_SPHERICAL_TRIANGLE;
    std::array<glm::dvec2, 4> corners{};
    const std::array<glm::dvec3, 4> points = {p, p + e1, p + e2, p + e1 + e2};
    const std::size_t count = triangle ? 3 : 4;
    Footprint f;
    for (std::size_t i = 0; i < count; ++i) {
        const std::optional<glm::dvec2> at = projection.film(points.at(i));
        if (!at) return std::nullopt;
        corners.at(i) = *at;
        f.lower = i == 0 ? *at : glm::min(f.lower, *at);
        f.upper = i == 0 ? *at : glm::max(f.upper, *at);
    }
    const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0], box = f.upper - f.lower;
    f.share = std::abs(a.x * b.y - a.y * b.x) * (triangle ? 0.5 : 1.0) / (box.x * box.y);
    return f;
}

// Adds to each pixel how much of it the box covers, times `share`.
void add_coverage(std::vector<float>& covered, glm::dvec2 size, const Footprint& f) {
    const glm::dvec2 lower = glm::max(f.lower, glm::dvec2(0.0)), upper = glm::min(f.upper, size);
    for (double y = std::floor(lower.y); y < upper.y; y += 1.0) {
        const double rows = std::min(y + 1.0, upper.y) - std::max(y, lower.y);
        for (double x = std::floor(lower.x); x < upper.x; x += 1.0) {
            const double columns = std::min(x + 1.0, upper.x) - std::max(x, lower.x);
            covered[static_cast<std::size_t>(y * size.x + x)] += static_cast<float>(f.share * rows * columns);
        }
    }
}

}  // namespace

double partial_coverage(const DeviceScene& scene, int film_width, int film_height) {
    const std::size_t pixels = static_cast<std::size_t>(film_width) * static_cast<std::size_t>(film_height);
    if (pixels > most_pixels || scene.lights.empty()) return 0.0;
    const Projection projection(scene.parameters, scene.features.orthographic);
    std::vector<float> covered(pixels);
    for (const Light& light : scene.lights) {
        const std::optional<Footprint> f = footprint(light, projection);
        if (!f) continue;
        const glm::dvec2 box = f->upper - f->lower;
        // What is seen edge on has no area; what is not finite is no emitter of few pixels.
        if (std::max(box.x, box.y) <= longest_side && std::isfinite(f->share)) add_coverage(covered, {film_width, film_height}, *f);
    }
    double sum = 0.0;
    for (const float c : covered) sum += static_cast<double>(std::min(c, 1.0F) * (1.0F - std::min(c, 1.0F)));
    return sum / static_cast<double>(pixels);
}

int emission_rays(const DeviceScene& scene, const Film& film) {
    const FeatureSet& f = scene.features;
    // Rays that go on behind emitters, weights of single samples and their squares are those of whole paths.
    if (!f.has_surface_lights() || f.hide_emitters || f.veiled_emitters || f.signed_filter || f.moments) return 0;
    return partial_coverage(scene, film.width, film.height) >= least_coverage ? rays_a_sample : 0;
}

}  // namespace wavelobe
