// The functions of core/math.h with their references in double, domains and stated bounds.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "support/probe.h"

namespace wavelobe::test {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float quiet_nan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float min_normal = std::numeric_limits<float>::min();
inline constexpr double pi_double = std::numbers::pi;

// A function of two arguments (some ignore the second), its reference, and the bound its comment states.
struct MathFunction {
    const char* name;
    const char* call;  // of x and y
    double (*reference)(double x, double y);
    double bound;      // ulp
    float limit;       // domain: |x| <= limit, and NaN
    std::vector<float> second_arguments;
    double overflow = (1 - 0x1p-23) * 0x1p128;  // results of this size may be infinite
};

inline void PrintTo(const MathFunction& function, std::ostream* out) { *out << function.call; }

// Exact: the sine of a multiple of half a turn is zero, which sin(pi * x) is not.
inline double sine_of_turns(double u) {
    const double x = std::remainder(u, 1.0);
    if (std::abs(x) == 0.5) return 0.0;
    return std::abs(x) > 0.25 ? std::sin(2 * pi_double * (std::copysign(0.5, x) - x)) : std::sin(2 * pi_double * x);
}

inline double logarithm(double (*function)(double), double x) { return function(x >= 0.0 && x < min_normal ? 0.0 : x); }

// By Newton's iteration on erfc near one, where erf has no digits left.
inline double inverse_error_function(double x) {
    const double a = std::abs(x);
    if (!(a < 1.0)) return a == 1.0 ? x * infinity : std::numeric_limits<double>::quiet_NaN();
    if (a < 1e-8) return x * std::sqrt(pi_double) / 2;  // the cubic term is below 2^-53
    double y = std::sqrt(-std::log1p(-a * a)) * std::sqrt(pi_double) / 2;
    for (int i = 0; i < 30; ++i) {
        const double error = a < 0.5 ? std::erf(y) - a : (1.0 - a) - std::erfc(y);
        const double step = error * std::sqrt(pi_double) / 2 * std::exp(y * y);
        y -= step;
        if (std::abs(step) < 1e-15 * y) break;
    }
    return std::copysign(y, x);
}

inline double power(double x, double y) {
    if (y == 0.0 || x == 1.0) return 1.0;
    if (x < 0.0) return std::numeric_limits<double>::quiet_NaN();
    return std::pow(std::abs(x) < min_normal ? 0.0 : x, y);
}

inline const std::vector<MathFunction>& math_functions() {
    static const std::vector<MathFunction> list = {
        {"sin", "sine(x)", [](double x, double) { return std::sin(x); }, 1.7, 1e4F, {0}},
        {"cos", "cosine(x)", [](double x, double) { return std::cos(x); }, 1.7, 1e4F, {0}},
        {"sin_turns", "sine_of_turns(x)", [](double x, double) { return sine_of_turns(x); }, 1.7, 4, {0}},
        {"cos_turns", "cosine_of_turns(x)", [](double x, double) { return sine_of_turns(x + 0.25); }, 1.7, 4, {0}},
        {"exp2", "lane_exp2(x)", [](double x, double) { return std::exp2(x); }, 1.1, infinity, {0}},
        {"exp", "lane_exp(x)", [](double x, double) { return std::exp(x); }, 1.1, infinity, {0}},
        {"log2", "lane_log2(x)", [](double x, double) { return logarithm(std::log2, x); }, 1.9, infinity, {0}},
        {"log", "lane_log(x)", [](double x, double) { return logarithm(std::log, x); }, 0.9, infinity, {0}},
        {"asin", "lane_asin(x)", [](double x, double) { return std::asin(x); }, 2.1, infinity, {0}},
        {"acos", "lane_acos(x)", [](double x, double) { return std::acos(x); }, 1.3, infinity, {0}},
        {"erf", "lane_erf(x)", [](double x, double) { return std::erf(x); }, 1.3, infinity, {0}},
        {"erf_inverse", "lane_erf_inverse(x)", [](double x, double) { return inverse_error_function(x); }, 3.5, infinity, {0}},
        {"pow", "lane_pow(x, y)", power, 1.5, infinity,
         {0.0F, -0.0F, 0.5F, 1.0F, 2.0F, 5.0F, 33.3F, 100.0F, 252.0F, 1000.0F, 12345.6F, 1e5F, 1e6F, 1e30F, infinity, -0.7F, -3.7F,
          -1000.0F, -infinity, quiet_nan},
         (1 - 0x1p-18) * 0x1p128},
        {"atan2", "lane_atan2(x, y)", [](double x, double y) { return std::atan2(x, y); }, 1.6, infinity,
         {1.0F, -1.0F, 0.37F, -777.0F, 1e-20F, -1e30F, 0.0F, -0.0F, infinity, -infinity, quiet_nan}},
        // The steep half with the roles exchanged.
        {"atan2_steep", "lane_atan2(y, x)", [](double x, double y) { return std::atan2(y, x); }, 1.6, infinity,
         {1.0F, -0.37F, 0.0F, -0.0F, infinity, -infinity}},
    };
    return list;
}

inline Probe probe_of(const MathFunction& function, int lanes) {
    return Probe(R"(
        #include "core/math.h"
        INLINE Float sine(Float x) { Float s, c; lane_sin_cos(x, &s, &c); return s; }
        INLINE Float cosine(Float x) { Float s, c; lane_sin_cos(x, &s, &c); return c; }
        INLINE Float sine_of_turns(Float x) { Float s, c; lane_sin_cos_turns(x, &s, &c); return s; }
        INLINE Float cosine_of_turns(Float x) { Float s, c; lane_sin_cos_turns(x, &s, &c); return c; }
        kernel void run(global const float *xs, global float *results, float y_of_all) {
            size_t i = get_global_id(0) * LANES;
            Float x = load(xs + i), y = (Float)y_of_all;
            store(results + i, )" +
                     std::string(function.call) + "); }",
                 {.lanes = lanes, .defines = ""});
}

// Error in units in the last place of the reference; infinite where the kind of result differs.
inline double error_in_ulp(float result, double reference, double overflow) {
    constexpr double wrong = std::numeric_limits<double>::infinity();
    if (std::isnan(reference) || std::isnan(result)) return std::isnan(reference) && std::isnan(result) ? 0 : wrong;
    if (std::abs(reference) < min_normal) return std::abs(result) <= min_normal ? 0 : wrong;
    if (std::isinf(result)) return std::abs(reference) >= overflow && (result > 0) == (reference > 0) ? 0 : wrong;
    if (std::abs(reference) > std::numeric_limits<float>::max()) reference = std::copysign(std::numeric_limits<float>::max(), reference);
    return std::abs(result - reference) / std::ldexp(1.0, std::ilogb(reference) - 23);
}

}  // namespace wavelobe::test
