// Claims about the renderer: a measured figure, the bound it is held to, and how it was come by.
//
//     Claim claim("Appearance", "Fresnel reflectance of a dielectric", "ulp");
//     for (...) claim.observe(error, [&] { return "eta " + ...; });
//     claim.at_most(8.0);
//
// A claim is an expectation of its test. With WAVELOBE_VERIFY_ROWS=FILE it is also a row of the accuracy report: a line
// of JSON appended to that file. WAVELOBE_VERIFY=full makes the long run.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace wavelobe::test {

inline bool verify_fully() {
    const char* mode = std::getenv("WAVELOBE_VERIFY");
    return mode != nullptr && std::string(mode) == "full";
}

// A number of samples, or whatever else makes a run long.
template <class T>
T quick_or_full(T quick, T full) {
    return verify_fully() ? full : quick;
}

// The name of the running test.
std::string test_of_claim();

class Claim {
public:
    Claim(std::string section, std::string text, std::string unit)
        : section_(std::move(section)), text_(std::move(text)), unit_(std::move(unit)) {}

    // One measurement; the greatest is the claim's. What is not a number counts as infinite. `where` is called only for
    // those that become the worst case.
    template <class Where>
    void observe(double value, const Where& where) {
        ++samples_;
        if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
        if (samples_ > 1 && !(value > worst_)) return;
        worst_ = value;
        where_ = where();
    }
    void observe(double value) {
        observe(value, [] { return std::string(); });
    }

    // Samples behind the measurement, where they are more than the calls of `observe`.
    void count(std::uint64_t samples) { samples_ = samples; }

    double worst() const { return worst_; }
    const std::string& where() const { return where_; }

    void at_most(double bound) const {
        report(bound, worst_ <= bound);
        EXPECT_LE(worst_, bound) << text_ << " (" << unit_ << "): " << where_;
        EXPECT_GT(samples_, 0U) << text_ << ": nothing was measured";
    }

private:
    void report(double bound, bool holds) const;

    std::string section_, text_, unit_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double worst_ = 0.0;
    std::string where_;
    std::uint64_t samples_ = 0;
};

// A table of the report.
using ReportCell = std::variant<int, double, std::string>;
void write_report_table(const std::string& section, const std::string& title, const std::vector<std::string>& columns,
                        const std::vector<std::vector<ReportCell>>& rows);

}  // namespace wavelobe::test
