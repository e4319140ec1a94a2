// $name parameters of scene files.
#include "scene/mitsuba/substitution.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace wavelobe::mitsuba {

namespace {
constexpr std::size_t most_replaced = std::size_t{64} << 20U;  // characters in all of a scene
}

Substitution::Substitution(const Definitions& definitions) {
    for (const auto& [name, value] : definitions) parameters_[name] = {value, false};
}

void Substitution::set_default(const std::string& name, const std::string& value) {
    // A default that nothing uses is no fault, unlike a definition.
    parameters_.try_emplace(name, Parameter{value, true});
}

std::string Substitution::apply(std::string_view text, const std::function<void(const std::string&)>& undefined) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        if (text.substr(i, 2) == "\\$") {
            result += '$';
            i += 2;
        } else if (text[i] == '$') {
            i += 1 + replace(text.substr(i + 1), result, undefined);
        } else {
            result += text[i++];
        }
    }
    return result;
}

std::size_t Substitution::replace(std::string_view rest, std::string& result,
                                  const std::function<void(const std::string&)>& undefined) {
    // The longest name wins, so that $depth does not cut into $depth_max.
    for (std::size_t length = rest.size(); length > 0; --length) {
        const auto found = parameters_.find(rest.substr(0, length));
        if (found == parameters_.end()) continue;
        found->second.used = true;
        replaced_ += found->second.value.size();
        if (replaced_ > most_replaced) throw std::length_error("parameters of a scene");
        result += found->second.value;
        return length;
    }
    const auto is_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    const std::string name(rest.begin(), std::find_if_not(rest.begin(), rest.end(), is_name));
    undefined(name);
    return name.size();
}

std::vector<std::string> Substitution::unused() const {
    std::vector<std::string> names;
    for (const auto& [name, parameter] : parameters_)
        if (!parameter.used) names.push_back(name);
    return names;
}

}  // namespace wavelobe::mitsuba
