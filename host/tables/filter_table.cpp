#include "tables/filter_table.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "shared/filter_table.h"

namespace wavelobe {
namespace {

// Integral of the filter (unnormalized) from 0 to x, for x in [0, radius].
std::function<double(double)> integral_from_centre(const ReconstructionFilter& filter) {
    const double r = filter.radius, s = filter.stddev;
    switch (filter.kind) {
        case ReconstructionFilter::Kind::tent:
            return [r](double x) { return x - x * x / (2 * r); };
        case ReconstructionFilter::Kind::gaussian:
            return [r, s](double x) {
                const double scale = s * std::sqrt(std::numbers::pi / 2);
                return scale * std::erf(x / (s * std::numbers::sqrt2)) - x * std::exp(-r * r / (2 * s * s));
            };
        case ReconstructionFilter::Kind::box:
            break;
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

}  // namespace

std::vector<float> build_filter_table(const ReconstructionFilter& filter) {
    const auto integral = integral_from_centre(filter);
    const double radius = filter.radius, total = integral(radius);
    std::vector<float> table(FILTER_TABLE_CELLS + 1);
    table[0] = filter.radius;
    for (unsigned i = 1; i < FILTER_TABLE_CELLS; ++i) {
        const double root = static_cast<double>(i) / FILTER_TABLE_CELLS;
        table[i] = static_cast<float>(bisect(integral, radius, total * (1 - root * root)));
    }
    return table;
}

}  // namespace wavelobe
