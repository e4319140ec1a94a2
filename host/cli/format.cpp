#include "cli/format.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace wavelobe {

std::string format_millions(double count) {
    const double millions = count / 1e6;
    const double magnitude = millions > 0.0 ? std::floor(std::log10(millions)) : 0.0;
    const int decimals = static_cast<int>(std::clamp(2.0 - magnitude, 0.0, 6.0));
    return fmt::format("{:.{}f} M", millions, decimals);
}

std::string format_bytes(std::uint64_t bytes) {
    constexpr std::array units{"B", "KiB", "MiB", "GiB", "TiB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (value >= 1024.0 && unit + 1 < units.size()) {
        value /= 1024.0;
        ++unit;
    }
    return fmt::format("{:.{}f} {}", value, unit == 0 ? 0 : 1, units[unit]);
}

std::string format_count(std::uint64_t count) {
    std::string text = std::to_string(count);
    for (std::size_t place = text.size(); place > 3; place -= 3) text.insert(place - 3, ",");
    return text;
}

std::string format_clock(double seconds) {
    // A rate of nearly nothing gives an endless estimate: shown as 99 hours and more.
    const auto whole = static_cast<int>(std::min(std::ceil(seconds), 99.0 * 3600.0));
    const int hours = whole / 3600;
    const int minutes = whole / 60 % 60;
    if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
    return fmt::format("{}:{:02}", minutes, whole % 60);
}

}  // namespace wavelobe
