#include "tables/dielectric_surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wavelobe {
namespace {

constexpr double pi = 3.14159265358979323846;

// Unpolarized Fresnel reflectance, eta = behind the boundary over before it.
double fresnel_dielectric(double cos_i, double eta) {
    const double sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1.0) return 1.0;
    const double cos_t = std::sqrt(1.0 - sin2_t);
    const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const double perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Smith's masking of a direction at cosine `cosine`: exact, or as the kernels evaluate lobes, Beckmann's by the rational fit
// of Walter et al. 2007.
double masking(double cosine, double alpha, Distribution distribution, bool exact) {
    if (cosine >= 1.0) return 1.0;
    const double slope = alpha * std::sqrt(1.0 - cosine * cosine) / cosine;
    if (distribution == Distribution::ggx) return 2.0 / (1.0 + std::sqrt(1.0 + slope * slope));
    const double a = 1.0 / slope;
    if (exact) return 2.0 / (1.0 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(pi)));
    return a >= 1.6 ? 1.0 : (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a);
}

struct Microfacet {
    double x, z;   // components of its normal; light comes in the plane y = 0
    double share;  // of the surface's plane
};

// Microfacets at points of a midpoint rule, one of each two mirror images in y. Slopes of GGX have no variance: the points
// have equal steps in the angle whose tangent is the slope over alpha.
std::vector<Microfacet> microfacets(double alpha, Distribution distribution) {
    constexpr int radii = 64;
    constexpr int angles = 32;
    std::vector<Microfacet> result;
    result.reserve(std::size_t{radii} * angles);
    for (int i = 0; i < radii; ++i) {
        const double u = (i + 0.5) / radii;
        const bool ggx = distribution == Distribution::ggx;
        const double slope = alpha * (ggx ? std::tan(0.5 * pi * u) : std::sqrt(-std::log1p(-u)));
        const double share = (ggx ? 0.5 * pi * std::sin(pi * u) : 1.0) / (radii * angles);
        const double z = 1.0 / std::sqrt(1.0 + slope * slope);
        for (int j = 0; j < angles; ++j) result.push_back({slope * std::cos(pi * (j + 0.5) / angles) * z, z, share});
    }
    return result;
}

struct Surface {
    std::vector<Microfacet> facets;
    double alpha;
    Distribution distribution;

    // What of the light at cosine `cosine` leaves a visible microfacet and is not masked on its way out: a microfacet sends
    // `part(cos_m)` of it, at a height of out(cos_m, z) above the surface (on the wrong side of it, if negative).
    template <class Part, class Out>
    double scattered(double cosine, const Part& part, const Out& out) const {
        const double sine = std::sqrt(1.0 - cosine * cosine);
        double sum = 0.0;
        for (const Microfacet& m : facets) {
            const double cos_m = sine * m.x + cosine * m.z;
            if (cos_m <= 0.0) continue;
            const double height = out(cos_m, m.z);
            if (height > 0.0) sum += m.share * part(cos_m) * masking(height, alpha, distribution, false) * cos_m / m.z;
        }
        return sum * masking(cosine, alpha, distribution, true) / cosine;
    }

    double reflectance(double cosine, double eta) const {
        return scattered(
            cosine, [&](double cos_m) { return fresnel_dielectric(cos_m, eta); },
            [&](double cos_m, double z) { return 2.0 * cos_m * z - cosine; });
    }

    double transmittance(double cosine, double eta) const {
        return scattered(
            cosine, [&](double cos_m) { return 1.0 - fresnel_dielectric(cos_m, eta); },
            [&](double cos_m, double z) {
                const double cos_t = std::sqrt(std::max(1.0 - (1.0 - cos_m * cos_m) / (eta * eta), 0.0));
                return cosine / eta - z * (cos_m / eta - cos_t);
            });
    }
};

}  // namespace

// 2 integral of F(mu) mu over mu in [0, 1], midpoint rule in mu^2, fine enough that the error stays below a rounding of
// float.
double diffuse_fresnel(double eta) {
    constexpr int steps = 1 << 16;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += fresnel_dielectric(std::sqrt((i + 0.5) / steps), eta);
    return sum / steps;
}

RoughSurface rough_surface(double eta, double alpha, Distribution distribution) {
    const Surface surface{microfacets(alpha, distribution), alpha, distribution};
    RoughSurface result{};
    constexpr int steps = ROUGH_TRANSMITTANCE_STEPS;
    double internal = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double cosine = std::max(static_cast<double>(i) / (steps - 1), 1e-6);
        result.transmittance[static_cast<std::size_t>(i)] =
            static_cast<float>(std::min(surface.transmittance(cosine, eta), 1.0));
        internal += 2.0 * cosine * std::min(surface.reflectance(cosine, 1.0 / eta), 1.0);
    }
    result.internal_reflectance = static_cast<float>(internal / steps);
    return result;
}

}  // namespace wavelobe
