#include "cl/kernel_source.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace wavelobe {
namespace {

std::string_view embedded_text(std::string_view path) {
    for (const KernelFile& file : embedded_kernel_files()) {
        if (file.path == path) return file.text;
    }
    throw std::runtime_error("kernel source includes \"" + std::string(path) + "\", which is not embedded");
}

// The path in `#include "path"`, or an empty view for any other line.
std::string_view included_path(std::string_view line) {
    constexpr std::string_view directive = "#include \"";
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos || line.substr(start, directive.size()) != directive) return {};
    const std::string_view rest = line.substr(start + directive.size());
    return rest.substr(0, rest.find('"'));
}

// The word after `#` of a directive, or an empty view.
std::string_view directive(std::string_view line) {
    if (!line.starts_with('#')) return {};
    return line.substr(1, line.find_first_of(" \t\r\n", 1) - 1);
}

// How many conditions are open, the guard of a header not counted.
class ConditionDepth {
public:
    void read(std::string_view line) {
        const std::string_view word = directive(line);
        if (word.starts_with("if")) {
            if (first_ && line.starts_with("#ifndef WAVELOBE_")) --depth_;
            ++depth_;
            first_ = false;
        } else if (word == "endif") {
            --depth_;
        }
    }
    bool inside() const { return depth_ > 0; }

private:
    int depth_ = 0;
    bool first_ = true;
};

class Flattener {
public:
    std::string text;

    void append(std::string_view source, std::string_view name, bool conditional = false) {
        mark(1, name);
        int line_number = 1;
        ConditionDepth depth;
        while (!source.empty()) {
            const std::size_t end = std::min(source.find('\n'), source.size() - 1);
            const std::string_view line = source.substr(0, end + 1);
            source.remove_prefix(end + 1);
            ++line_number;
            const std::string_view path = included_path(line);
            if (path.empty()) {
                depth.read(line);
                text += line;
                continue;
            }
            // A file that is being expanded is behind its own guard.
            if (!seen_.contains(path) && std::ranges::find(open_, path) == open_.end()) {
                const bool under_condition = conditional || depth.inside();
                if (!under_condition && !path.ends_with(".def")) seen_.emplace(path);
                open_.push_back(path);
                append(embedded_text(path), path, under_condition);
                open_.pop_back();
                if (!text.ends_with('\n')) text += '\n';
            }
            mark(line_number, name);
        }
    }

private:
    void mark(int line, std::string_view name) {
        text += "#line " + std::to_string(line) + " \"" + std::string(name) + "\"\n";
    }

    std::set<std::string, std::less<>> seen_;
    std::vector<std::string_view> open_;
};

}  // namespace

std::string flatten_includes(std::string_view source, std::string_view name) {
    Flattener flattener;
    flattener.append(source, name);
    return std::move(flattener.text);
}

}  // namespace wavelobe
