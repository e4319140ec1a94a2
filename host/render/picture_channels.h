// Pictures out of the sums that the film holds.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/device_buffers.h"
#include "render/flatten.h"

namespace wavelobe {

// Of the finite samples.
struct PixelSums {
    std::array<double, 3> sum{};
    double samples = 0.0;
};

// One film, or the two halves of an error estimate together.
std::vector<PixelSums> pixel_sums(std::span<const FilmPixel> film, std::size_t pixels);

// A channel beside the colours, pixel by pixel.
std::vector<float> channel_values(const DeviceScene& scene, const DeviceBuffers& buffers, const PictureChannel& channel,
                                  const std::vector<PixelSums>& sums);

}  // namespace wavelobe
