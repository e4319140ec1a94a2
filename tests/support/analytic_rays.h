// Random rays at random analytic shapes.
#pragma once

#include <random>

#include "support/analytic_shapes.h"

namespace wavelobe::test {

struct Rays {
    std::vector<Analytic> shapes;
    std::vector<Uint32> shape;
    std::vector<glm::vec3> origin, direction;

    std::size_t size() const { return shape.size(); }

    std::vector<float> packed(const std::vector<float>& limit) const {
        const std::size_t n = size();
        std::vector<float> rays(7 * n);
        for (std::size_t i = 0; i < n; ++i) {
            for (int k = 0; k < 3; ++k) {
                rays[i + static_cast<std::size_t>(k) * n] = origin[i][k];
                rays[i + static_cast<std::size_t>(k + 3) * n] = direction[i][k];
            }
            rays[i + 6 * n] = limit[i];
        }
        return rays;
    }
};

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double uniform(double a = 0.0, double b = 1.0) { return std::uniform_real_distribution<double>(a, b)(engine_); }
    double log_uniform(double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); }
    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec3(normal(engine_), normal(engine_), normal(engine_)));
    }

private:
    std::mt19937 engine_;
};

// A rotation, a scale (sizes of 1e-6 to 1e6), and an offset of up to 30 times the size.
inline glm::dmat4 random_map(Random& random, Uint32 kind) {
    const double size = random.log_uniform(1e-6, 1e6);
    const glm::dvec3 place = random.direction() * size * random.log_uniform(0.01, 30.0);
    glm::dvec3 stretch(size);
    if (kind == ANALYTIC_CYLINDER) stretch.z *= random.log_uniform(0.03, 30.0);
    if (kind == ANALYTIC_DISK) stretch.y *= random.log_uniform(0.3, 3.0);
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), place);
    m = glm::rotate(m, random.uniform(0.0, 6.3), random.direction());
    return glm::scale(m, stretch);
}

// Rays at points of the shape: from near and from far, along its normal and grazing it, missing by little and by much.
inline Rays random_rays(Uint32 kind, std::size_t count, unsigned seed) {
    Random random(seed);
    Rays rays;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 64 == 0) rays.shapes.push_back(analytic_record(kind, random_map(random, kind), i % 128 == 0 ? 1.0F : -1.0F));
        const Analytic& shape = rays.shapes.back();
        const auto world = [&](const glm::dvec3& p, double w) {
            glm::dvec3 result;
            for (int k = 0; k < 3; ++k) {
                const float* row = shape.to_world.m + 4 * k;
                result[k] = glm::dot(glm::dvec4(row[0], row[1], row[2], row[3]), glm::dvec4(p, w));
            }
            return result;
        };
        const double phi = random.uniform(0.0, 6.3);
        glm::dvec3 local = random.direction();
        if (kind == ANALYTIC_DISK) local = std::sqrt(random.uniform()) * glm::dvec3(std::cos(phi), std::sin(phi), 0.0);
        if (kind == ANALYTIC_CYLINDER) local = {std::cos(phi), std::sin(phi), random.uniform()};
        const glm::dvec3 target = world(local, 1.0);
        const glm::dvec3 normal(AnalyticSurface(shape).normal(Real3(target)));
        const double size = glm::length(world({1.0, 0.0, 0.0}, 0.0));
        glm::dvec3 direction = random.direction();
        if (i % 2 == 1) {
            // Grazing, at an angle of 1e-6 to 1 with the surface.
            const glm::dvec3 flat = glm::normalize(glm::cross(normal, direction));
            direction = glm::normalize(flat + normal * random.log_uniform(1e-6, 1.0) * (i % 4 == 1 ? 1.0 : -1.0));
        }
        const double beside = i % 8 < 6 ? 0.0 : size * random.log_uniform(1e-6, 1.0);
        const double away = size * random.log_uniform(1e-2, 1e3);
        rays.shape.push_back(static_cast<Uint32>(rays.shapes.size() - 1));
        rays.direction.push_back(glm::vec3(direction));
        rays.origin.push_back(glm::vec3(target + normal * beside - direction * away));
    }
    return rays;
}

}  // namespace wavelobe::test
