// Numbers, vectors and colours out of attribute text; nothing here depends on the locale.
#include "scene/mitsuba/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace wavelobe::mitsuba {

namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// from_chars refuses the leading plus sign that scene files may carry.
std::string_view without_plus(std::string_view text) {
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
    return plus ? text.substr(1) : text;
}

template <typename Number>
std::optional<Number> parse_whole(std::string_view text) {
    text = without_plus(trimmed(text));
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<glm::dvec3> parse_hexadecimal(std::string_view text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    unsigned bits = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, bits, 16);
    if (error != std::errc{} || end != text.data() + 7) return std::nullopt;
    return glm::dvec3((bits >> 16U) & 255U, (bits >> 8U) & 255U, bits & 255U) / 255.0;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i] == b[j] ? 0U : 1U);
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

// Case and separators are what people get wrong most: `toWorld`, `to-world`.
std::string plain_letters(std::string_view text) {
    std::string plain;
    for (const char c : lower_case(text))
        if (c != '_' && c != '-') plain += c;
    return plain;
}

}  // namespace

std::vector<std::string> split(std::string_view text) {
    constexpr std::string_view separators = " ,\t\r\n";
    std::vector<std::string> tokens;
    std::size_t begin = text.find_first_not_of(separators);
    while (begin != std::string_view::npos) {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        tokens.emplace_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(separators, end);
    }
    return tokens;
}

std::optional<double> parse_real(std::string_view text) {
    const auto number = parse_whole<double>(text);
    return number && std::abs(*number) <= static_cast<double>(std::numeric_limits<float>::max()) ? number : std::nullopt;
}

std::optional<std::int64_t> parse_integer(std::string_view text) { return parse_whole<std::int64_t>(text); }

std::optional<bool> parse_boolean(std::string_view text) {
    const std::string lower = lower_case(trimmed(text));
    if (lower == "true") return true;
    if (lower == "false") return false;
    return std::nullopt;
}

std::optional<glm::dvec3> parse_triple(std::string_view text) {
    const std::vector<std::string> tokens = split(text);
    if (tokens.size() != 1 && tokens.size() != 3) return std::nullopt;
    glm::dvec3 triple(0.0);
    for (int i = 0; i < 3; ++i) {
        const auto number = parse_real(tokens[tokens.size() == 1 ? 0 : static_cast<std::size_t>(i)]);
        if (!number) return std::nullopt;
        triple[i] = *number;
    }
    return triple;
}

std::optional<glm::dvec3> parse_rgb(std::string_view text) {
    const std::string_view one = trimmed(text);
    return one.starts_with('#') ? parse_hexadecimal(one) : parse_triple(one);
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return lower;
}

std::string quoted_list(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "`" : ", `") + name + "`";
    return list;
}

std::string suggestion(std::string_view wrong, const std::vector<std::string>& names) {
    if (wrong.size() > 100 || names.size() > 2000) return {};  // each name is compared letter by letter
    const std::string plain = plain_letters(wrong);
    const std::string* best = nullptr;
    std::size_t best_distance = std::max<std::size_t>(2, plain.size() / 3) + 1;
    for (const std::string& name : names) {
        const std::size_t distance = edit_distance(plain, plain_letters(name));
        if (distance < best_distance && distance < name.size()) {
            best = &name;
            best_distance = distance;
        }
    }
    return best == nullptr ? std::string() : "did you mean `" + *best + "`?";
}

bool is_misspelled(std::string_view wrong, const std::vector<std::string>& names) {
    const std::string plain = plain_letters(wrong);
    return plain.size() >= 5 && plain.size() <= 100 && std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        const std::string right = plain_letters(name);
        return !plain.starts_with(right) && !right.starts_with(plain) && edit_distance(plain, right) == 1;
    });
}

}  // namespace wavelobe::mitsuba
