#include "scene/gltf/json_place.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace wavelobe::gltf {

namespace {

// Steps over the tokens of valid JSON.
class Scanner {
public:
    Scanner(std::string_view text, std::size_t at) : text_(text), at_(at) { skip_space(); }

    std::size_t at() const { return at_; }
    char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    void step() {
        ++at_;
        skip_space();
    }

    std::string_view text() {
        const std::size_t first = at_ + 1;
        for (++at_; next() != '"' && next() != '\0'; ++at_)
            if (next() == '\\') ++at_;
        const std::string_view out = text_.substr(first, std::min(at_, text_.size()) - first);
        step();
        return out;
    }

    void skip_value() {
        int depth = 0;
        do {
            const char c = next();
            if (c == '"') {
                text();
                continue;
            }
            if (c == '\0') return;
            if (c == '{' || c == '[') ++depth;
            if (c == '}' || c == ']') --depth;
            if (c == '{' || c == '[' || c == '}' || c == ']' || c == ',' || c == ':') {
                step();
                continue;
            }
            while (next() != '\0' && std::string_view(",:]} \t\r\n").find(next()) == std::string_view::npos) ++at_;
            skip_space();
        } while (depth > 0);
    }

private:
    void skip_space() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_;
    }

    std::string_view text_;
    std::size_t at_;
};

// The member of that name, or the item of that number, of the value at `from`.
std::optional<std::size_t> child(std::string_view text, std::size_t from, std::string_view name) {
    Scanner scan(text, from);
    const char open = scan.next();
    if (open != '{' && open != '[') return {};
    std::size_t number = 0;
    if (open == '[' && std::from_chars(name.data(), name.data() + name.size(), number).ec != std::errc()) return {};
    scan.step();
    for (std::size_t i = 0; scan.next() != '}' && scan.next() != ']' && scan.next() != '\0'; ++i) {
        bool found = open == '[' && i == number;
        if (open == '{') {
            found = scan.text() == name;
            scan.step();  // the colon
        }
        if (found) return scan.at();
        scan.skip_value();
        if (scan.next() == ',') scan.step();
    }
    return {};
}

}  // namespace

bool nests_deeper(std::string_view text, int levels) {
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"')
            for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\' ? 1 : 0;
        else if ((c == '{' || c == '[') && ++depth > levels) return true;
        else if (c == '}' || c == ']') --depth;
    }
    return false;
}

std::pair<int, int> place_in_text(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t start = before.rfind('\n');
    const std::size_t column = before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1;
    return {static_cast<int>(line), static_cast<int>(column)};
}

std::pair<int, int> place_in_json(std::string_view text, std::string_view pointer) {
    std::size_t at = Scanner(text, text.starts_with("\xef\xbb\xbf") ? 3 : 0).at();
    while (pointer.starts_with('/')) {
        const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
        const auto next = child(text, at, pointer.substr(1, end - 1));
        if (!next) break;
        at = *next;
        pointer.remove_prefix(end);
    }
    return place_in_text(text, at);
}

}  // namespace wavelobe::gltf
