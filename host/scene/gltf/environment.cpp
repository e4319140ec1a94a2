#include "scene/gltf/environment.h"

#include <algorithm>
#include <cmath>

namespace wavelobe::gltf {

namespace {

constexpr double pi = 3.14159265358979323846;

// 1 where the angle between `d` and `axis` is below `inner` degrees, 0 beyond `outer`, smooth between.
double softbox(const glm::dvec3& d, const glm::dvec3& axis, double inner, double outer) {
    const double angle = glm::degrees(std::acos(std::clamp(glm::dot(d, glm::normalize(axis)), -1.0, 1.0)));
    const double t = std::clamp((outer - angle) / (outer - inner), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double radiance(const glm::dvec3& d) {
    const double upward = 0.5 + 0.5 * std::clamp(3.0 * d.y, -1.0, 1.0);
    return 0.3 + 0.25 * upward + 2.5 * softbox(d, {-0.6, 0.8, 0.7}, 18.0, 30.0) + 0.8 * softbox(d, {0.9, 0.3, 0.5}, 15.0, 35.0) +
           1.0 * softbox(d, {0.2, 1.2, -1.0}, 12.0, 24.0);
}

}  // namespace

EnvironmentMap studio_environment() {
    EnvironmentMap map;
    Bitmap& image = map.image;
    image.width = 256;
    image.height = 128;
    for (int row = 0; row < image.height; ++row) {
        const double theta = pi * (row + 0.5) / image.height;
        for (int column = 0; column < image.width; ++column) {
            const double phi = 2.0 * pi * (column + 0.5) / image.width;
            const auto value = static_cast<float>(radiance({std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)}));
            image.rgb.insert(image.rgb.end(), 3, value);
        }
    }
    return map;
}

}  // namespace wavelobe::gltf
