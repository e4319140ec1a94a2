// Two ways to the same picture, compared by what their noise allows.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/render.h"

namespace wavelobe::test {

// Differences of the means of the picture and of its quarters, in standard errors from the scatter of the pixels.
inline double deviation(const Image& a, const Image& b) {
    double worst = 0.0;
    for (int part = 0; part < 5; ++part) {
        glm::dvec3 sum{0.0}, squares{0.0};
        for (int y = 0; y < a.height; ++y) {
            for (int x = 0; x < a.width; ++x) {
                const int quarter = (2 * y >= a.height ? 2 : 0) + (2 * x >= a.width ? 1 : 0);
                if (part != 4 && part != quarter) continue;
                const auto i = static_cast<std::size_t>(y * a.width + x);
                const glm::dvec3 d = pixel(a, i) - pixel(b, i);
                sum += d;
                squares += d * d;
            }
        }
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(sum[c]) / std::sqrt(std::max(squares[c], 1e-300)));
    }
    return worst;
}

inline void expect_agreement(const std::string& what, const Scene& a, RenderSettings settings_a, const Scene& b, RenderSettings settings_b) {
    Claim claim("Light transport", what + ": means of the picture and its quarters", "standard errors");
    const Rendering first = render(a, settings_a);
    const Rendering second = render(b, settings_b);
    claim.observe(deviation(first.image, second.image));
    claim.count(first.stats.samples + second.stats.samples);
    claim.at_most(4.0);
}

}  // namespace wavelobe::test
