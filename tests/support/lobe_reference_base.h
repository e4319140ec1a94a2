// Lobes in double precision on the host, by the textbook formulas, for comparison with the kernels.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "shared/materials.h"
#include "support/lobe_extensions.h"

namespace wavelobe::test {

constexpr double pi = std::numbers::pi;

inline glm::dvec3 to_double(const Packed3& v) { return {v.x, v.y, v.z}; }

// ---- Fresnel --------------------------------------------------------------------------------------------

// Mean of both polarizations for a complex relative index n; cos_i >= 0.
inline double reference_fresnel(double cos_i, std::complex<double> n) {
    const std::complex<double> cos_t = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / (n * n));
    const std::complex<double> s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    const std::complex<double> p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    return 0.5 * (std::norm(s) + std::norm(p));
}

// cos_i < 0: from the side of index eta.
inline double reference_fresnel_dielectric(double cos_i, double eta) {
    if (eta == 1.0) return 0.0;
    const double n = cos_i < 0.0 ? 1.0 / eta : eta;
    if (1.0 - cos_i * cos_i >= n * n) return 1.0;  // total reflection
    return reference_fresnel(std::abs(cos_i), n);
}

inline glm::dvec3 reference_fresnel_conductor(const ::Material& m, double cos_i) {
    return {reference_fresnel(cos_i, {m.eta.x, m.k.x}), reference_fresnel(cos_i, {m.eta.y, m.k.y}),
            reference_fresnel(cos_i, {m.eta.z, m.k.z})};
}

// ---- microfacets ----------------------------------------------------------------------------------------

// Density of normals m, Walter et al. 2007 with anisotropy.
inline double reference_density(const ::Material& material, const glm::dvec3& m) {
    const double au = material.alpha_u.value;
    const double av = material.alpha_v.value;
    if (m.z <= 0.0) return 0.0;
    const double slope_squared = (m.x * m.x / (au * au) + m.y * m.y / (av * av)) / (m.z * m.z);
    const double cos4 = m.z * m.z * m.z * m.z;
    if (material.flags & MATERIAL_BECKMANN) return std::exp(-slope_squared) / (pi * au * av * cos4);
    return 1.0 / (pi * au * av * cos4 * (1.0 + slope_squared) * (1.0 + slope_squared));
}

// Smith masking: exact, or Beckmann's by the rational fit of Walter et al.
inline double reference_masking(const ::Material& material, const glm::dvec3& v, bool exact) {
    const double slope = std::hypot(material.alpha_u.value * v.x, material.alpha_v.value * v.y) / std::abs(v.z);
    if (!(material.flags & MATERIAL_BECKMANN)) return 2.0 / (1.0 + std::sqrt(1.0 + slope * slope));
    const double a = 1.0 / slope;
    if (exact) return 2.0 / (1.0 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(pi)));
    if (a >= 1.6) return 1.0;
    return (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a);
}

// ---- glossy and diffuse lobes -----------------------------------------------------------------------------

struct ReferenceValue {
    glm::dvec3 f_cos{0.0};
    double pdf = 0.0;
};

}  // namespace wavelobe::test
