#include "render/emission_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scene/projection.h"

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

// Where points of the world are on the film, in pixels; nothing of points that are not before the camera.
class FilmPoints {
public:
    FilmPoints(const Camera& camera, const Film& film) : to_ndc_(world_to_ndc(camera, film)), size_(film.width, film.height) {}

    std::optional<glm::dvec2> operator()(const glm::dvec3& point) const {
        const glm::dvec4 ndc = to_ndc_ * glm::dvec4(point, 1.0);
        if (!(ndc.w > 0.0 && ndc.z > 0.0)) return std::nullopt;
        return size_ * glm::dvec2(ndc) / ndc.w;
    }

private:
    glm::dmat4 to_ndc_;
    glm::dvec2 size_;
};

bool faces_camera(const Camera& camera, const glm::dvec3& point, const glm::dvec3& normal) {
    const bool orthographic = camera.projection == Camera::Projection::orthographic;
    return glm::dot(normal, orthographic ? -glm::dvec3(camera.to_world[2]) : glm::dvec3(camera.to_world[3]) - point) > 0.0;
}

bool is_planar(std::uint32_t kind) {
    return kind == LIGHT_TRIANGLE || kind == LIGHT_SPHERICAL_TRIANGLE || kind == LIGHT_RECTANGLE || kind == LIGHT_PARALLELOGRAM;
}

// A planar light on the film: the box about it, and how much of that it fills.
struct Footprint {
    glm::dvec2 lower{0.0}, upper{0.0};
    double share = 0.0;
};

std::optional<Footprint> footprint(const Light& light, const Camera& camera, const FilmPoints& film_point) {
    const glm::dvec3 p(vector_of(light.position)), e1(vector_of(light.edge1)), e2(vector_of(light.edge2));
    if (!is_planar(light.kind) || !faces_camera(camera, p, glm::dvec3(vector_of(light.normal)))) return std::nullopt;
    const bool triangle = light.kind == LIGHT_TRIANGLE || light.kind == LIGHT_SPHERICAL_TRIANGLE;
    std::array<glm::dvec2, 4> corners{};
    const std::array<glm::dvec3, 4> points = {p, p + e1, p + e2, p + e1 + e2};
    const std::size_t count = triangle ? 3 : 4;
    Footprint f;
    for (std::size_t i = 0; i < count; ++i) {
        const std::optional<glm::dvec2> at = film_point(points.at(i));
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

double partial_coverage(const DeviceScene& scene, const Camera& camera, const Film& film) {
    const std::size_t pixels = static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height);
    if (pixels > most_pixels) return 0.0;
    const FilmPoints film_point(camera, film);
    std::vector<float> covered;  // of each pixel, once there is anything
    for (const Light& light : scene.lights) {
        const std::optional<Footprint> f = footprint(light, camera, film_point);
        if (!f) continue;
        const glm::dvec2 box = f->upper - f->lower;
        // What is seen edge on has no area; what is not finite is no emitter of few pixels.
        if (std::max(box.x, box.y) > longest_side || !std::isfinite(f->share)) continue;
        covered.resize(pixels);
        add_coverage(covered, {film.width, film.height}, *f);
    }
    double sum = 0.0;
    for (const float c : covered) sum += static_cast<double>(std::min(c, 1.0F) * (1.0F - std::min(c, 1.0F)));
    return sum / static_cast<double>(pixels);
}

int emission_rays(const DeviceScene& scene, const Camera& camera, const Film& film) {
    const FeatureSet& f = scene.features;
    // Rays that go on behind emitters, weights of single samples and their squares are those of whole paths.
    if (!f.has_surface_lights() || f.hide_emitters || f.veiled_emitters || f.signed_filter || f.moments) return 0;
    return partial_coverage(scene, camera, film) >= least_coverage ? rays_a_sample : 0;
}

}  // namespace wavelobe
