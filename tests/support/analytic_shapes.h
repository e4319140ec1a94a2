// Analytic shapes as records, and the same surfaces in extended precision as an oracle.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "shared/lights.h"

namespace wavelobe::test {

using Real = long double;
using Real3 = glm::vec<3, Real>;

inline Affine affine_of(const glm::dmat4& m) {
    Affine a{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) a.m[row * 4 + column] = static_cast<float>(m[column][row]);
    }
    return a;
}

// The map as the record rounds it, so that to_object can be its inverse.
inline glm::dmat4 rounded(const glm::dmat4& m) { return glm::dmat4(glm::mat4(m)); }

inline Analytic analytic_record(Uint32 kind, const glm::dmat4& to_world, float flip = 1.0F) {
    const glm::dmat4 map = rounded(to_world);
    const glm::dvec3 x(map[0]);
    const glm::dvec3 y(map[1]);
    const glm::dvec3 z(map[2]);
    using std::numbers::pi;
    const double area = kind == ANALYTIC_SPHERE ? 4.0 * pi * glm::dot(x, x)
                        : kind == ANALYTIC_DISK ? pi * glm::length(glm::cross(x, y))
                                                : 2.0 * pi * glm::length(x) * glm::length(z);
    Analytic record{};
    record.to_world = affine_of(map);
    record.to_object = affine_of(glm::inverse(map));
    record.kind = kind;
    record.flip = flip;
    record.area = static_cast<float>(area);
    record.radius = static_cast<float>(glm::length(x));
    return record;
}

inline Real3 real3(const glm::vec3& v) { return Real3(v); }

// The surface a record stands for (see shapes/analytic_map.h).
class AnalyticSurface {
public:
    AnalyticSurface() = default;

    explicit AnalyticSurface(const Analytic& record) : kind_(record.kind), flip_(record.flip), radius_(record.radius) {
        for (int i = 0; i < 3; ++i) {
            origin_[i] = record.to_world.m[4 * i + 3];
            for (int k = 0; k < 3; ++k) row_[i][k] = record.to_object.m[4 * i + k];
        }
    }

    Real3 local(const Real3& p) const {
        const Real3 f = p - origin_;
        return {glm::dot(row_[0], f), glm::dot(row_[1], f), glm::dot(row_[2], f)};
    }

    // Signed distance to the (unbounded) surface to first order, and its gradient: the unit normal before the flip.
    Real distance(const Real3& p, Real3& normal) const {
        if (kind_ == ANALYTIC_SPHERE) {
            const Real3 f = p - origin_;
            normal = f / glm::length(f);
            return glm::length(f) - radius_;
        }
        const Real3 q = local(p);
        const Real radial = std::sqrt(q.x * q.x + q.y * q.y);
        const Real3 gradient = kind_ == ANALYTIC_DISK ? row_[2] : (row_[0] * q.x + row_[1] * q.y) / radial;
        normal = gradient / glm::length(gradient);
        return (kind_ == ANALYTIC_DISK ? q.z : radial - 1.0L) / glm::length(gradient);
    }

    Real3 normal(const Real3& p) const {
        Real3 n;
        distance(p, n);
        return n * flip_;
    }

    // Sum of the magnitudes that add up to the coordinates of p on the unit shape: what their rounding scales with.
    Real magnitude(const Real3& p) const {
        const Real3 f = glm::abs(p - origin_) + glm::abs(p);
        return glm::dot(glm::abs(row_[0]) + glm::abs(row_[1]) + glm::abs(row_[2]), f);
    }

    // How fast the unit shape's level set changes along the normal.
    Real steepness(const Real3& p) const {
        const Real3 q = local(p);
        if (kind_ == ANALYTIC_SPHERE) return 1.0L / radius_;
        if (kind_ == ANALYTIC_DISK) return glm::length(row_[2]);
        return glm::length(row_[0] * q.x + row_[1] * q.y) / std::sqrt(q.x * q.x + q.y * q.y);
    }

    // Texture coordinates of a surface point (Mitsuba 3: sphere, disk, cylinder).
    glm::vec<2, Real> uv(const Real3& p) const {
        const Real3 q = local(p);
        const Real pi = std::numbers::pi_v<Real>;
        const Real radial = std::sqrt(q.x * q.x + q.y * q.y);
        Real azimuth = std::atan2(q.y, q.x) / (2.0L * pi);
        if (azimuth < 0.0L) azimuth += 1.0L;
        if (kind_ == ANALYTIC_SPHERE) return {azimuth, std::atan2(radial, q.z) / pi};
        if (kind_ == ANALYTIC_DISK) return {radial, azimuth};
        return {azimuth, q.z};
    }

    struct Crossing {
        Real t;
        Real margin;  // how clearly it is a hit: relative distance of the decisions from their borders; negative: none
    };

    // Where a line meets the surface, in order, hits and near misses.
    std::vector<Crossing> crossings(const Real3& origin, const Real3& direction) const {
        const Real3 f = origin - origin_;
        if (kind_ == ANALYTIC_SPHERE) return round_crossings(f / radius_, direction / radius_, false);
        const Real3 o = local(origin);
        const Real3 d(glm::dot(row_[0], direction), glm::dot(row_[1], direction), glm::dot(row_[2], direction));
        if (kind_ == ANALYTIC_CYLINDER) return round_crossings(o, d, true);
        const Real t = -o.z / d.z;
        const Real x = o.x + t * d.x;
        const Real y = o.y + t * d.y;
        if (!std::isfinite(t)) return {};
        return {{t, 1.0L - x * x - y * y}};
    }

private:
    // Unit sphere, or unit cylinder about z between 0 and 1.
    static std::vector<Crossing> round_crossings(Real3 o, Real3 d, bool cylinder) {
        const Real oz = o.z;
        const Real dz = d.z;
        if (cylinder) o.z = d.z = 0.0L;
        const Real a = glm::dot(d, d);
        const Real middle = -glm::dot(o, d) / a;
        const Real3 nearest = o + middle * d;
        const Real below = 1.0L - glm::dot(nearest, nearest);
        if (!(a > 0.0L) || below < -1e-3L) return {};
        const Real half = std::sqrt(std::max(below, 0.0L) / a);
        std::vector<Crossing> result;
        for (Real t : {middle - half, middle + half}) {
            const Real z = oz + t * dz;
            result.push_back({t, cylinder ? std::min(below, std::min(z, 1.0L - z)) : below});
        }
        return result;
    }

    Uint32 kind_ = ANALYTIC_SPHERE;
    Real flip_ = 1.0L;
    Real radius_ = 1.0L;
    Real3 origin_{0.0L};
    Real3 row_[3] = {{1.0L, 0.0L, 0.0L}, {0.0L, 1.0L, 0.0L}, {0.0L, 0.0L, 1.0L}};
};

}  // namespace wavelobe::test
