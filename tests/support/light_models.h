// Lights of each kind with what is known about them independently of the kernels: where rays meet them, and the
// irradiance they cause.
#pragma once

#include <functional>
#include <random>

#include "support/environment_reference.h"

namespace wavelobe::test {

struct LightHit {
    double t;
    glm::dvec3 normal;  // on the emitting side
};

struct LightModel {
    std::string label;
    Uint32 light = 0;
    glm::vec3 reference{0.0F};
    glm::vec3 facing{0.0F, 0.0F, 1.0F};  // unit normal of a receiver at the reference point
    glm::dvec3 center{0.0};
    double radius = 0.0;  // of a sphere about the light; zero: it surrounds the reference point
    std::function<std::vector<LightHit>(const glm::dvec3&, const glm::dvec3&)> hits;  // origin, direction: all of them
    glm::dvec3 irradiance{0.0};
    // SURFACE: distance of a point from the surface along its normal, which is the second argument's result.
    std::function<double(const glm::dvec3&, glm::dvec3&)> distance;
};

inline const glm::vec3 test_radiance{1.0F, 2.0F, 3.0F};

inline Packed3 packed(const glm::vec3& v) { return {v.x, v.y, v.z}; }
inline glm::dvec3 unpacked(const Packed3& v) { return {v.x, v.y, v.z}; }

// ---- planar lights -------------------------------------------------------------------------------------------------

inline Light planar_light(const glm::vec3& p, const glm::vec3& e1, const glm::vec3& e2, double area_factor) {
    const glm::dvec3 cross = glm::cross(glm::dvec3(e1), glm::dvec3(e2));
    Light light{};
    light.radiance = {packed(test_radiance), WAVELOBE_NONE};
    light.position = packed(p);
    light.edge1 = packed(e1);
    light.edge2 = packed(e2);
    light.normal = packed(glm::vec3(glm::normalize(cross)));
    light.inverse_area = static_cast<float>(1.0 / (area_factor * glm::length(cross)));
    light.inverse_length1 = static_cast<float>(1.0 / glm::length(glm::dvec3(e1)));
    light.inverse_length2 = static_cast<float>(1.0 / glm::length(glm::dvec3(e2)));
    return light;
}

// Irradiance of a polygon wholly above the receiver, its vertices counter-clockwise as seen from the emitting side
// (Lambert 1760, "Photometria").
inline double polygon_irradiance(const std::vector<glm::dvec3>& vertices, const glm::dvec3& p, const glm::dvec3& n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const glm::dvec3 a = glm::normalize(vertices[i] - p);
        const glm::dvec3 b = glm::normalize(vertices[(i + 1) % vertices.size()] - p);
        const glm::dvec3 axis = glm::cross(a, b);
        sum += std::atan2(glm::length(axis), glm::dot(a, b)) * glm::dot(glm::normalize(axis), n);
    }
    return 0.5 * std::abs(sum);
}

