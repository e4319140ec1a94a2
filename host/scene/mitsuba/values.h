// Numbers, vectors and colours out of attribute text; nothing here depends on the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace wavelobe::mitsuba {

// Tokens between spaces and commas.
std::vector<std::string> split(std::string_view text);

// Nothing for text that is not one finite number, within the range of single precision.
std::optional<double> parse_real(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);
std::optional<bool> parse_boolean(std::string_view text);

// One or three numbers, one standing for all three.
std::optional<glm::dvec3> parse_triple(std::string_view text);

// "r, g, b", "r g b", one number, or "#rrggbb" taken as linear fractions of 255.
std::optional<glm::dvec3> parse_rgb(std::string_view text);

std::string lower_case(std::string_view text);

// `a`, `b`, `c`
std::string quoted_list(const std::vector<std::string>& names);

// "did you mean `x`?" for the closest of the names, empty when none is close.
std::string suggestion(std::string_view wrong, const std::vector<std::string>& names);

// Whether one letter is wrong, missing or too much in one of the names, before its end: what follows one is another version's variant of it.
bool is_misspelled(std::string_view wrong, const std::vector<std::string>& names);

}  // namespace wavelobe::mitsuba
