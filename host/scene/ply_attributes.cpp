#include "scene/ply_attributes.h"

#include <algorithm>
#include <array>

namespace wavelobe::ply {

namespace {

using Columns = std::vector<std::size_t>;

Columns find_columns(const Element& element, const std::array<const char*, 3>& names) {
    Columns columns;
    for (const char* name : names)
        for (std::size_t i = 0; i < element.properties.size(); ++i)
            if (element.properties[i].name == name && !element.properties[i].list) columns.push_back(i);
    return columns.size() == 3 ? columns : Columns{};
}

// Columns one behind the other whose names are the stem, `_` and the ends in turn.
Columns find_run(const Element& element, const std::string& stem, const std::string& ends) {
    const auto& properties = element.properties;
    const auto is = [&](std::size_t i, std::size_t end) {
        return i < properties.size() && !properties[i].list && properties[i].name == stem + "_" + ends[end];
    };
    for (std::size_t first = 0; first < properties.size(); ++first) {
        if (!is(first, 0)) continue;
        Columns columns;
        while (columns.size() < ends.size() && is(first + columns.size(), columns.size())) columns.push_back(first + columns.size());
        return columns.size() == 1 || columns.size() == 3 ? columns : Columns{};
    }
    return {};
}

}  // namespace

std::vector<std::size_t> find_attribute(const Element& element, const std::string& kind, const std::string& name) {
    if (!name.starts_with(kind)) return {};
    const std::string stem = name.substr(kind.size());
    if (stem == "color")
        for (const auto& names : {std::array{"r", "g", "b"}, std::array{"red", "green", "blue"}})
            if (Columns columns = find_columns(element, names); !columns.empty()) return columns;
    for (const char* ends : {"xyzw", "0123", "1234"})
        if (Columns columns = find_run(element, stem, ends); !columns.empty()) return columns;
    const std::string color = "_color";
    if (!stem.ends_with(color)) return {};
    return find_run(element, stem.substr(0, stem.size() - color.size()), "rgba");
}

}  // namespace wavelobe::ply
