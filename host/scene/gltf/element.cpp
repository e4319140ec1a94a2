#include "scene/gltf/element.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "scene/gltf/json_place.h"

namespace wavelobe::gltf {

namespace {

constexpr std::size_t most_faults = 100;

// A whole number, also when it is written as 3.0.
std::optional<std::int64_t> whole_value(const Json& value) {
    if (value.is_number_unsigned()) {
        const auto number = value.get<std::uint64_t>();
        if (number > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
        return static_cast<std::int64_t>(number);
    }
    if (value.is_number_integer()) return value.get<std::int64_t>();
    if (!value.is_number_float()) return {};
    const double number = value.get<double>();
    if (std::floor(number) != number || std::abs(number) > 9.0e15) return {};
    return static_cast<std::int64_t>(number);
}

std::string item(const std::string& path, std::size_t i) { return path + "/" + std::to_string(i); }

}  // namespace

void Faults::add(Fault fault) {
    if (!known_.insert(fault.text()).second) return;
    if (list_.size() == most_faults) ++left_out_;
    else list_.push_back(std::move(fault));
}

void Faults::add(const std::string& path, std::string message, std::string hint) {
    add(Fault{file_, 0, 0, path, std::move(message), std::move(hint)});
}

void Faults::add(const InputError& error, const std::string& path) {
    for (Fault fault : error.faults()) {
        fault.hint += (fault.hint.empty() ? "" : "; ") + ("used at " + file_ + ": " + path);
        add(std::move(fault));
    }
}

void Faults::raise() const {
    std::vector<Fault> list = list_;
    for (Fault& fault : list)
        if (!text_.empty() && fault.file == file_ && fault.line == 0) std::tie(fault.line, fault.column) = place_in_json(text_, fault.element);
    if (left_out_ > 0) list.push_back(Fault{file_, 0, 0, "", fmt::format("and {} more faults", left_out_), ""});
    throw InputError(std::move(list));
}

std::string describe(const Json& value) {
    switch (value.type()) {
        case Json::value_t::object: return "an object";
        case Json::value_t::array: return fmt::format("an array of {}", value.size());
        case Json::value_t::string: return fmt::format("the text \"{:.60}\"", value.get_ref<const std::string&>());
        case Json::value_t::boolean: return value.get<bool>() ? "true" : "false";
        case Json::value_t::null: return "null";
        default: return value.dump();
    }
}

const Json* Element::find(const char* name) const {
    if (value_ == nullptr || !value_->is_object()) return nullptr;
    const auto found = value_->find(name);
    return found == value_->end() ? nullptr : &*found;
}

const Json* Element::array(const char* name) const {
    const Json* value = find(name);
    if (value == nullptr || value->is_array()) return value;
    faults_->add(child(name), "is " + describe(*value) + "; expected an array");
    return nullptr;
}

Element Element::object(const char* name) const {
    const Json* value = find(name);
    if (value != nullptr && !value->is_object()) {
        faults_->add(child(name), "is " + describe(*value) + "; expected an object");
        value = nullptr;
    }
    return {value, child(name), faults_};
}

std::vector<Element> Element::objects(const char* name) const {
    std::vector<Element> out;
    const Json* list = array(name);
    if (list == nullptr) return out;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const Json* value = &(*list)[i];
        if (!value->is_object()) {
            faults_->add(item(child(name), i), "is " + describe(*value) + "; expected an object");
            value = nullptr;
        }
        out.emplace_back(value, item(child(name), i), faults_);
    }
    return out;
}

std::vector<double> Element::numbers(const char* name) const {
    std::vector<double> out;
    const Json* list = array(name);
    if (list == nullptr) return out;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const Json& value = (*list)[i];
        if (!value.is_number()) faults_->add(item(child(name), i), "is " + describe(value) + "; expected a number");
        out.push_back(value.is_number() ? value.get<double>() : 0.0);
    }
    return out;
}

std::vector<std::int64_t> Element::whole_numbers(const char* name) const {
    std::vector<std::int64_t> out;
    const Json* list = array(name);
    if (list == nullptr) return out;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const auto value = whole_value((*list)[i]);
        if (!value) faults_->add(item(child(name), i), "is " + describe((*list)[i]) + "; expected a whole number");
        out.push_back(value.value_or(-1));
    }
    return out;
}

