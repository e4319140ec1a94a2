// Refractive indices of named dielectrics.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wavelobe {

// At about 589 nm. Names are in lower case.
std::optional<double> find_dielectric(std::string_view name);
std::vector<std::string> dielectric_names();

}  // namespace wavelobe
