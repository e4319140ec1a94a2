// Warps against their closed forms and the distributions they claim; reconstruction filters against their definition;
// weights of multiple importance sampling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "shared/filter_table.h"
#include "support/probe.h"
#include "support/statistics.h"
#include "tables/filter_table.h"

namespace wavelobe::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double ulp = 0x1p-23;
constexpr float below_one = 1.0F - 0x1p-24F;

const char* const source = R"(
    #include "sampling/mis.h"
    #include "sampling/warps.h"
    kernel void warps(global const float *in1, global const float *in2, global float *out, uint n) {
        size_t i = get_global_id(0) * LANES;
        Float u1 = load(in1 + i), u2 = load(in2 + i);
        Vec2 disk = square_to_disk(u1, u2);
        Vec3 hemisphere = sample_cosine_hemisphere(u1, u2);
        Vec3 sphere = square_to_uniform_sphere(u1, u2);
        Vec2 triangle = square_to_triangle(u1, u2);
        Float values[11] = {disk.x, disk.y, hemisphere.x, hemisphere.y, hemisphere.z, sphere.x, sphere.y, sphere.z,
                            triangle.x, triangle.y, cosine_hemisphere_pdf(hemisphere.z)};
        for (uint k = 0; k < 11; ++k) store(out + k * n + i, values[k]);
    }
    kernel void filter(global const float *table, global const float *in, global float *out) {
        size_t i = get_global_id(0) * LANES;
        store(out + i, sample_filter(table, load(in + i)));
    }
    kernel void weights(global const float *a, global const float *b, global float *out) {
        size_t i = get_global_id(0) * LANES;
        store(out + i, power_heuristic(load(a + i), load(b + i)));
    }
)";

struct Warped {
    double disk[2], hemisphere[3], sphere[3], triangle[2], pdf;
};

std::vector<float> raw_warps(const std::vector<float>& u1, const std::vector<float>& u2, int lanes) {
    Probe probe(source, {.lanes = lanes, .defines = ""});
    const auto n = static_cast<std::uint32_t>(u1.size());
    std::vector<float> out(11 * u1.size());
    probe.run("warps", u1.size() / static_cast<unsigned>(lanes), u1, u2, out, n);
    return out;
}

std::vector<Warped> warp(const std::vector<float>& u1, const std::vector<float>& u2) {
    const std::vector<float> out = raw_warps(u1, u2, 16);
    const std::size_t n = u1.size();
    std::vector<Warped> results(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto v = [&](std::size_t k) { return static_cast<double>(out[k * n + i]); };
        results[i] = {{v(0), v(1)}, {v(2), v(3), v(4)}, {v(5), v(6), v(7)}, {v(8), v(9)}, v(10)};
    }
    return results;
}

struct Square {
    std::vector<float> u1, u2;
};

Square random_points(std::size_t count) {
    std::mt19937 random(13);
    Square s;
    for (std::size_t i = 0; i < 2 * count; ++i) {
        (i % 2 ? s.u2 : s.u1).push_back(static_cast<float>(random() >> 8) * 0x1p-24F);
    }
    return s;
}

// Corners, centre, diagonals and their neighbours, and random points.
Square all_points() {
    Square s = random_points(100000);
    const float edges[] = {0.0F, 0x1p-24F, 0.25F, 0.5F - 0x1p-24F, 0.5F, 0.5F + 0x1p-24F, 0.75F, below_one - 0x1p-24F, below_one};
    for (float a : edges) {
        for (float b : edges) {
            s.u1.push_back(a);
            s.u2.push_back(b);
        }
    }
    s.u1.resize((s.u1.size() + 15) / 16 * 16, 0.5F);
    s.u2.resize(s.u1.size(), 0.5F);
    return s;
}

