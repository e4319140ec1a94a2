// Whole renders in tests, and what their pixels say of the expected value.
#pragma once

#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>
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

inline Rendering render(const Scene& scene, const RenderSettings& settings) {
    Renderer renderer(device(), scene, settings);
    EXPECT_TRUE(renderer.render());
    EXPECT_EQ(renderer.stats().nan_samples, 0U);
    return {renderer.image(), renderer.stats()};
}

inline Rendering render(const Scene& scene, int samples_per_pixel) {
    RenderSettings settings;
    settings.samples_per_pixel = samples_per_pixel;
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

// The mean of the picture is `expected` within 4.5 standard errors: one comparison in 150 thousand fails by chance.
inline void expect_mean(const Image& image, const glm::dvec3& expected) {
    const PictureMean found = picture_mean(image);
    for (glm::length_t c = 0; c < 3; ++c) {
        const double tolerance = 4.5 * found.standard_error[c] + path_rounding * expected[c];
        EXPECT_NEAR(found.mean[c], expected[c], tolerance)
            << "channel " << c << ": " << (found.mean[c] - expected[c]) / found.standard_error[c]
            << " standard errors, " << 100.0 * (found.mean[c] / expected[c] - 1.0) << " %";
        // A test that noise could hide anything from would say nothing.
        EXPECT_LT(found.standard_error[c], 0.005 * expected[c]) << "channel " << c << ": too noisy a picture";
    }
}

// A scene of known radiance: the mean of its picture is that within 4 standard errors, and in the long run of ten million
// samples within 0.1 %. A claim of the accuracy report, named by its test.
inline void expect_closed_form(const Scene& scene, int samples_per_pixel, const glm::dvec3& expected) {
    const std::string test = test_of_claim();
    static std::map<std::string, int> pictures;  // of each test
    const int number = ++pictures[test];
    Claim claim("Light transport", "Closed form " + test + (number > 1 ? ", picture " + std::to_string(number) : ""), "of what is allowed");
    const auto pixels = static_cast<double>(scene.film.crop_width * scene.film.crop_height);
    const auto most = static_cast<int>(std::ceil(1e7 / pixels));
    const Rendering rendering = render(scene, quick_or_full(samples_per_pixel, std::max(samples_per_pixel, most)));
    const PictureMean found = picture_mean(rendering.image);
    for (glm::length_t c = 0; c < 3; ++c) {
        const double off = found.mean[c] - expected[c];
        const double allowed = 4.0 * found.standard_error[c] + path_rounding * expected[c];
        const double at_most = std::min(allowed, (verify_fully() ? 1e-3 : 2e-2) * expected[c]);
        claim.observe(std::abs(off) / at_most, [&] {
            return fmt::format("channel {}: {:+.1e} of {:.4g}, standard error {:.1e}", c, off / expected[c], expected[c], found.standard_error[c] / expected[c]);
        });
        // A test that noise could hide anything from would say nothing.
        EXPECT_LT(found.standard_error[c], 0.005 * expected[c]) << "channel " << c << ": too noisy a picture";
    }
    claim.count(rendering.stats.samples);
    claim.at_most(1.0);
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
