// Reconstruction filters that are negative somewhere: samples drawn by their absolute value, and what each counts, against
// the filters' definitions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "shared/filter_table.h"
#include "support/probe.h"
#include "tables/filter_table.h"

namespace wavelobe::test {
namespace {

using Kind = ReconstructionFilter::Kind;

const char* const source = R"(
    #include "sampling/warps.h"
    kernel void filter(global const float *table, global const float *in, global float *x, global float *weight) {
        size_t i = get_global_id(0) * LANES;
        store(x + i, sample_filter(table, load(in + i)));
        store(weight + i, filter_weight(table, load(in + i)));
    }
)";

struct Drawn {
    std::vector<float> x, weight;
};

Drawn draw(const ReconstructionFilter& f, const std::vector<float>& u, int lanes = 16) {
    Probe probe(source, {.lanes = lanes, .defines = ""});
    const std::vector<float> table = build_filter_table(f);
    Drawn drawn{std::vector<float>(u.size()), std::vector<float>(u.size())};
    probe.run("filter", u.size() / static_cast<unsigned>(lanes), table, u, drawn.x, drawn.weight);
    return drawn;
}

// Mitchell and Netravali's cubics: the inner in powers of the distance from the centre, the outer in those of the distance from
// the end.
double cubic(double b, double c, double x) {
    x = std::abs(x);
    if (x >= 2) return 0;
    if (x >= 1) {
        const double t = 2 - x;
        return (t * t * t * (b + 6 * c) - 6 * c * t * t) / 6;
    }
    return 1 - b / 3 + x * x * ((2 * b + c - 3) + x * (2 - 1.5 * b - c));
}

double windowed_sinc(double lobes, double x) {
    x = std::abs(x);
    if (x < 1e-9) return 1;
    if (x >= lobes) return 0;
    const double a = std::numbers::pi * x;
    return std::sin(a) * std::sin(a / lobes) * lobes / (a * a);
}

double value(const ReconstructionFilter& f, double x) {
    return f.kind == Kind::mitchell ? cubic(f.b, f.c, x) : windowed_sinc(f.radius, x);
}

ReconstructionFilter mitchell(float b, float c) { return {.kind = Kind::mitchell, .b = b, .c = c}; }
ReconstructionFilter lanczos(float lobes) { return {.kind = Kind::lanczos, .radius = lobes}; }

const std::vector<ReconstructionFilter> filters = {mitchell(1.0F / 3, 1.0F / 3), mitchell(0, 0.5F), mitchell(0.25F, 0.55F), mitchell(1, 0),
                                                   mitchell(-0.5F, 1.5F),        lanczos(1),        lanczos(2),            lanczos(3),
                                                   lanczos(8)};

// Midpoints of 2^18 equal shares.
std::vector<float> midpoints() {
    std::vector<float> u;
    for (int i = 0; i < 1 << 18; ++i) u.push_back((static_cast<float>(i) + 0.5F) * 0x1p-18F);
    return u;
}

// The weight of all samples up to each place is the filter's integral up to there.
TEST(SignedFilters, WeightedSamplesFollowTheFilter) {
    const std::vector<float> u = midpoints();
    for (const ReconstructionFilter& f : filters) {
        const Drawn drawn = draw(f, u);
        constexpr int steps = 1 << 17;
        const double h = 2.0 * f.radius / steps;
        std::vector<double> sums{0.0}, magnitudes{0.0};
        for (int i = 0; i < steps; ++i) {
            const double area = h * value(f, -f.radius + (i + 0.5) * h);
            sums.push_back(sums.back() + area);
            magnitudes.push_back(magnitudes.back() + std::abs(area));
        }
        const double c = magnitudes.back() / sums.back();
        double weight = 0, worst = 0;
        for (std::size_t i = 0; i < u.size(); ++i) {
            ASSERT_LE(std::abs(drawn.x[i]), f.radius);
            ASSERT_TRUE(i == 0 || drawn.x[i] >= drawn.x[i - 1]);
            ASSERT_LE(std::abs(drawn.weight[i]), c * (1 + 1e-4)) << "no sample counts more than the filter asks for";
            const double before = weight;
            weight += static_cast<double>(drawn.weight[i]) / static_cast<double>(u.size());
            const double at = (static_cast<double>(drawn.x[i]) / f.radius + 1) / 2 * steps;
            const auto cell = static_cast<std::size_t>(std::min(at, steps - 1.0));
            const double expected = std::lerp(sums[cell], sums[cell + 1], at - static_cast<double>(cell)) / sums.back();
            worst = std::max(worst, std::abs(0.5 * (before + weight) - expected));
        }
        // Within a cell of the table the density is taken as constant, and so is its sign.
        EXPECT_LT(worst, 1e-3 * c) << "kind " << static_cast<int>(f.kind) << " radius " << f.radius << " b " << f.b << " c " << f.c;
        EXPECT_NEAR(weight, 1.0, 2e-5 * c) << "a constant picture keeps its value";
    }
}

TEST(SignedFilters, FullWeightAwayFromChangesOfSign) {
    const std::vector<float> u = midpoints();
    for (const ReconstructionFilter& f : filters) {
        const Drawn drawn = draw(f, u);
        float most = 0;
        for (const float w : drawn.weight) most = std::max(most, w);
        std::size_t partial = 0;
        for (std::size_t i = 0; i < u.size(); ++i) {
            if (std::abs(drawn.weight[i]) < 0.999F * most) {
                ++partial;
            } else if (std::abs(value(f, drawn.x[i])) > 1e-3) {
                ASSERT_EQ(drawn.weight[i] < 0, value(f, drawn.x[i]) < 0) << drawn.x[i];
            }
        }
        EXPECT_LT(static_cast<double>(partial) / static_cast<double>(u.size()), 0.004 * 2 * f.radius);
    }
}

TEST(SignedFilters, HaveTheSameBitsAtEveryWidth) {
    const std::vector<float> u = midpoints();
    const Drawn wide = draw(filters[7], u);
    for (const int lanes : {1, 8}) {
        const Drawn narrow = draw(filters[7], u, lanes);
        EXPECT_EQ(narrow.x, wide.x);
        EXPECT_EQ(narrow.weight, wide.weight);
    }
}

}  // namespace
}  // namespace wavelobe::test
