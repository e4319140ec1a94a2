// Where a value stands in the text of a JSON document.
#pragma once

#include <string_view>
#include <utility>

namespace wavelobe::gltf {

// Line and column, 1-based, of the value that a pointer such as /nodes/3/mesh names, or of the last value on the way to it
// that is there. The text is valid JSON.
std::pair<int, int> place_in_json(std::string_view text, std::string_view pointer);

// Line and column of a byte.
std::pair<int, int> place_in_text(std::string_view text, std::size_t offset);

// Whether arrays and objects lie within each other more than that often; of text that need not be valid.
bool nests_deeper(std::string_view text, int levels);

}  // namespace wavelobe::gltf