TEST(Warps, FollowTheirClosedForms) {
    const Square s = all_points();
    const auto results = warp(s.u1, s.u2);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const Warped& w = results[i];
        const double u1 = s.u1[i], u2 = s.u2[i];
        const auto where = testing::Message() << u1 << " " << u2;

        // Shirley and Chiu.
        const double a = 2 * u1 - 1, b = 2 * u2 - 1;
        double r = 0, phi = 0;
        if (std::abs(a) > std::abs(b)) {
            r = a;
            phi = pi / 4 * b / a;
        } else if (b != 0) {
            r = b;
            phi = pi / 2 - pi / 4 * a / b;
        }
        const double x = r * std::cos(phi), y = r * std::sin(phi);
        ASSERT_NEAR(w.disk[0], x, 2 * ulp * std::abs(r)) << where;
        ASSERT_NEAR(w.disk[1], y, 2 * ulp * std::abs(r)) << where;
        ASSERT_LE(w.disk[0] * w.disk[0] + w.disk[1] * w.disk[1], 1 + 2 * ulp) << where;

        ASSERT_EQ(w.hemisphere[0], w.disk[0]);
        ASSERT_EQ(w.hemisphere[1], w.disk[1]);
        const double z = std::sqrt((1 - r) * (1 + r));
        ASSERT_NEAR(w.hemisphere[2], z, 1.5 * ulp * z) << where;
        ASSERT_NEAR(w.pdf, w.hemisphere[2] / pi, ulp * w.hemisphere[2] / pi);

        const double ring = 2 * std::sqrt(u1 * (1 - u1));
        ASSERT_NEAR(w.sphere[0], ring * std::cos(2 * pi * u2), 2.5 * ulp * ring) << where;
        ASSERT_NEAR(w.sphere[1], ring * std::sin(2 * pi * u2), 2.5 * ulp * ring) << where;
        ASSERT_NEAR(w.sphere[2], 1 - 2 * u1, ulp / 2) << where;
        for (const double* v : {w.hemisphere, w.sphere}) ASSERT_NEAR(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1.0, 5 * ulp) << where;

        // Heitz.
        const double half = std::min(u1, u2) / 2;
        ASSERT_NEAR(w.triangle[0], u2 > u1 ? half : u1 - half, ulp / 4) << where;
        ASSERT_NEAR(w.triangle[1], u2 > u1 ? u2 - half : half, ulp / 4) << where;
        ASSERT_GE(std::min(w.triangle[0], w.triangle[1]), 0) << where;
        ASSERT_LE(w.triangle[0] + w.triangle[1], 1) << where;
    }
}

TEST(Warps, HaveTheSameBitsAtEveryWidth) {
    const Square s = all_points();
    const std::vector<float> wide = raw_warps(s.u1, s.u2, 16);
    EXPECT_EQ(raw_warps(s.u1, s.u2, 8), wide);
    EXPECT_EQ(raw_warps(s.u1, s.u2, 1), wide);
}

// Each density is even in two coordinates of the unit square.
TEST(Warps, HaveTheirDensities) {
    const Square s = random_points(1 << 20);
    const auto results = warp(s.u1, s.u2);
    constexpr int bins = 32;
    const auto turn = [](double y, double x) {
        const double t = std::atan2(y, x) / (2 * pi);
        return t < 0 ? t + 1 : t;
    };
    struct Case {
        const char* name;
        std::function<double(const Warped&)> first, second;
    };
    const std::vector<Case> cases = {
        {"disk", [](const Warped& w) { return w.disk[0] * w.disk[0] + w.disk[1] * w.disk[1]; },
         [&](const Warped& w) { return turn(w.disk[1], w.disk[0]); }},
        {"cosine hemisphere", [](const Warped& w) { return 1 - w.hemisphere[2] * w.hemisphere[2]; },
         [&](const Warped& w) { return turn(w.hemisphere[1], w.hemisphere[0]); }},
        {"sphere", [](const Warped& w) { return (1 + w.sphere[2]) / 2; }, [&](const Warped& w) { return turn(w.sphere[1], w.sphere[0]); }},
        {"triangle", [](const Warped& w) { return std::pow(w.triangle[0] + w.triangle[1], 2.0); },
         [](const Warped& w) {
             const double sum = w.triangle[0] + w.triangle[1];
             return sum > 0 ? w.triangle[0] / sum : 0;
         }}};
    const double threshold = sidak_threshold(1e-3, cases.size());
    for (const Case& c : cases) {
        std::vector<double> counts(bins * bins, 0.0);
        for (const Warped& w : results) {
            const int i = std::min(static_cast<int>(c.first(w) * bins), bins - 1), j = std::min(static_cast<int>(c.second(w) * bins), bins - 1);
            counts[static_cast<std::size_t>(i * bins + j)] += 1;
        }
        const std::vector<double> expected(counts.size(), static_cast<double>(results.size()) / (bins * bins));
        EXPECT_GT(chi_square_test(counts, expected).p_value, threshold) << c.name;
    }
}

