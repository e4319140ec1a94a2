// Refractive indices of named conductors.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace wavelobe {

struct NamedConductor {
    std::string_view name;
    std::array<float, 3> eta;  // linear sRGB
    std::array<float, 3> k;
};

// Null for a name that is not known. "none" (the perfect mirror) is no entry of the table.
const NamedConductor* find_conductor(std::string_view name);

// Every name a scene may use, "none" among them.
std::vector<std::string> conductor_names();

}  // namespace wavelobe
