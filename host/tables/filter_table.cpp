#include "tables/filter_table.h"

#include <algorithm>
#include <cmath>

namespace wavelobe {
namespace {

constexpr int filter_steps = 1024;      // FILTER_STEPS of kernels/sampling/warps.h
constexpr int integration_steps = 1 << 16;

// One dimension of the separable filter, not normalized; as Mitsuba 3 defines them.
double filter_value(const ReconstructionFilter& filter, double x) {
    const double radius = filter.radius;
    switch (filter.kind) {
        case ReconstructionFilter::Kind::box: return 1.0;
        case ReconstructionFilter::Kind::tent: return std::max(0.0, 1.0 - std::abs(x) / radius);
        case ReconstructionFilter::Kind::gaussian: {
            const double alpha = -0.5 / (static_cast<double>(filter.stddev) * filter.stddev);
            return std::max(0.0, std::exp(alpha * x * x) - std::exp(alpha * radius * radius));
        }
    }
    return 0.0;
}

}  // namespace

std::vector<float> build_filter_table(const ReconstructionFilter& filter) {
    const double radius = filter.radius;
    const double width = 2.0 * radius / integration_steps;
    std::vector<double> cumulative(integration_steps + 1, 0.0);
    for (int i = 0; i < integration_steps; ++i) {
        cumulative[static_cast<std::size_t>(i) + 1] =
            cumulative[static_cast<std::size_t>(i)] + filter_value(filter, -radius + (i + 0.5) * width);
    }
    std::vector<float> table(filter_steps + 1);
    std::size_t cell = 0;
    for (std::size_t step = 0; step < table.size(); ++step) {
        const double target = cumulative.back() * static_cast<double>(step) / filter_steps;
        while (cell + 1 < integration_steps && cumulative[cell + 1] < target) ++cell;
        const double share = cumulative[cell + 1] - cumulative[cell];
        const double inside = share > 0.0 ? (target - cumulative[cell]) / share : 0.0;
        table[step] = static_cast<float>(-radius + (static_cast<double>(cell) + inside) * width);
    }
    return table;
}

}  // namespace wavelobe
