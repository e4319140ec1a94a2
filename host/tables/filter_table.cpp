#include "tables/filter_table.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "shared/filter_table.h"

namespace wavelobe {
namespace {

using Kind = ReconstructionFilter::Kind;

// Integral of the filter (unnormalized) from 0 to x, for x in [0, radius]; of filters that are nowhere negative.
std::function<double(double)> integral_from_centre(const ReconstructionFilter& filter) {
    const double r = filter.radius, s = filter.stddev;
    if (filter.kind == Kind::tent) return [r](double x) { return x - x * x / (2 * r); };
    if (filter.kind == Kind::gaussian) {
        return [r, s](double x) {
            const double scale = s * std::sqrt(std::numbers::pi / 2);
            return scale * std::erf(x / (s * std::numbers::sqrt2)) - x * std::exp(-r * r / (2 * s * s));
        };
    }
    return [](double x) { return x; };
}

// The x in [0, radius] where the increasing function reaches `value`.
double bisect(const std::function<double(double)>& function, double radius, double value) {
    double low = 0, high = radius;
    for (double middle = radius / 2; low < middle && middle < high; middle = (low + high) / 2)
        (function(middle) < value ? low : high) = middle;
    return high;
}

double sinc(double x) {
    const double angle = std::numbers::pi * x;
    return angle == 0.0 ? 1.0 : std::sin(angle) / angle;
}

// Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics", of radius 2; its integral is one for all b and c.
double mitchell(double b, double c, double x) {
    if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + 6 - 2 * b) / 6;
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + 8 * b + 24 * c) / 6;
}

// Running integrals of a filter and of its absolute value, from the centre to each of many places.
struct SignedIntegrals {
    static constexpr int steps = 1 << 16;
    double step = 0.0;
    std::vector<double> sums{0.0}, magnitudes{0.0};

    // By Simpson's rule; a step with a change of sign in it counts as of the sign it has more of.
    SignedIntegrals(const std::function<double(double)>& filter, double radius) : step(radius / steps) {
        for (int i = 0; i < steps; ++i) {
            const double area = step / 6 * (filter(i * step) + 4 * filter((i + 0.5) * step) + filter((i + 1) * step));
            sums.push_back(sums.back() + area);
            magnitudes.push_back(magnitudes.back() + std::abs(area));
        }
    }

    // The place, in steps, up to which the magnitude is `value`.
    double place(double value) const {
        const auto above = std::upper_bound(magnitudes.begin() + 1, magnitudes.end() - 1, value);
        const auto i = static_cast<std::size_t>(above - magnitudes.begin());
        const double size = magnitudes[i] - magnitudes[i - 1];
        return static_cast<double>(i - 1) + (size > 0 ? std::clamp((value - magnitudes[i - 1]) / size, 0.0, 1.0) : 0.0);
    }

    double sum(double place) const {
        const auto i = static_cast<std::size_t>(std::min(place, steps - 1.0));
        return std::lerp(sums[i], sums[i + 1], place - static_cast<double>(i));
    }
};

// The share of a tail at entry i.
double tail_share(unsigned i) {
    const double root = static_cast<double>(i) / FILTER_TABLE_CELLS;
    return root * root;
}

std::vector<float> signed_table(const ReconstructionFilter& filter) {
    const double r = filter.radius, b = filter.b, c = filter.c;
    const bool is_mitchell = filter.kind == Kind::mitchell;
    const SignedIntegrals integrals(
        [=](double x) { return is_mitchell ? mitchell(b, c, x) : sinc(x) * sinc(x / r); }, r);
    const double magnitude = integrals.magnitudes.back(), total = integrals.sums.back();
    std::vector<float> table;
    std::vector<double> sums;
    for (unsigned i = 0; i <= FILTER_TABLE_CELLS; ++i) {
        const double place = i == 0 ? integrals.steps : integrals.place(magnitude * (1 - tail_share(i)));
        table.push_back(static_cast<float>(place * integrals.step));
        sums.push_back(integrals.sum(place));
    }
    for (unsigned i = 0; i < FILTER_TABLE_CELLS; ++i)
        table.push_back(static_cast<float>((sums[i] - sums[i + 1]) / total / (tail_share(i + 1) - tail_share(i))));
    return table;
}

}  // namespace

std::vector<float> build_filter_table(const ReconstructionFilter& filter) {
    if (filter.is_signed()) return signed_table(filter);
    const auto integral = integral_from_centre(filter);
    const double radius = filter.radius, total = integral(radius);
    std::vector<float> table(FILTER_TABLE_CELLS + 1);
    table[0] = filter.radius;
    for (unsigned i = 1; i < FILTER_TABLE_CELLS; ++i)
        table[i] = static_cast<float>(bisect(integral, radius, total * (1 - tail_share(i))));
    return table;
}

}  // namespace wavelobe
