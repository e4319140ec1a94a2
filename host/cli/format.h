// Numbers for people.
#pragma once

#include <cstdint>
#include <string>

namespace wavelobe {

std::string format_millions(double count);             // `41.2 M`, three digits
std::string format_bytes(std::uint64_t bytes);         // `1.5 GiB`
std::string format_count(std::uint64_t count);         // `1,234,567`
std::string format_clock(double seconds);              // `1:02`, `2:00:05`

}  // namespace wavelobe
