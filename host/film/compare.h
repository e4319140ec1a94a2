// How far a picture is from its reference.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "render/render.h"

namespace wavelobe {

// Errors are over all channels of all finite pixels; x is the picture's value, r the reference's.
struct Comparison {
    std::size_t non_finite_pixels = 0;  // in either picture: left out of everything below
    double rel_mse = 0.0;          // mean of (x - r)^2 / (r^2 + 0.01), as in denoising and path-guiding papers
    double rel_mse_trimmed = 0.0;  // the same without the 0.1 % of pixels that are worst: fireflies set apart
    double rmse = 0.0;
    double mae = 0.0;              // mean of |x - r|
    double max_difference = 0.0;   // greatest |x - r|
    int max_x = 0;                 // where that is
    int max_y = 0;
    std::array<double, 3> mean{};            // of the picture, by channel
    std::array<double, 3> reference_mean{};
};

// Throws InputError when the sizes differ.
Comparison compare_images(const Image& image, const Image& reference);

// Signed relative difference as colours: red where the picture is brighter than its reference, blue where it is darker,
// black where they agree; full colour at a difference of 100 %.
Image difference_image(const Image& image, const Image& reference);

}  // namespace wavelobe
