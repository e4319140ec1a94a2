#include "tables/sheen_albedo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wavelobe {

namespace {

// Estevez, Kulla 2017, "Production Friendly Microfacet Sheen BRDF": table 1, between its two rows by (1 - alpha)^2.
double log_masking(double cosine, double alpha) {
    const double t = (1.0 - alpha) * (1.0 - alpha);
    const double a = std::lerp(21.5473, 25.3245, t), b = std::lerp(3.82987, 3.32435, t), c = std::lerp(0.19823, 0.16801, t);
    const double d = std::lerp(-1.97760, -1.27393, t), e = std::lerp(-4.32054, -4.85967, t);
    return a / (1.0 + b * std::pow(cosine, c)) + d * cosine + e;
}

double masking(double cosine, double alpha) {
    if (cosine < 0.5) return std::exp(log_masking(cosine, alpha));
    return std::exp(2.0 * log_masking(0.5, alpha) - log_masking(1.0 - cosine, alpha));
}

}  // namespace

double sheen_directional_albedo(double cosine, double alpha, int cosines, int azimuths) {
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const double own = masking(cosine, alpha);
    double sum = 0.0;
    for (int i = 0; i < cosines; ++i) {
        // Even steps of the cosine's root: most of the light leaves near the horizon.
        const double root = (i + 0.5) / cosines;
        const double z = root * root, s = std::sqrt(1.0 - z * z);
        double around = 0.0;
        for (int k = 0; k < azimuths; ++k) {
            const double phi = std::numbers::pi * (k + 0.5) / azimuths;
            const double x = sine + s * std::cos(phi), y = s * std::sin(phi);
            const double across = x * x + y * y;
            around += std::pow(across / (across + (cosine + z) * (cosine + z)), 0.5 / alpha);
        }
        sum += 2.0 * root * around / (1.0 + own + masking(z, alpha));
    }
    const double density = (2.0 + 1.0 / alpha) / (2.0 * std::numbers::pi);
    return sum / cosines * density * 2.0 * std::numbers::pi / azimuths / (4.0 * cosine);
}

SheenAlbedo sheen_albedo() {
    SheenAlbedo out{};
    for (unsigned row = 0; row < SHEEN_ROUGHNESSES; ++row) {
        const double least = static_cast<double>(SHEEN_LEAST_ROUGHNESS);
        const double roughness = least + (1.0 - least) * row / (SHEEN_ROUGHNESSES - 1);
        for (unsigned column = 0; column < SHEEN_COSINES; ++column) {
            // The first column stands for what is nearly grazing: its limit is seen by no one.
            const double root = std::max(static_cast<double>(column), 0.25) / (SHEEN_COSINES - 1);
            out.at[row * SHEEN_COSINES + column] = static_cast<float>(sheen_directional_albedo(root * root, roughness * roughness, 64, 32));
        }
    }
    return out;
}

}  // namespace wavelobe
