#include "render/flatten_instances.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "render/flatten_lights.h"
#include "scene/fault.h"

namespace wavelobe {

DeviceInstance device_instance(const glm::mat4& to_world, std::uint32_t group) {
    DeviceInstance out{};
    out.to_world = affine(to_world);
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(glm::mat3(to_world)));
    bool finite = std::all_of(std::begin(out.to_world.m), std::end(out.to_world.m), [](float x) { return std::isfinite(x); });
    for (glm::length_t row = 0; row < 3; ++row) {
        for (glm::length_t column = 0; column < 3; ++column) {
            const auto value = static_cast<float>(inverse[column][row]);
            out.to_object[3 * row + column] = value;
            finite = finite && std::isfinite(value);
        }
    }
    if (!finite) {
        throw InputError(Fault{"", 0, 0, "instance", "its transform has no inverse", "give it a scale that is not zero"});
    }
    out.root = group;
    return out;
}

Bounds instance_bounds(const glm::mat4& to_world, const Bounds& box) {
    const glm::dmat4 m(to_world);
    glm::dvec3 lower(std::numeric_limits<double>::infinity());
    glm::dvec3 upper = -lower;
    glm::dvec3 reach(0.0);  // sum of the magnitudes that the map adds up
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p{(corner & 1) != 0 ? box.upper.x : box.lower.x, (corner & 2) != 0 ? box.upper.y : box.lower.y,
                           (corner & 4) != 0 ? box.upper.z : box.lower.z};
        const glm::dvec3 placed(m * glm::dvec4(p, 1.0));
        lower = glm::min(lower, placed);
        upper = glm::max(upper, placed);
        const glm::dvec3 size = glm::abs(p);
        reach = glm::max(reach, glm::abs(glm::dvec3(m[0])) * size.x + glm::abs(glm::dvec3(m[1])) * size.y +
                                    glm::abs(glm::dvec3(m[2])) * size.z);
    }
    // Rays come to the group by some six roundings relative to the distance from its origin, and hits go back by as many.
    const glm::dvec3 margin = 16.0 * static_cast<double>(std::numeric_limits<float>::epsilon()) *
                              (glm::dvec3(std::max({reach.x, reach.y, reach.z})) + glm::abs(glm::dvec3(m[3])));
    return {glm::vec3(lower - margin), glm::vec3(upper + margin)};
}

Bounds bounds_of_range(const DeviceScene& scene, const GeometryRange& range) {
    Bounds b;
    for (const TriangleVertices& t : std::span(scene.triangles).subspan(range.first_triangle, range.triangle_count)) {
        for (const glm::vec3& p : t) b.extend(p);
    }
    for (const Bounds& a : std::span(scene.analytic_bounds).subspan(range.first_analytic, range.analytic_count)) {
        b.extend(a.lower);
        b.extend(a.upper);
    }
    return b;
}

}  // namespace wavelobe
