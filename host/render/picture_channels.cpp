#include "render/picture_channels.h"

namespace wavelobe {
namespace {

// sRGB's primaries and white point (IEC 61966-2-1), a row each of X, Y and Z; kernels/stages/accumulate.h has the same numbers.
constexpr std::array<std::array<double, 3>, 3> rgb_to_xyz{
    {{0.412453, 0.357580, 0.180423}, {0.212671, 0.715160, 0.072169}, {0.019334, 0.119193, 0.950227}}};

double light_sum(const PixelSums& pixel, const PictureChannel& channel) {
    const auto component = static_cast<std::size_t>(channel.component);
    if (channel.kind == LayerKind::rgb) return pixel.sum[component];
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += rgb_to_xyz[component][c] * pixel.sum[c];
    return sum;
}

}  // namespace

std::vector<PixelSums> pixel_sums(std::span<const FilmPixel> film, std::size_t pixels) {
    std::vector<PixelSums> sums(pixels);
    for (std::size_t i = 0; i < film.size(); ++i) {
        PixelSums& pixel = sums[i % pixels];
        for (std::size_t c = 0; c < 3; ++c) pixel.sum[c] += film[i].sum[c];
        pixel.samples += film[i].samples;
    }
    return sums;
}

std::vector<float> channel_values(const DeviceScene& scene, const DeviceBuffers& buffers, const PictureChannel& channel,
                                  const std::vector<PixelSums>& sums) {
    const bool of_light = channel.kind == LayerKind::rgb || channel.kind == LayerKind::xyz;
    const auto component = static_cast<std::size_t>(channel.component);
    std::vector<float> values;
    values.reserve(sums.size());
    const auto append = [&](double sum, double weight) { values.push_back(weight != 0.0 ? static_cast<float>(sum / weight) : 0.0F); };
    if (!of_light) {
        const auto film = buffers.view<double>("layer_film");
        const std::size_t stride = scene.features.layer_channels();
        const std::size_t offset = scene.features.layer_offset(static_cast<std::uint32_t>(channel.kind), channel.squared) + component;
        for (std::size_t i = 0; i < sums.size(); ++i) append(film[i * stride + offset], film[i * stride]);
    } else if (channel.squared) {
        const auto film = buffers.view<double>("moment_film");
        const std::size_t offset = (channel.kind == LayerKind::xyz ? 3 : 0) + component;
        for (std::size_t i = 0; i < sums.size(); ++i) append(film[i * MOMENT_CHANNELS + offset], sums[i].samples);
    } else {
        for (const PixelSums& pixel : sums) append(light_sum(pixel, channel), pixel.samples);
    }
    return values;
}

}  // namespace wavelobe
