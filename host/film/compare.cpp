#include "film/compare.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "scene/fault.h"

namespace wavelobe {
namespace {

// Keeps the relative error of black pixels finite: below a radiance of 0.1 it turns into an absolute one.
constexpr double relative_floor = 0.01;

// Share of pixels left out of the trimmed mean.
constexpr double outlier_share = 0.001;

double square(double x) { return x * x; }

double relative_square(double value, double reference) {
    return square(value - reference) / (square(reference) + relative_floor);
}

void require_equal_size(const Image& image, const Image& reference) {
    if (image.width == reference.width && image.height == reference.height) return;
    const auto size = [](const Image& of) { return std::to_string(of.width) + " x " + std::to_string(of.height); };
    throw InputError(Fault{"", 0, 0, "",
                           "the pictures differ in size: " + size(image) + " and " + size(reference) + " pixels", ""});
}

bool is_finite(const Image& image, std::size_t first) {
    return std::isfinite(image.rgb[first]) && std::isfinite(image.rgb[first + 1]) && std::isfinite(image.rgb[first + 2]);
}

double mean_without_worst(std::vector<double>& errors) {
    const auto dropped = static_cast<std::size_t>(std::ceil(outlier_share * static_cast<double>(errors.size())));
    const std::size_t kept = errors.size() - dropped;
    if (kept == 0) return 0.0;
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(kept), errors.end());
    return std::accumulate(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(kept), 0.0) /
           static_cast<double>(kept);
}

}  // namespace

Comparison compare_images(const Image& image, const Image& reference) {
    require_equal_size(image, reference);
    Comparison result;
    std::vector<double> errors;
    errors.reserve(image.rgb.size() / 3);
    double squares = 0.0;
    double magnitudes = 0.0;
    std::size_t worst = 0;
    for (std::size_t first = 0; first + 2 < image.rgb.size(); first += 3) {
        if (!is_finite(image, first) || !is_finite(reference, first)) {
            ++result.non_finite_pixels;
            continue;
        }
        double error = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double x = image.rgb[first + channel];
            const double r = reference.rgb[first + channel];
            const double difference = std::abs(x - r);
            error += relative_square(x, r) / 3.0;
            squares += square(difference);
            magnitudes += difference;
            result.mean[channel] += x;
            result.reference_mean[channel] += r;
            if (difference > result.max_difference) {
                result.max_difference = difference;
                worst = first / 3;
            }
        }
        errors.push_back(error);
    }
    if (errors.empty()) return result;
    const auto pixels = static_cast<double>(errors.size());
    for (std::size_t channel = 0; channel < 3; ++channel) {
        result.mean[channel] /= pixels;
        result.reference_mean[channel] /= pixels;
    }
    result.rel_mse = std::accumulate(errors.begin(), errors.end(), 0.0) / pixels;
    result.rel_mse_trimmed = mean_without_worst(errors);
    result.rmse = std::sqrt(squares / (3.0 * pixels));
    result.mae = magnitudes / (3.0 * pixels);
    result.max_x = static_cast<int>(worst % static_cast<std::size_t>(image.width));
    result.max_y = static_cast<int>(worst / static_cast<std::size_t>(image.width));
    return result;
}

Image difference_image(const Image& image, const Image& reference) {
    require_equal_size(image, reference);
    Image out{image.width, image.height, std::vector<float>(image.rgb.size())};
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        double signed_error = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double r = reference.rgb[i + channel];
            signed_error += (image.rgb[i + channel] - r) / std::sqrt(square(r) + relative_floor) / 3.0;
        }
        out.rgb[i] = static_cast<float>(std::max(signed_error, 0.0));
        out.rgb[i + 2] = static_cast<float>(std::max(-signed_error, 0.0));
    }
    return out;
}

}  // namespace wavelobe
