#include "tables/luminance.h"

namespace wavelobe {
namespace {

double mean_luminance(const Bitmap& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        sum += luminance({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    }
    return image.rgb.empty() ? 0.0 : sum / (static_cast<double>(image.rgb.size()) / 3.0);
}

double mean_luminance(const Checkerboard& checkerboard) {
    return 0.5 * (luminance(checkerboard.color0) + luminance(checkerboard.color1));
}

}  // namespace

double luminance(const Rgb& color) {
    return 0.212671 * static_cast<double>(color.r) + 0.715160 * static_cast<double>(color.g) +
           0.072169 * static_cast<double>(color.b);
}

double mean_luminance(const Parameter& radiance) {
    if (!radiance.texture) return luminance(radiance.value);
    return std::visit([](const auto& source) { return mean_luminance(source); }, radiance.texture->source);
}

}  // namespace wavelobe