inline std::vector<LightModel> planar_models(LightBuffers& buffers, bool triangle, bool rectangle = false) {
    std::vector<LightModel> models;
    for (double size : {1e-6, 1.0, 1e6}) {
        const glm::vec3 p(glm::dvec3(0.3, -0.2, 0.9) * size);
        const glm::vec3 e1(glm::dvec3(1.1, 0.2, 0.3) * size);
        glm::dvec3 side(-0.3, 0.8, 0.1);
        if (rectangle) side = 0.7 * glm::normalize(glm::cross(side, glm::dvec3(e1)));
        const glm::vec3 e2(side * size);
        buffers.lights.push_back(planar_light(p, e1, e2, triangle ? 0.5 : 1.0));
        const glm::dvec3 normal = unpacked(buffers.lights.back().normal);
        const glm::dvec3 a(p);
        const glm::dvec3 b(e1);
        const glm::dvec3 c(e2);
        const glm::dvec3 center = triangle ? a + (b + c) / 3.0 : a + 0.5 * (b + c);
        for (double away : {0.1, 1.0, 20.0}) {
            LightModel m;
            m.label = "size " + std::to_string(size) + " away " + std::to_string(away);
            m.light = static_cast<Uint32>(buffers.lights.size() - 1);
            m.reference = glm::vec3(center + normal * away * size + glm::dvec3(0.2, 0.1, 0.0) * size * away);
            m.facing = glm::vec3(-normal);
            m.center = center;
            m.radius = size;
            m.hits = [=](const glm::dvec3& o, const glm::dvec3& d) -> std::vector<LightHit> {
                // Cramer's rule.
                const glm::dvec3 cross = glm::cross(d, c);
                const double determinant = glm::dot(b, cross);
                const double u = glm::dot(o - a, cross) / determinant;
                const double v = glm::dot(d, glm::cross(o - a, b)) / determinant;
                const double t = glm::dot(c, glm::cross(o - a, b)) / determinant;
                const bool inside = u >= 0.0 && v >= 0.0 && (triangle ? u + v <= 1.0 : u <= 1.0 && v <= 1.0);
                if (!inside || !(t > 0.0)) return {};
                return {{t, normal}};
            };
            std::vector<glm::dvec3> corners{a, a + b, a + b + c, a + c};
            if (triangle) corners = {a, a + b, a + c};
            m.irradiance = glm::dvec3(test_radiance) * polygon_irradiance(corners, m.reference, m.facing);
            m.distance = [=](const glm::dvec3& q, glm::dvec3& n) {
                n = glm::normalize(glm::cross(b, c));
                return glm::dot(q - a, n);
            };
            models.push_back(m);
        }
    }
    return models;
}

// ---- analytic shapes ------------------------------------------------------------------------------------------------

// Irradiance by the midpoint rule over the surface, point(u, v) of the unit shape.
template <class Point>
double surface_irradiance(const Analytic& record, const Point& point, const glm::dvec3& p, const glm::dvec3& n) {
    const AnalyticSurface surface(record);
    constexpr int steps = 1000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int k = 0; k < steps; ++k) {
            const glm::dvec4 q(point((i + 0.5) / steps, (k + 0.5) / steps), 1.0);
            glm::dvec3 world;
            for (int row = 0; row < 3; ++row) {
                const float* m = record.to_world.m + 4 * row;
                world[row] = glm::dot(glm::dvec4(m[0], m[1], m[2], m[3]), q);
            }
            const glm::dvec3 w = world - p;
            const double d2 = glm::dot(w, w);
            const double emitted = -glm::dot(w, glm::dvec3(surface.normal(Real3(world))));
            sum += std::max(emitted, 0.0) * std::max(glm::dot(w, n), 0.0) / (d2 * d2);
        }
    }
    return sum * static_cast<double>(record.area) / (steps * steps);
}

inline glm::dmat4 placed(double size, const glm::dvec3& stretch) {
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), glm::dvec3(0.4, -0.7, 1.3) * size);
    m = glm::rotate(m, 0.8, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
    return glm::scale(m, stretch * size);
}

