// Rows of the accuracy report.
#include "support/verification.h"

#include <fstream>

#include <nlohmann/json.hpp>

namespace wavelobe::test {

namespace {

void write_report_line(const nlohmann::json& line) {
    const char* path = std::getenv("WAVELOBE_VERIFY_ROWS");
    if (path == nullptr) return;
    std::ofstream(path, std::ios::app) << line.dump() << "\n";
}

// JSON knows no infinity.
nlohmann::json number(double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json("infinite"); }

}  // namespace

std::string test_of_claim() {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    return info == nullptr ? "" : std::string(info->test_suite_name()) + "." + info->name();
}

void Claim::report(double bound, bool holds) const {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
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

void write_report_table(const std::string& section, const std::string& title, const std::vector<std::string>& columns,
                        const std::vector<std::vector<ReportCell>>& rows) {
    nlohmann::json lines = nlohmann::json::array();
    for (const std::vector<ReportCell>& row : rows) {
        nlohmann::json line = nlohmann::json::array();
        for (const ReportCell& cell : row) std::visit([&](const auto& value) { line.push_back(value); }, cell);
        lines.push_back(line);
    }
    write_report_line({{"section", section}, {"table", title}, {"columns", columns}, {"rows", lines}});
}

}  // namespace wavelobe::test
