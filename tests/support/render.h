// Whole renders in tests, and what their pixels say of the expected value.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "host/scene_files.h"
#include "render/render.h"
#include "support/probe.h"
#include "support/scenes.h"
#include "support/verification.h"

namespace wavelobe::test {

struct Rendering {
    Image image;
    RenderStats stats;
};

inline std::uint64_t& last_render_samples() {
    static std::uint64_t samples = 0;
    return samples;
}

inline Rendering render(const Scene& scene, const RenderSettings& settings) {
    Renderer renderer(device(), scene, settings);
    EXPECT_TRUE(renderer.render());
    last_render_samples() = renderer.stats().samples;
    EXPECT_EQ(renderer.stats().nan_samples, 0U);
    return {renderer.image(), renderer.stats()};
}

// The long run makes ten million samples of any picture.
inline Rendering render(const Scene& scene, int samples_per_pixel) {
    RenderSettings settings;
    const int pixels = std::max(scene.film.crop_width * scene.film.crop_height, 1);
    settings.samples_per_pixel = quick_or_full(samples_per_pixel, std::max(samples_per_pixel, (10000000 + pixels - 1) / pixels));
    return render(scene, settings);
}

inline glm::dvec3 pixel(const Image& image, std::size_t index) {
    return {image.rgb[3 * index], image.rgb[3 * index + 1], image.rgb[3 * index + 2]};
}

// Mean over all pixels, which estimate the same value independently of each other, and its standard error from their
// scatter.
struct PictureMean {
    glm::dvec3 mean{0.0};
    glm::dvec3 standard_error{0.0};
};

inline PictureMean picture_mean(const Image& image) {
    const std::size_t n = image.rgb.size() / 3;
    PictureMean out;
    for (std::size_t i = 0; i < n; ++i) out.mean += pixel(image, i) / static_cast<double>(n);
    glm::dvec3 squares{0.0};
    for (std::size_t i = 0; i < n; ++i) squares += (pixel(image, i) - out.mean) * (pixel(image, i) - out.mean);
    out.standard_error = glm::sqrt(squares / static_cast<double>(n - 1) / static_cast<double>(n));
    return out;
}

// A path of a few vertices makes on the order of a hundred roundings of 2^-24; they need not average out.
constexpr double path_rounding = 100 * 0x1p-24;

// The mean of the picture is `expected` within 4.5 standard errors: one comparison in 150 thousand fails by chance. In the
// long run it is within 0.1 %, too.
inline void expect_mean(const Image& image, const glm::dvec3& expected) {
    const PictureMean found = picture_mean(image);
    Claim deviation("Light transport", test_of_claim() + ": deviation of the mean from the closed form", "standard errors");
    Claim relative("Light transport", test_of_claim() + ": the same deviation", "relative");
    for (glm::length_t c = 0; c < 3; ++c) {
        const double off = std::abs(found.mean[c] - expected[c]);
        const double beyond_rounding = std::max(off - path_rounding * expected[c], 0.0);
        const auto where = [&] { return "channel " + std::to_string(c) + ", expected " + std::to_string(expected[c]); };
        deviation.observe(beyond_rounding == 0.0 ? 0.0 : beyond_rounding / found.standard_error[c], where);
        relative.observe(off / expected[c], where);
        // A test that noise could hide anything from would say nothing.
        EXPECT_LT(found.standard_error[c], 0.005 * expected[c]) << "channel " << c << ": too noisy a picture";
    }
    deviation.count(last_render_samples());
    deviation.at_most(4.5);
    if (!verify_fully()) return;
    relative.count(last_render_samples());
    relative.at_most(1e-3);
}

// Every pixel is `expected`, but for rounding: what no random choice changes.
inline void expect_every_pixel(const Image& image, const glm::dvec3& expected) {
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
        for (glm::length_t c = 0; c < 3; ++c) {
            ASSERT_NEAR(pixel(image, i)[c], expected[c], path_rounding * expected[c])
                << "pixel " << i << " channel " << c;
        }
    }
}

}  // namespace wavelobe::test
