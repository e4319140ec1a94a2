// Statistics and quadrature for tests of sampling routines: do samples follow the density they claim?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

namespace wavelobe::test {

// ---- significance ----------------------------------------------------------------------------------

// Upper regularized incomplete gamma function Q(a, x) = Gamma(a, x) / Gamma(a), by its series or continued fraction
// (Abramowitz, Stegun 1964, 6.5.29 and 6.5.31).
inline double upper_gamma(double a, double x) {
    if (x <= 0.0) return 1.0;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    const double precision = std::numeric_limits<double>::epsilon();
    if (x < a + 1.0) {
        double term = 1.0 / a;
        double sum = term;
        for (double n = a + 1.0; term > sum * precision; n += 1.0) sum += term *= x / n;
        return 1.0 - front * sum;
    }
    // Modified Lentz evaluation.
    const double tiny = std::numeric_limits<double>::min() / precision;
    double b = x + 1.0 - a;
    double c = 1.0 / tiny;
    double d = 1.0 / b;
    double fraction = d;
    for (int i = 1; i < 100000; ++i) {
        const double numerator = -i * (i - a);
        b += 2.0;
        d = numerator * d + b;
        c = b + numerator / c;
        if (std::abs(d) < tiny) d = tiny;
        if (std::abs(c) < tiny) c = tiny;
        d = 1.0 / d;
        fraction *= d * c;
        if (std::abs(d * c - 1.0) < precision) break;
    }
    return front * fraction;
}

// Probability of a larger statistic if the hypothesis holds.
inline double chi_square_p_value(double statistic, double degrees_of_freedom) {
    return upper_gamma(0.5 * degrees_of_freedom, 0.5 * statistic);
}

// The p-value below which one of `tests` independent tests fails, for a chance of `significance` that any fails by luck
// (Sidak 1967).
inline double sidak_threshold(double significance, std::size_t tests) {
    return -std::expm1(std::log1p(-significance) / static_cast<double>(tests));
}

// Two-sided p-value of a deviation in standard deviations.
inline double normal_p_value(double deviations) { return std::erfc(std::abs(deviations) / std::numbers::sqrt2); }

struct ChiSquareResult {
    double statistic = 0.0;
    int degrees_of_freedom = 0;
    double p_value = 1.0;
};

// Pearson's test of counts against expected counts of the same total. Bins that expect fewer than five are pooled
// (Cochran 1954); where even the pool expects less than one, a single count in it is not evidence and it is left out,
// but counts beyond any chance there give a p-value of zero.
inline ChiSquareResult chi_square_test(const std::vector<double>& counts, const std::vector<double>& expected) {
    ChiSquareResult result;
    double pooled_count = 0.0;
    double pooled_expected = 0.0;
    int bins = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] < 5.0) {
            pooled_count += counts[i];
            pooled_expected += expected[i];
            continue;
        }
        const double difference = counts[i] - expected[i];
        result.statistic += difference * difference / expected[i];
        ++bins;
    }
    if (pooled_expected >= 1.0) {
        const double difference = pooled_count - pooled_expected;
        result.statistic += difference * difference / pooled_expected;
        ++bins;
    }
    result.degrees_of_freedom = std::max(bins - 1, 0);
    if (bins > 1) result.p_value = chi_square_p_value(result.statistic, bins - 1);
    // Poisson: P(n >= 20) is below 1e-18 for a mean of one.
    if (pooled_expected < 1.0 && pooled_count >= 20.0) result.p_value = 0.0;
    return result;
}

// ---- partitions of the sphere -------------------------------------------------------------------------

struct SphereCell {
    double height0, height1;  // 1 - cos of the angle to the axis
    double phi0, phi1;
};

// Rings about an axis cut into sectors. A direction is told by its azimuth and by `height` = 1 - cos of its angle to the
// axis: solid angle is d(height) d(azimuth), and it stays accurate for narrow caps.
class SphereGrid {
public:
    // `heights`: increasing ring borders, from 0; up to 2 for the whole sphere, less for a cap.
    SphereGrid(const glm::dvec3& axis, std::vector<double> heights, int sectors)
        : axis_(glm::normalize(axis)), heights_(std::move(heights)), sectors_(sectors) {
        const glm::dvec3 helper = std::abs(axis_.x) > 0.5 ? glm::dvec3{0, 1, 0} : glm::dvec3{1, 0, 0};
        tangent_ = glm::normalize(glm::cross(helper, axis_));
        bitangent_ = glm::cross(axis_, tangent_);
    }

    // The whole sphere about +z. Rings narrow towards the horizon, where lobes end abruptly at grazing incidence.
    static SphereGrid whole(int sectors) {
        const double above[] = {1.0,  0.875, 0.75, 0.625, 0.5,  0.375, 0.25, 0.125,
                                0.03, 0.01,  3e-3, 1e-3,  3e-4, 1e-4,  0.0};
        std::vector<double> heights;
        for (double z : above) heights.push_back(1.0 - z);
        for (auto z = std::rbegin(above) + 1; z != std::rend(above); ++z) heights.push_back(1.0 + *z);
        return {{0, 0, 1}, std::move(heights), sectors};
    }

    // A cap for a lobe of angular scale `width`: rings grow from a fraction of it to many times it.
    static SphereGrid cap(const glm::dvec3& axis, double width, int sectors) {
        std::vector<double> heights{0.0};
        for (double angle = width / 4.0; angle < std::min(100.0 * width, 3.0); angle *= 1.4) {
            heights.push_back(2.0 * std::pow(std::sin(0.5 * angle), 2.0));
        }
        return {axis, std::move(heights), sectors};
    }

    std::size_t size() const { return (heights_.size() - 1) * static_cast<std::size_t>(sectors_); }

