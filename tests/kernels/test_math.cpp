// Lane mathematics against double precision: errors in units in the last place over the whole domain, special values, and
// the same bits at every width.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/math_reference.h"

namespace wavelobe::test {
namespace {

// Floats spread evenly over all bit patterns (each binade, both signs, infinities and NaN), those of the domain spread
// evenly over [0, 2], where most arguments lie, and the neighbours of every special value.
std::vector<float> arguments(const MathFunction& function) {
    std::vector<float> xs;
    const auto add = [&](float x) {
        if (!(std::abs(x) > function.limit)) xs.push_back(x);
    };
    for (std::uint64_t bits = 0; bits < (std::uint64_t{1} << 32); bits += 2503) add(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    for (int i = -300000; i < 300000; ++i) add(static_cast<float>(i) * 0x1.6p-18F);
    for (float x : {0.0F, 0.25F, 0.5F, 0.75F, 1.0F, 1.5F, 2.0F, 3.0F, 4.0F, 126.0F, 127.5F, 128.0F, 87.3365F, 88.7228F, 1e4F, 1.5707963F,
                    3.1415927F, 6.2831853F, 0.70710678F, 1.4142135F, 0.9966F, 0.99999994F, 2.2360680F, min_normal, 1e-45F,
                    std::numeric_limits<float>::max()}) {
        for (float sign : {1.0F, -1.0F}) {
            float below = x, above = x;
            add(sign * x);
            for (int i = 0; i < 20; ++i) {
                below = std::nextafter(below, -infinity);
                above = std::nextafter(above, infinity);
                add(sign * below);
                add(sign * above);
            }
        }
    }
    for (float x : {infinity, -infinity, quiet_nan, -quiet_nan}) add(x);
    xs.resize((xs.size() + 15) / 16 * 16, 0.0F);
    return xs;
}

class Math : public testing::TestWithParam<MathFunction> {};

TEST_P(Math, IsWithinItsBoundEverywhere) {
    const MathFunction& f = GetParam();
    Probe probe = probe_of(f, 16);
    const std::vector<float> xs = arguments(f);
    ASSERT_GE(xs.size(), 1000000u);
    std::vector<float> results(xs.size());
    double worst = 0;
    for (float y : f.second_arguments) {
        probe.run("run", xs.size() / 16, xs, results, y);
        for (std::size_t i = 0; i < xs.size(); ++i) {
            const double reference = f.reference(xs[i], y);
            const double error = error_in_ulp(results[i], reference, f.overflow);
            worst = std::max(worst, error);
            ASSERT_LE(error, f.bound) << f.name << " x " << std::hexfloat << xs[i] << " y " << y << ": " << results[i]
                                      << " instead of " << reference;
        }
    }
    RecordProperty("worst_ulp", std::to_string(worst));
}

TEST_P(Math, HasTheSameBitsAtEveryWidth) {
    const MathFunction& f = GetParam();
    const std::vector<float> xs = arguments(f);
    std::vector<float> expected(xs.size()), results(xs.size());
    Probe wide = probe_of(f, 16), half = probe_of(f, 8), single = probe_of(f, 1);
    const float y = f.second_arguments[f.second_arguments.size() > 2 ? 2 : 0];
    wide.run("run", xs.size() / 16, xs, expected, y);
    for (auto [probe, lanes] : {std::pair{&half, 8u}, std::pair{&single, 1u}}) {
        probe->run("run", xs.size() / lanes, xs, results, y);
        for (std::size_t i = 0; i < xs.size(); ++i) {
            // Which NaN it is may differ.
            if (std::isnan(expected[i]) && std::isnan(results[i])) continue;
            ASSERT_EQ(std::bit_cast<std::uint32_t>(results[i]), std::bit_cast<std::uint32_t>(expected[i]))
                << f.name << " x " << std::hexfloat << xs[i] << ", " << lanes << " lanes";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Math, testing::ValuesIn(math_functions()), [](const auto& tested) { return tested.param.name; });

// Functions of one argument at sixteen places.
std::vector<float> evaluate(const char* call, std::vector<float> xs, float y = 0) {
    const std::size_t count = xs.size();
    xs.resize(16, 0.0F);
    const std::vector<float> padded = xs;
    std::vector<float> results(16);
    probe_of({"", call, nullptr, 0, 0, {}}, 16).run("run", 1, padded, results, y);
    results.resize(count);
    return results;
}

bool same(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

TEST(MathExact, QuartersOfTurns) {
    const std::vector<float> turns = {-1.0F, -0.75F, -0.5F, -0.25F, 0.0F, 0.25F, 0.5F, 0.75F, 1.0F, 3.25F};
    const std::vector<float> sines = {0, 1, 0, -1, 0, 1, 0, -1, 0, 1}, cosines = {1, 0, -1, 0, 1, 0, -1, 0, 1, 0};
    EXPECT_EQ(evaluate("sine_of_turns(x)", turns), sines);
    EXPECT_EQ(evaluate("cosine_of_turns(x)", turns), cosines);
}

TEST(MathExact, PowersOfTwo) {
    const std::vector<float> exponents = {-126, -100, -1, 0, 1, 10, 100, 127}, powers = {0x1p-126F, 0x1p-100F, 0.5F, 1, 2, 1024, 0x1p100F, 0x1p127F};
    EXPECT_EQ(evaluate("lane_exp2(x)", exponents), powers);
    EXPECT_EQ(evaluate("lane_log2(x)", powers), exponents);
}

TEST(MathExact, SignsOfZeroAreKept) {
    for (const char* call : {"lane_asin(x)", "lane_erf(x)", "lane_erf_inverse(x)"}) {
        const std::vector<float> results = evaluate(call, {0.0F, -0.0F});
        EXPECT_TRUE(same(results[0], 0.0F) && same(results[1], -0.0F)) << call;
    }
}

TEST(MathExact, AngleFollowsSignsOfZero) {
    const float zero = 0.0F;
    for (float x : {zero, -zero, 1.0F, -1.0F, infinity, -infinity}) {
        const std::vector<float> ys = {zero, -zero};
        const std::vector<float> results = evaluate("lane_atan2(x, y)", ys, x);
        for (std::size_t i = 0; i < ys.size(); ++i) EXPECT_TRUE(same(results[i], std::atan2(ys[i], x))) << ys[i] << " " << x;
    }
}

TEST(MathExact, PhongLobeAtTheEnds) {
    const std::vector<float> bases = {0.0F, 1.0F, 0.5F};
    EXPECT_EQ(evaluate("lane_pow(x, y)", bases, 0.0F), (std::vector<float>{1, 1, 1}));
    EXPECT_EQ(evaluate("lane_pow(x, y)", bases, 1e6F), (std::vector<float>{0, 1, 0}));
    EXPECT_EQ(evaluate("lane_pow(x, y)", bases, 1.0F), (std::vector<float>{0, 1, 0.5F}));
}

TEST(MathExact, NamedConstants) {
    Probe probe(R"(
        #include "core/math.h"
        kernel void run(global float *r) {
            r[0] = PI_F; r[1] = TWO_PI_F; r[2] = FOUR_PI_F; r[3] = HALF_PI_F; r[4] = QUARTER_PI_F; r[5] = INV_PI;
            r[6] = INV_TWO_PI_F; r[7] = INV_FOUR_PI_F; r[8] = SQRT_PI_F; r[9] = INV_SQRT_PI_F; r[10] = SQRT_TWO_F;
            r[11] = LN_TWO_F; r[12] = HALF_PI_REST_F; r[13] = LOG2_E_F; r[14] = LOG2_E_REST_F;
        })");
    std::vector<float> results(15);
    probe.run("run", 1, results);
    const double expected[] = {pi_double, 2 * pi_double, 4 * pi_double, pi_double / 2, pi_double / 4, 1 / pi_double, 0.5 / pi_double, 0.25 / pi_double, std::sqrt(pi_double), 1 / std::sqrt(pi_double),
                               std::numbers::sqrt2, std::numbers::ln2, pi_double / 2 - static_cast<float>(pi_double / 2), std::numbers::log2e,
                               std::numbers::log2e - static_cast<float>(std::numbers::log2e)};
    for (std::size_t i = 0; i < results.size(); ++i) EXPECT_EQ(results[i], static_cast<float>(expected[i])) << i;
}

}  // namespace
}  // namespace wavelobe::test
