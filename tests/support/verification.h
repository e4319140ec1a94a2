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
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

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

inline void write_report_line(const nlohmann::json& line) {
    const char* path = std::getenv("WAVELOBE_VERIFY_ROWS");
    if (path == nullptr) return;
    std::ofstream(path, std::ios::app) << line.dump() << "\n";
}

inline std::string test_of_claim() {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    return info == nullptr ? "" : std::string(info->test_suite_name()) + "." + info->name();
}

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
    void report(double bound, bool holds) const {
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        // JSON knows no infinity.
        const auto number = [](double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json("infinite"); };
        write_report_line({{"section", section_},
                           {"claim", text_},
                           {"unit", unit_},
                           {"measured", number(worst_)},
                           {"bound", number(bound)},
                           {"samples", samples_},
                           {"seconds", seconds},
                           {"worst", where_},
                           {"holds", holds && samples_ > 0},
                           {"test", test_of_claim()}});
    }

    std::string section_, text_, unit_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double worst_ = 0.0;
    std::string where_;
    std::uint64_t samples_ = 0;
};

// A table of the report; cells are numbers or text.
inline void write_report_table(const std::string& section, const std::string& title,
                               const std::vector<std::string>& columns, const std::vector<std::vector<nlohmann::json>>& rows) {
    write_report_line({{"section", section}, {"table", title}, {"columns", columns}, {"rows", rows}});
}

}  // namespace wavelobe::test
