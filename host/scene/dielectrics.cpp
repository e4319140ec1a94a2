// Refractive indices of named dielectrics.
#include "scene/dielectrics.h"

#include <array>

namespace wavelobe {

namespace {

struct NamedDielectric {
    std::string_view name;
    double index;
};

// Hecht, Optics, 4th edition, at 0 to 20 degrees Celsius.
constexpr std::array<NamedDielectric, 23> table{{
    {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.5750},      {"diamond", 2.419},
}};

}  // namespace

std::optional<double> find_dielectric(std::string_view name) {
    for (const NamedDielectric& entry : table)
        if (entry.name == name) return entry.index;
    return std::nullopt;
}

std::vector<std::string> dielectric_names() {
    std::vector<std::string> names;
    for (const NamedDielectric& entry : table) names.emplace_back(entry.name);
    return names;
}

}  // namespace wavelobe
