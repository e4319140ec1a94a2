// Mathematics over the floats of each function's domain: all of them in the long run, evenly spread ones in the quick run.
#include <bit>

#include "support/math_reference.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

class MathSweep : public testing::TestWithParam<MathFunction> {};

TEST_P(MathSweep, WorstError) {
    const MathFunction& f = GetParam();
    Probe probe = probe_of(f, 16);
    // A prime step meets every low bit pattern; functions of two arguments share it out over the second.
    const std::uint64_t step = quick_or_full<std::uint64_t>(1009, 1) * f.second_arguments.size();
    Claim claim("Appearance", std::string(f.call) + " over " + (std::isinf(f.limit) ? "all floats" : "its domain"), "ulp");
    constexpr std::size_t batch = std::size_t{1} << 20;
    std::vector<float> xs, results(batch);
    std::uint64_t count = 0;
    double worst = 0.0;
    std::uint64_t bits = 0;
    for (std::size_t second = 0; second < f.second_arguments.size(); ++second) {
        const float y = f.second_arguments[second];
        bits = second;
        while (bits < (std::uint64_t{1} << 32)) {
            xs.clear();
            for (; xs.size() < batch && bits < (std::uint64_t{1} << 32); bits += step) {
                const float x = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
                if (!(std::abs(x) > f.limit)) xs.push_back(x);
            }
            const std::size_t n = xs.size();
            xs.resize(batch, 0.0F);
            const std::vector<float>& arguments = xs;
            probe.run("run", batch / 16, arguments, results, y);
            for (std::size_t i = 0; i < n; ++i) {
                const double error = error_in_ulp(results[i], f.reference(xs[i], y), f.overflow);
                if (error <= worst && count + i > 0) continue;
                worst = error;
                claim.observe(error, [&] { return "x " + testing::PrintToString(xs[i]) + ", y " + testing::PrintToString(y); });
            }
            count += n;
        }
    }
    claim.count(count);
    claim.at_most(f.bound);
}

INSTANTIATE_TEST_SUITE_P(All, MathSweep, testing::ValuesIn(math_functions()), [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace wavelobe::test
