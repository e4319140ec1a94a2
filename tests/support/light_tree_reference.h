// The probability with which a light tree chooses a light, in double precision and with angles instead of cosines.
#pragma once

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

inline double reference_importance(const LightNode& n, const ReferenceReceiver& receiver) {
    const glm::dvec3& p = receiver.position;
    const std::optional<glm::dvec3>& normal = receiver.normal;
    const glm::dvec3 way = glm::dvec3(n.center.x, n.center.y, n.center.z) - p;
    const double r = static_cast<double>(n.radius);
    const double d = glm::length(way);
    const bool outside = d > r;
    const double bound = outside ? std::asin(r / d) : 0.0;
    const auto cosine = [&](double angle) {
        return (outside ? std::cos(std::max(angle - bound, 0.0)) : 1.0) + horizon_slack;
    };
    const double spread = std::atan2(static_cast<double>(n.sin_spread), static_cast<double>(n.cos_spread));
    const double off_axis = angle_between({n.axis.x, n.axis.y, n.axis.z}, -way);
    const double emitted = cosine(std::max(off_axis - spread, 0.0));
    if (emitted <= static_cast<double>(n.cos_emission)) return 0.0;
    double received = 1.0;
    if (normal) {
        received = receiver.diffuse * std::max(cosine(angle_between(*normal, way)), 0.0);
        const double off_mirror = outside ? std::max(angle_between(receiver.axis, way) - bound, 0.0) : 0.0;
        const double x = 1.0 + 4.0 * receiver.peak * std::pow(std::tan(0.5 * off_mirror), 2.0);
        if (received > 0.0) received += receiver.peak / (x * x);
    }
    return static_cast<double>(n.intensity) * std::max(emitted, horizon_slack) * received / std::max(d * d, r * r);
}

inline double reference_probability(std::span<const LightNode> tree, Uint32 trail, const ReferenceReceiver& receiver) {
    double probability = 1.0;
    for (Uint32 child = tree[0].child; (child & LIGHT_LEAF) == 0; trail >>= 1) {
        const double a = reference_importance(tree[child], receiver);
        const double b = reference_importance(tree[child + 1], receiver);
        if (a + b <= 0.0) return 0.0;
        const Uint32 second = trail & 1U;
        probability *= (second != 0 ? b : a) / (a + b);
        child = tree[child + second].child;
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