inline LightModel analytic_model(LightBuffers& buffers, const Analytic& record, const glm::dvec3& reference_on_unit_shape) {
    buffers.analytics.push_back(record);
    Light light{};
    light.radiance = {packed(test_radiance), WAVELOBE_NONE};
    light.inverse_area = 1.0F / record.area;
    light.analytic = static_cast<Uint32>(buffers.analytics.size() - 1);
    buffers.lights.push_back(light);
    LightModel m;
    m.light = static_cast<Uint32>(buffers.lights.size() - 1);
    const AnalyticSurface surface(record);
    const auto to_world = [&](const glm::dvec3& q) {
        glm::dvec3 p;
        for (int row = 0; row < 3; ++row) {
            const float* w = record.to_world.m + 4 * row;
            p[row] = glm::dot(glm::dvec4(w[0], w[1], w[2], w[3]), glm::dvec4(q, 1.0));
        }
        return p;
    };
    m.center = to_world(record.kind == ANALYTIC_CYLINDER ? glm::dvec3(0.0, 0.0, 0.5) : glm::dvec3(0.0));
    m.reference = glm::vec3(to_world(reference_on_unit_shape));
    m.radius = glm::length(to_world({1.0, 0.0, 0.0}) - to_world({0.0, 0.0, 0.0}));
    m.facing = glm::vec3(glm::normalize(m.center - glm::dvec3(m.reference)));
    m.hits = [surface](const glm::dvec3& o, const glm::dvec3& d) {
        std::vector<LightHit> hits;
        for (const auto& crossing : surface.crossings(Real3(o), Real3(d))) {
            if (crossing.t <= 0.0L || crossing.margin <= 0.0L) continue;
            hits.push_back({static_cast<double>(crossing.t), glm::dvec3(surface.normal(Real3(o) + Real3(d) * crossing.t))});
        }
        return hits;
    };
    m.distance = [surface](const glm::dvec3& p, glm::dvec3& normal) {
        Real3 n;
        const Real distance = surface.distance(Real3(p), n);
        normal = glm::dvec3(n);
        return static_cast<double>(distance);
    };
    return m;
}

inline std::vector<LightModel> sphere_models(LightBuffers& buffers) {
    std::vector<LightModel> models;
    const glm::dvec3 towards = glm::normalize(glm::dvec3(1.0, -2.0, 0.6));
    for (double size : {1e-6, 1.0, 1e6}) {
        for (double distance : {1.01, 3.0, 1000.0}) {
            const Analytic record = analytic_record(ANALYTIC_SPHERE, placed(size, glm::dvec3(1.0)));
            LightModel m = analytic_model(buffers, record, towards * distance);
            // Only its near side is ever seen.
            m.hits = [all = m.hits](const glm::dvec3& o, const glm::dvec3& d) {
                std::vector<LightHit> hits = all(o, d);
                if (hits.size() > 1) hits.pop_back();
                return hits;
            };
            m.label = "outward, size " + std::to_string(size) + " distance " + std::to_string(distance);
            // A sphere wholly above the horizon; from close by, about half of it is.
            const double d = glm::length(m.center - glm::dvec3(m.reference));
            m.irradiance = glm::dvec3(test_radiance) * std::numbers::pi * std::pow(m.radius / d, 2.0);
            models.push_back(m);
        }
        for (double distance : {0.0, 0.3, 0.99}) {
            const Analytic record = analytic_record(ANALYTIC_SPHERE, placed(size, glm::dvec3(1.0)), -1.0F);
            LightModel m = analytic_model(buffers, record, towards * distance);
            m.label = "inward, size " + std::to_string(size) + " distance " + std::to_string(distance);
            m.radius = 0.0;
            // Near the wall, away from it: towards it, the density over area leaves much noise.
            if (distance < 0.9) m.facing = glm::vec3(glm::normalize(glm::dvec3(0.3, 0.5, -1.0)));
            m.irradiance = glm::dvec3(test_radiance) * std::numbers::pi;
            models.push_back(m);
        }
    }
    return models;
}

inline std::vector<LightModel> disk_models(LightBuffers& buffers) {
    const auto point = [](double u, double v) {
        return glm::dvec3(std::cos(v * 2.0 * std::numbers::pi), std::sin(v * 2.0 * std::numbers::pi), 0.0) * std::sqrt(u);
    };
    std::vector<LightModel> models;
    for (double size : {1e-6, 1.0, 1e6}) {
        for (float flip : {1.0F, -1.0F}) {
            const Analytic record = analytic_record(ANALYTIC_DISK, placed(size, {1.0, 0.5, 2.0}), flip);
            LightModel m = analytic_model(buffers, record, {0.5, 0.3, 0.6 * static_cast<double>(flip)});
            m.label = "flip " + std::to_string(flip) + " size " + std::to_string(size);
            m.irradiance = glm::dvec3(test_radiance) * surface_irradiance(record, point, m.reference, m.facing);
            models.push_back(m);
        }
    }
    return models;
}

