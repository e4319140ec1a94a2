// The headers of Stanford PLY files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace wavelobe::ply {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

inline constexpr std::array<std::size_t, 8> type_sizes{1, 1, 2, 2, 4, 4, 4, 8};
inline std::size_t size_of(Type type) { return type_sizes[static_cast<std::size_t>(type)]; }

struct Property {
    std::string name;
    Type type = Type::float32;
    bool list = false;
    Type count_type = Type::uint8;
    std::vector<int> targets;  // what it is read for: position, normal and texture coordinates, 0 to 7, and attributes behind them
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding : std::uint8_t { ascii, little, big };

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::size_t body = 0;  // offset of the first byte behind the header
};

// Throws InputError at a line of the file; 0: the line is not known.
[[noreturn]] void refuse(const std::string& path, int line, const std::string& message);

Header read_header(const std::string& path, const std::string& text);

}  // namespace wavelobe::ply