// ---- reconstruction filters ------------------------------------------------------------------------------------

using Kind = ReconstructionFilter::Kind;

double filter_value(const ReconstructionFilter& f, double x) {
    const double r = f.radius, s = f.stddev;
    if (std::abs(x) >= r) return 0;
    if (f.kind == Kind::box) return 1;
    if (f.kind == Kind::tent) return 1 - std::abs(x) / r;
    return std::max(0.0, std::exp(-x * x / (2 * s * s)) - std::exp(-r * r / (2 * s * s)));
}

// Distribution function at steps of radius / 2^16 from -radius, by the trapezoidal rule, normalized.
std::vector<double> distribution(const ReconstructionFilter& f) {
    constexpr int steps = 1 << 17;
    const double h = 2.0 * f.radius / steps;
    // Just inside, because the box jumps at its radius.
    const auto value = [&](int i) { return filter_value(f, (-f.radius + i * h) * (1 - 1e-12)); };
    std::vector<double> sums(steps + 1, 0.0);
    for (int i = 0; i < steps; ++i) sums[static_cast<std::size_t>(i + 1)] = sums[static_cast<std::size_t>(i)] + h * (value(i) + value(i + 1)) / 2;
    const double total = sums.back();
    for (double& sum : sums) sum /= total;
    return sums;
}

double distribution_at(const std::vector<double>& sums, double radius, double x) {
    const double position = (x + radius) / (2 * radius) * static_cast<double>(sums.size() - 1);
    const auto cell = static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(sums.size() - 2)));
    return std::lerp(sums[cell], sums[cell + 1], position - static_cast<double>(cell));
}

std::vector<float> draw(const ReconstructionFilter& f, const std::vector<float>& u, int lanes = 16) {
    Probe probe(source, {.lanes = lanes, .defines = ""});
    const std::vector<float> table = build_filter_table(f);
    std::vector<float> x(u.size());
    probe.run("filter", u.size() / static_cast<unsigned>(lanes), table, u, x);
    return x;
}

const std::vector<ReconstructionFilter> filters = {{Kind::box, 0.5F, 0.5F},      {Kind::box, 1.3F, 0.5F},      {Kind::tent, 1.0F, 0.5F},
                                                   {Kind::tent, 2.5F, 0.5F},     {Kind::gaussian, 2.0F, 0.5F}, {Kind::gaussian, 1.0F, 0.25F},
                                                   {Kind::gaussian, 3.2F, 0.8F}};

std::vector<float> unit_interval() {
    std::vector<float> u;
    for (int i = 0; i < 1 << 18; ++i) u.push_back(static_cast<float>(i) * 0x1p-18F);
    u.back() = below_one;
    return u;
}

TEST(Filters, SamplesFollowTheDistributionFunction) {
    const std::vector<float> u = unit_interval();
    for (const ReconstructionFilter& f : filters) {
        const auto sums = distribution(f);
        const std::vector<float> x = draw(f, u);
        for (std::size_t i = 0; i < u.size(); ++i) {
            ASSERT_LE(std::abs(x[i]), f.radius);
            ASSERT_TRUE(i == 0 || x[i] >= x[i - 1]);
            const double error = std::abs(distribution_at(sums, f.radius, x[i]) - u[i]);
            ASSERT_LE(error, 1.5e-6) << "kind " << static_cast<int>(f.kind) << " radius " << f.radius << " u " << u[i];
        }
    }
}

TEST(Filters, BoxIsExact) {
    const std::vector<float> u = unit_interval();
    for (float radius : {0.5F, 1.3F}) {
        const std::vector<float> x = draw({Kind::box, radius, 0.5F}, u);
        for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(x[i], (2.0 * u[i] - 1) * radius, ulp * radius);
    }
}