std::vector<std::string> Element::texts(const char* name) const {
    std::vector<std::string> out;
    const Json* list = array(name);
    if (list == nullptr) return out;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const Json& value = (*list)[i];
        if (value.is_string()) out.push_back(value.get<std::string>());
        else faults_->add(item(child(name), i), "is " + describe(value) + "; expected a text");
    }
    return out;
}

std::optional<double> Element::number(const char* name) const {
    const Json* value = find(name);
    if (value == nullptr) return {};
    if (value->is_number()) return value->get<double>();
    faults_->add(child(name), "is " + describe(*value) + "; expected a number");
    return {};
}

double Element::number(const char* name, double fallback, NumberRange range) const {
    const auto value = number(name);
    if (!value) return fallback;
    if (*value >= range.least && *value <= range.greatest) return *value;
    faults_->add(child(name), fmt::format("is {}; expected a number from {} to {}", *value, range.least, range.greatest));
    return fallback;
}

std::int64_t Element::whole(const char* name, std::int64_t fallback, std::int64_t least, std::int64_t greatest) const {
    const Json* value = find(name);
    if (value == nullptr) return fallback;
    const auto number = whole_value(*value);
    if (number && *number >= least && *number <= greatest) return *number;
    faults_->add(child(name), fmt::format("is {}; expected a whole number from {} to {}", describe(*value), least, greatest));
    return fallback;
}

bool Element::flag(const char* name, bool fallback) const {
    const Json* value = find(name);
    if (value == nullptr) return fallback;
    if (value->is_boolean()) return value->get<bool>();
    faults_->add(child(name), "is " + describe(*value) + "; expected true or false");
    return fallback;
}

std::string Element::text(const char* name, const std::string& fallback) const {
    const Json* value = find(name);
    if (value == nullptr) return fallback;
    if (value->is_string()) return value->get<std::string>();
    faults_->add(child(name), "is " + describe(*value) + "; expected a text");
    return fallback;
}

std::optional<std::size_t> Element::index(const char* name, std::size_t count, const char* what) const {
    const Json* value = find(name);
    if (value == nullptr) return {};
    const auto number = whole_value(*value);
    if (number && *number >= 0 && static_cast<std::uint64_t>(*number) < count) return static_cast<std::size_t>(*number);
    faults_->add(child(name), fmt::format("is {}; the file has {} {}", describe(*value), count, what),
                 count > 0 ? fmt::format("expected a whole number below {}", count) : "");
    return {};
}

std::vector<std::size_t> Element::indices(const char* name, std::size_t count, const char* what) const {
    std::vector<std::size_t> out;
    const std::vector<std::int64_t> values = whole_numbers(name);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] >= 0 && static_cast<std::uint64_t>(values[i]) < count) {
            out.push_back(static_cast<std::size_t>(values[i]));
        } else {
            faults_->add(item(child(name), i), fmt::format("is {}; the file has {} {}", values[i], count, what));
        }
    }
    return out;
}

void Element::require(const char* name) const {
    if (present() && !has(name)) fault(std::string("has no `") + name + "`, which it must have");
}

void Element::refuse_empty(const char* list) const {
    const Json* value = find(list);
    if (value != nullptr && value->is_array() && value->empty()) faults_->add(child(list), "is an empty array; expected one item at least");
}

bool Element::check_vector(const char* name, const std::vector<double>& values, std::size_t length, NumberRange range) const {
    if (values.size() != length) {
        faults_->add(child(name), fmt::format("has {} numbers; expected {}", values.size(), length));
        return false;
    }
    bool valid = true;
    for (std::size_t i = 0; i < length; ++i) {
        const bool finite = std::isfinite(static_cast<float>(values[i]));
        if (finite && values[i] >= range.least && values[i] <= range.greatest) continue;
        faults_->add(item(child(name), i),
                     fmt::format("is {}; expected a number from {} to {}", values[i], range.least, range.greatest));
        valid = false;
    }
    return valid;
}

std::vector<std::string> Element::keys() const {
    std::vector<std::string> out;
    if (value_ == nullptr) return out;
    for (const auto& [key, value] : value_->items()) out.push_back(key);
    return out;
}

}  // namespace wavelobe::gltf
