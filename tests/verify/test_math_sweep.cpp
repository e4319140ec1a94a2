// Mathematics over the floats of each function's domain: all of them in the long run, evenly spread ones in the quick run.
#include <bit>
#include <future>
#include <span>
#include <thread>

#include "support/math_reference.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

class MathSweep : public testing::TestWithParam<MathFunction> {};

struct Worst {
    double error = -1.0;
    float x = 0.0F;
};

// Of these results, by all cores: the references are what takes the time.
Worst worst_of(const MathFunction& f, std::span<const float> xs, std::span<const float> results, float y) {
    const std::size_t parts = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::future<Worst>> found;
    for (std::size_t part = 0; part < parts; ++part) {
        found.push_back(std::async(std::launch::async, [=, &f] {
            Worst worst;
            for (std::size_t i = part * xs.size() / parts; i < (part + 1) * xs.size() / parts; ++i) {
                double error = error_in_ulp(results[i], f.reference(xs[i], y), f.overflow);
                if (std::isnan(error)) error = infinity;
                if (error > worst.error) worst = {error, xs[i]};
            }
            return worst;
        }));
    }
    Worst worst;
    for (std::future<Worst>& part_found : found) {
        const Worst part = part_found.get();
        if (part.error > worst.error) worst = part;
    }
    return worst;
}

TEST_P(MathSweep, WorstError) {
    const MathFunction& f = GetParam();
    Probe probe = probe_of(f, 16);
    // A prime step meets every low bit pattern; functions of two arguments share it out over the second.
    const std::uint64_t step = quick_or_full<std::uint64_t>(1009, 1) * f.second_arguments.size();
    Claim claim("Appearance", std::string(f.call) + " over " + (std::isinf(f.limit) ? "all floats" : "its domain"), "ulp");
    constexpr std::size_t batch = std::size_t{1} << 20;
    std::vector<float> xs, results(batch);
    std::uint64_t count = 0;
    for (std::size_t second = 0; second < f.second_arguments.size(); ++second) {
        const float y = f.second_arguments[second];
        std::uint64_t bits = second;
        while (bits < (std::uint64_t{1} << 32)) {
            xs.clear();
            for (; xs.size() < batch && bits < (std::uint64_t{1} << 32); bits += step) {
                const float x = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
                if (!(std::abs(x) > f.limit)) xs.push_back(x);
            }
            const std::size_t n = xs.size();
            if (n == 0) continue;
            xs.resize(batch, 0.0F);
            const std::vector<float>& arguments = xs;
            probe.run("run", batch / 16, arguments, results, y);
            const Worst worst = worst_of(f, std::span(xs).first(n), results, y);
            claim.observe(worst.error, [&] { return "x " + testing::PrintToString(worst.x) + ", y " + testing::PrintToString(y); });
            count += n;
        }
    }
    claim.count(count);
    claim.at_most(f.bound);
}

INSTANTIATE_TEST_SUITE_P(All, MathSweep, testing::ValuesIn(math_functions()), [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace wavelobe::test
