// What this version reads, for messages and documentation.
#pragma once

#include <string>
#include <vector>

namespace wavelobe {

struct SupportedPlugins {
    std::string kind;  // such as `bsdf`
    std::vector<std::string> types;
};

std::vector<SupportedPlugins> supported_plugins();

}  // namespace wavelobe
