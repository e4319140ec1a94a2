#include "cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "cli/format.h"

namespace wavelobe {
namespace {

constexpr double redraw_seconds = 0.1;         // faster than anybody reads
constexpr double shortest_building_seconds = 0.5;
constexpr double line_seconds = 2.0;           // a log gets a line every tenth of the work, no faster than this
constexpr double longest_silence_seconds = 30.0;
constexpr int bar_columns = 30;                // with the text below 80 columns

}  // namespace

std::string progress_text(const Progress& progress) {
    const double share = progress.share;
    std::string text = fmt::format("{:3.0f} %", 100.0 * share);
    if (progress.samples_done == 0 || !(progress.seconds > 0.0)) return text;
    text += fmt::format("  {} samples/s", format_millions(static_cast<double>(progress.samples_done) / progress.seconds));
    if (share > 0.0) text += fmt::format("  {} left", format_clock(progress.seconds * (1.0 - share) / share));
    return text;
}

std::string building_text(double share) { return fmt::format("{:3.0f} %  building the hierarchy", 100.0 * share); }

ProgressDisplay::ProgressDisplay(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressDisplay::update(const Progress& progress) { show(progress.share, progress.seconds, progress_text(progress)); }

void ProgressDisplay::update_building(double share, double seconds) {
    if (seconds >= shortest_building_seconds) show(share, seconds, building_text(share));
}

void ProgressDisplay::show(double share, double seconds, const std::string& text) {
    if (quiet_) return;
    const double elapsed = seconds - last_seconds_;
    if (terminal_) {
        if (drawn_ && elapsed < redraw_seconds) return;
        const int filled = std::clamp(static_cast<int>(share * bar_columns), 0, bar_columns);
        const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                                std::string(static_cast<std::size_t>(bar_columns - filled), ' ');
        std::fprintf(stderr, "\r[%s] %s\033[K", bar.c_str(), text.c_str());
        drawn_ = true;
    } else {
        const bool due = share >= last_share_ + 0.1 && elapsed >= line_seconds;
        if (!due && elapsed < longest_silence_seconds) return;
        std::fprintf(stderr, "%s\n", text.c_str());
    }
    std::fflush(stderr);
    last_seconds_ = seconds;
    last_share_ = share;
}

void ProgressDisplay::finish() {
    if (drawn_) std::fprintf(stderr, "\r\033[K");
    drawn_ = false;
    last_seconds_ = last_share_ = 0.0;
}

}  // namespace wavelobe