    SphereCell cell(std::size_t index) const {
        const auto ring = index / static_cast<std::size_t>(sectors_);
        const auto sector = static_cast<double>(index % static_cast<std::size_t>(sectors_));
        const double step = 2.0 * std::numbers::pi / sectors_;
        return {heights_[ring], heights_[ring + 1], sector * step, (sector + 1.0) * step};
    }

    glm::dvec3 direction(double height, double phi) const {
        const double radius = std::sqrt(std::max(height * (2.0 - height), 0.0));
        return radius * std::cos(phi) * tangent_ + radius * std::sin(phi) * bitangent_ + (1.0 - height) * axis_;
    }

    // size() for directions outside.
    std::size_t index_of(const glm::dvec3& direction) const {
        const glm::dvec3 chord = direction - axis_;
        const double height = 0.5 * glm::dot(chord, chord);
        const auto border = std::upper_bound(heights_.begin(), heights_.end(), height);
        std::size_t ring = static_cast<std::size_t>(border - heights_.begin()) - 1;
        if (border == heights_.end()) {
            // A direction a rounding error longer than one, opposite to the axis.
            if (heights_.back() < 2.0) return size();
            ring = heights_.size() - 2;
        }
        const double turn = std::atan2(glm::dot(direction, bitangent_), glm::dot(direction, tangent_)) /
                            (2.0 * std::numbers::pi);
        const double sector = std::floor((turn < 0.0 ? turn + 1.0 : turn) * sectors_);
        return ring * static_cast<std::size_t>(sectors_) +
               std::min(static_cast<std::size_t>(sector), static_cast<std::size_t>(sectors_ - 1));
    }

private:
    glm::dvec3 axis_, tangent_, bitangent_;
    std::vector<double> heights_;
    int sectors_;
};

// ---- quadrature -----------------------------------------------------------------------------------------

// Values of one or more functions at many directions: `channels` numbers a direction, those of a direction together.
using BatchFunction = std::function<std::vector<double>(const std::vector<glm::dvec3>&)>;

// Integrals over each cell of the grid and each channel (those of a cell together), adaptively: a cell is cut in four until
// that changes its integrals by less than `tolerance`. Functions are called with large batches, as devices like it.
inline std::vector<double> integrate_cells(const SphereGrid& grid, const BatchFunction& function, std::size_t channels,
                                           double tolerance) {
    // Gauss-Legendre rule of four points on [0, 1].
    constexpr double nodes[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
    constexpr double weights[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
    constexpr int min_depth = 2;  // a feature must not hide between the first points
    constexpr int max_depth = 12;

    struct Job {
        SphereCell cell;
        std::size_t target;
    };
    const auto evaluate = [&](const std::vector<Job>& jobs) {
        std::vector<glm::dvec3> directions;
        directions.reserve(jobs.size() * 16);
        for (const Job& job : jobs) {
            for (double a : nodes) {
                for (double b : nodes) {
                    directions.push_back(grid.direction(std::lerp(job.cell.height0, job.cell.height1, a),
                                                        std::lerp(job.cell.phi0, job.cell.phi1, b)));
                }
            }
        }
        const std::vector<double> values = function(directions);
        std::vector<double> integrals(jobs.size() * channels, 0.0);
        for (std::size_t j = 0; j < jobs.size(); ++j) {
            const SphereCell& c = jobs[j].cell;
            const double area = (c.height1 - c.height0) * (c.phi1 - c.phi0);
            for (std::size_t i = 0; i < 16; ++i) {
                for (std::size_t k = 0; k < channels; ++k) {
                    const double value = values[(j * 16 + i) * channels + k];
                    integrals[j * channels + k] += area * weights[i / 4] * weights[i % 4] * value;
                }
            }
        }
        return integrals;
    };

    std::vector<double> result(grid.size() * channels, 0.0);
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < grid.size(); ++i) jobs.push_back({grid.cell(i), i});
    std::vector<double> coarse = evaluate(jobs);
    for (int depth = 0; !jobs.empty(); ++depth) {
        std::vector<Job> quarters;
        quarters.reserve(jobs.size() * 4);
        for (const Job& job : jobs) {
            const SphereCell& c = job.cell;
            const double height = 0.5 * (c.height0 + c.height1);
            const double phi = 0.5 * (c.phi0 + c.phi1);
            quarters.push_back({{c.height0, height, c.phi0, phi}, job.target});
            quarters.push_back({{c.height0, height, phi, c.phi1}, job.target});
            quarters.push_back({{height, c.height1, c.phi0, phi}, job.target});
            quarters.push_back({{height, c.height1, phi, c.phi1}, job.target});
        }
        const std::vector<double> fine = evaluate(quarters);
        std::vector<Job> next;
        std::vector<double> next_coarse;
        for (std::size_t j = 0; j < jobs.size(); ++j) {
            bool settled = depth >= min_depth;
            std::vector<double> sum(channels, 0.0);
            for (std::size_t k = 0; k < channels; ++k) {
                for (std::size_t q = 0; q < 4; ++q) sum[k] += fine[(4 * j + q) * channels + k];
                settled = settled && std::abs(sum[k] - coarse[j * channels + k]) <= tolerance;
            }
            if (settled || depth == max_depth) {
                for (std::size_t k = 0; k < channels; ++k) result[jobs[j].target * channels + k] += sum[k];
                continue;
            }
            for (std::size_t q = 0; q < 4; ++q) {
                next.push_back(quarters[4 * j + q]);
                for (std::size_t k = 0; k < channels; ++k) next_coarse.push_back(fine[(4 * j + q) * channels + k]);
            }
        }
        jobs = std::move(next);
        coarse = std::move(next_coarse);
    }
    return result;
}

}  // namespace wavelobe::test