// The moments that blur the picture.
TEST(Filters, VarianceIsTheFilters) {
    std::vector<float> u;  // midpoints of 2^18 equal shares
    for (int i = 0; i < 1 << 18; ++i) u.push_back((static_cast<float>(i) + 0.5F) * 0x1p-18F);
    for (const ReconstructionFilter& f : filters) {
        double weight = 0, exact = 0, mean = 0, drawn = 0;
        for (int i = 0; i < 100000; ++i) {
            const double x = ((i + 0.5) / 50000 - 1) * f.radius;
            weight += filter_value(f, x);
            exact += filter_value(f, x) * x * x;
        }
        for (float x : draw(f, u)) {
            mean += x / static_cast<double>(u.size());
            drawn += static_cast<double>(x) * x / static_cast<double>(u.size());
        }
        EXPECT_NEAR(mean, 0.0, 1e-7 * f.radius);
        // Interpolating a convex function widens it, by the square of the cells' width.
        constexpr double widening = 4.0 / (FILTER_TABLE_CELLS * FILTER_TABLE_CELLS);
        EXPECT_NEAR(drawn, exact / weight, widening * exact / weight) << static_cast<int>(f.kind);
    }
}

TEST(Filters, TablesRunFromTheRadiusToTheCentre) {
    for (const ReconstructionFilter& f : filters) {
        const std::vector<float> table = build_filter_table(f);
        ASSERT_EQ(table.size(), FILTER_TABLE_CELLS + 1);
        EXPECT_EQ(table.front(), f.radius);
        EXPECT_EQ(table.back(), 0.0F);
        EXPECT_TRUE(std::is_sorted(table.rbegin(), table.rend(), std::less_equal<>()));
    }
}

TEST(Filters, HaveTheSameBitsAtEveryWidth) {
    const std::vector<float> u = unit_interval();
    const std::vector<float> wide = draw(filters[4], u);
    EXPECT_EQ(draw(filters[4], u, 8), wide);
    EXPECT_EQ(draw(filters[4], u, 1), wide);
}

// ---- multiple importance sampling --------------------------------------------------------------------------------

std::vector<float> weights(const std::vector<float>& a, const std::vector<float>& b) {
    Probe probe(source, {.lanes = 16, .defines = ""});
    std::vector<float> out(a.size());
    probe.run("weights", a.size() / 16, a, b, out);
    return out;
}

TEST(PowerHeuristic, IsSafeForDensitiesOfAnySize) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> sizes = {1e-45F, 1e-38F, 1e-30F, 1e-20F, 1e-10F, 0.1F, 0.3F, 1.0F, 3.0F, 1000.0F, 1e10F, 1e19F, 1e20F, 1e30F, 3e38F, 7.0F};
    std::vector<float> a, b;
    for (float x : sizes) {
        for (float y : sizes) {
            a.push_back(x);
            b.push_back(y);
        }
    }
    const std::vector<float> forth = weights(a, b), back = weights(b, a);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double p = static_cast<double>(a[i]) * a[i], q = static_cast<double>(b[i]) * b[i];
        EXPECT_NEAR(forth[i], p / (p + q), 3 * ulp * p / (p + q) + std::numeric_limits<float>::min()) << a[i] << " " << b[i];
        EXPECT_NEAR(static_cast<double>(forth[i]) + back[i], 1.0, 3 * ulp);
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> special_a = {0, 0, infinity, infinity, 1, 1, infinity, 0, 1e-45F, 3e38F, nan, 1, nan, 0, 1, 1};
    const std::vector<float> special_b = {0, 1, 1, infinity, infinity, 0, 0, infinity, infinity, infinity, 1, nan, nan, 2, 1, 1};
    const std::vector<float> expected = {0, 0, 1, 0.5F, 0, 1, 1, 0, 0, 0, nan, nan, nan, 0, 0.5F, 0.5F};
    const std::vector<float> results = weights(special_a, special_b);
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (std::isnan(expected[i])) {
            EXPECT_TRUE(std::isnan(results[i])) << i;
        } else {
            EXPECT_EQ(results[i], expected[i]) << special_a[i] << " " << special_b[i];
        }
    }
}

}  // namespace
}  // namespace wavelobe::test
