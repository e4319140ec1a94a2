// The probability with which a light tree chooses a light, in double precision and with angles instead of cosines.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "tables/light_tree.h"

namespace wavelobe::test {

constexpr double horizon_slack = 0x1p-13;

inline double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Where light is received. Without a normal both sides receive.
struct ReferenceReceiver {
    glm::dvec3 position;
    std::optional<glm::dvec3> normal;
    glm::dvec3 axis{0.0, 0.0, 1.0};  // of the glossy lobe, whose density there is peak / pi
    double peak = 0.0;
    double diffuse = 1.0;
};

inline double reference_importance(const LightNode& n, std::size_t i, const ReferenceReceiver& receiver) {
    if (n.intensity[i] == 0.0F) return 0.0;
    const auto d64 = [](float x) { return static_cast<double>(x); };
    const glm::dvec3 way = glm::dvec3(n.center_x[i], n.center_y[i], n.center_z[i]) - receiver.position;
    const double r = d64(n.radius[i]);
    const double distance = std::max(glm::length(way), r);
    // The cosine of an angle at the centre, and what the sphere of bounds may add to it.
    const auto bound = [&](double angle) { return glm::length(way) * std::cos(angle) / distance + r / distance; };
    const double spread = std::atan2(d64(n.sin_spread[i]), d64(n.cos_spread[i]));
    const double off_axis = angle_between({n.axis_x[i], n.axis_y[i], n.axis_z[i]}, -way);
    const double emitted = (off_axis <= spread ? 1.0 + r / distance : bound(off_axis - spread)) + horizon_slack;
    const double limit = d64(n.cos_emission[i]);
    if (emitted + std::abs(limit) * r / distance <= limit) return 0.0;
    double received = 1.0;
    if (receiver.normal) {
        received = receiver.diffuse * std::clamp(bound(angle_between(*receiver.normal, way)) + horizon_slack, 0.0, 1.0);
        const double seen = glm::length(way) > r ? std::asin(r / distance) : std::numbers::pi;
        const double off_mirror = std::max(angle_between(receiver.axis, way) - seen, 0.0);
        const double tangent = std::sin(off_mirror) / (1.0 + std::cos(off_mirror) + horizon_slack);
        const double x = 1.0 + 4.0 * receiver.peak * tangent * tangent;
        if (received > 0.0) received += receiver.peak / (x * x);
    }
    return d64(n.intensity[i]) * std::clamp(emitted, horizon_slack, 1.0) * received / (distance * distance);
}

inline double reference_probability(std::span<const LightNode> tree, Uint32 place, const ReferenceReceiver& receiver) {
    double probability = 1.0;
    for (; place != LIGHT_ROOT; place = tree[place / LIGHT_CHILDREN].place) {
        const LightNode& node = tree[place / LIGHT_CHILDREN];
        double all = 0.0;
        for (std::size_t i = 0; i < LIGHT_CHILDREN; ++i) all += reference_importance(node, i, receiver);
        if (all <= 0.0) return 0.0;
        probability *= reference_importance(node, place % LIGHT_CHILDREN, receiver) / all;
    }
    return probability;
}

// Lights in a box of this size about the origin, of all sorts of cones and powers.
inline std::vector<LightBounds> random_lights(std::size_t count, unsigned seed, double size = 10.0) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<LightBounds> lights(count);
    for (LightBounds& light : lights) {
        const glm::dvec3 center = size * glm::dvec3(unit(random), unit(random), unit(random));
        const glm::dvec3 half = 0.01 * size * glm::abs(glm::dvec3(unit(random), unit(random), unit(random)));
        light.lower = center - half;
        light.upper = center + half;
        light.axis = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random) + 1e-3));
        const bool everywhere = unit(random) > 0.5;
        light.spread = everywhere ? std::numbers::pi : 0.0;
        light.emission = unit(random) > 0.5 ? 0.4 : 0.5 * std::numbers::pi;
        light.intensity = std::exp(3.0 * unit(random));
    }
    return lights;
}

}  // namespace wavelobe::test