inline std::vector<LightModel> cylinder_models(LightBuffers& buffers) {
    const auto point = [](double u, double v) {
        return glm::dvec3(std::cos(u * 2.0 * std::numbers::pi), std::sin(u * 2.0 * std::numbers::pi), v);
    };
    std::vector<LightModel> models;
    for (double size : {1e-6, 1.0, 1e6}) {
        for (float flip : {1.0F, -1.0F}) {
            const bool outward = flip > 0.0F;
            const Analytic record = analytic_record(ANALYTIC_CYLINDER, placed(size, {0.5, 0.5, 2.0}), flip);
            LightModel m = analytic_model(buffers, record, outward ? glm::dvec3(2.0, 1.0, 0.3) : glm::dvec3(0.1, 0.2, 0.4));
            m.label = "flip " + std::to_string(flip) + " size " + std::to_string(size);
            m.radius = outward ? 2.5 * m.radius : 0.0;  // about its ends
            m.irradiance = glm::dvec3(test_radiance) * surface_irradiance(record, point, m.reference, m.facing);
            models.push_back(m);
        }
    }
    return models;
}

// ---- lights at infinity -----------------------------------------------------------------------------------------------

inline LightModel environment_model() {
    LightModel m;
    m.label = "environment";
    m.reference = {0.5F, -3.0F, 2.0F};
    m.facing = glm::vec3(glm::normalize(glm::dvec3(0.3, 0.5, -1.0)));
    m.hits = [](const glm::dvec3&, const glm::dvec3&) -> std::vector<LightHit> {
        return {{std::numeric_limits<double>::infinity(), glm::dvec3(0.0)}};
    };
    return m;
}

inline EnvironmentReference random_environment(int width, int height) {
    std::mt19937 random(11);
    std::exponential_distribution<float> exponential(1.0F);
    EnvironmentReference reference;
    reference.image = {.width = width, .height = height, .rgb = {}};
    for (int i = 0; i < width * height * 3; ++i) reference.image.rgb.push_back(exponential(random));
    reference.to_world = glm::dmat3(glm::rotate(glm::dmat4(1.0), 2.1, glm::normalize(glm::dvec3(1.0, -0.4, 0.7))));
    return reference;
}

// ---- all of them --------------------------------------------------------------------------------------------------------

struct LightModels {
    LightBuffers buffers;
    std::vector<LightModel> models;
};

// Of the SURFACE and ENVIRONMENT lights.
inline LightModels light_models(const std::string& name) {
    LightModels all;
    LightBuffers& buffers = all.buffers;
    if (name == "triangle") all.models = planar_models(buffers, true);
    if (name == "spherical_triangle") all.models = planar_models(buffers, true);
    if (name == "parallelogram") all.models = planar_models(buffers, false);
    if (name == "rectangle") all.models = planar_models(buffers, false, true);
    if (name == "sphere") all.models = sphere_models(buffers);
    if (name == "disk") all.models = disk_models(buffers);
    if (name == "cylinder") all.models = cylinder_models(buffers);
    if (name == "constant") {
        buffers.environment[0].radiance = packed(test_radiance);
        all.models = {environment_model()};
        all.models[0].irradiance = glm::dvec3(test_radiance) * std::numbers::pi;
    }
    if (name == "envmap") {
        const EnvironmentReference reference = random_environment(8, 6);
        set_environment(buffers, reference, test_radiance);
        all.models = {environment_model()};
        const glm::dvec3 n(all.models[0].facing);
        all.models[0].irradiance = glm::dvec3(test_radiance) * reference.integral([&](const glm::dvec3& d) {
            return std::max(glm::dot(d, n), 0.0);
        });
    }
    return all;
}

}  // namespace wavelobe::test
