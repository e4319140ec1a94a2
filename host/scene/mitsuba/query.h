// Typed look-ups of an object's properties, with the checks that go with them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/mitsuba/context.h"

namespace wavelobe::mitsuba {

struct Range {
    double low = -1e30;
    double high = 1e30;
    bool open_low = false;  // `low` itself is outside
};
constexpr Range positive{0.0, 1e30, true};
constexpr Range not_negative{0.0, 1e30, false};

class Query {
public:
    Query(Context& context, const Object& object);

    bool has(const std::string& name) const;

    // The default when the property is missing or cannot be read; of the wrong type or out of range is a fault.
    double real(const std::string& name, double otherwise, Range range = {});
    std::int64_t integer(const std::string& name, std::int64_t otherwise, std::int64_t low, std::int64_t high);
    bool boolean(const std::string& name, bool otherwise);
    std::string text(const std::string& name, const std::string& otherwise);
    glm::dvec3 triple(const std::string& name, const glm::dvec3& otherwise);
    // One number stands for three.
    glm::dvec3 triple_or_real(const std::string& name);
    glm::dmat4 transform(const std::string& name);
    // The index of one of the choices; case does not matter.
    std::size_t choice(const std::string& name, const std::vector<std::string>& choices, std::size_t otherwise);

    Rgb colour(const std::string& name, double otherwise, ColourUse use);
    Parameter parameter(const std::string& name, double otherwise, ColourUse use);
    // Of a spectrum by its wavelengths, clamped to what the use allows.
    glm::dvec3 sampled_colour(const SampledSpectrum& spectrum, ColourUse use);
    // One number or the scalar reading of a texture.
    Parameter scalar_parameter(const std::string& name, double otherwise, Range range);
    // A number or the name of a dielectric.
    double refractive_index(const std::string& name, const std::string& otherwise);
    // A path of an existing file; empty (with a fault on record) otherwise.
    std::string file(const std::string& name);

    // The nested objects of one tag, named or not.
    std::vector<const Child*> children(const std::string& tag);
    // Some reference leads nowhere; its fault is on record.
    bool has_unresolved_children() const;

    // Known to the plugin, without an effect here.
    void accept(const std::vector<std::string>& names);

    void fault(const std::string& message, const std::string& hint);
    // At the property of that name.
    void fault_at(const std::string& name, const std::string& message, const std::string& hint);
    void warn(const std::string& message);

    // Refuses what nothing has asked for; call it last.
    void finish();

    Context& context() { return context_; }
    const Object& object() const { return object_; }

private:
    const Property* find(const std::string& name);
    const Child* find_child(const std::string& name);
    void wrong_type(const Property& property, const std::string& expected);
    std::optional<Rgb> colour_value(const Property& property, ColourUse use);
    double in_range(const Property& property, double number, double otherwise, const Range& range);

    Context& context_;
    const Object& object_;
    std::vector<std::string> asked_;
    std::vector<const Child*> taken_;
};

// Adds the fault of a type that is not among the supported ones.
void refuse_type(Context& context, const Object& object, const std::vector<std::string>& supported);

// The same, for an object that is not read any further.
void require_type(Context& context, const Object& object, const std::vector<std::string>& known);

// The names of a table of plugins, one line each.
template <typename Table>
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.emplace_back(entry.name);
    return names;
}

// The entry for an object's type; null, with the fault on record, for one that is not supported.
template <typename Table>
auto find_plugin(Context& context, const Object& object, const Table& table) -> decltype(table.data()) {
    if (object.broken) return nullptr;
    for (const auto& entry : table)
        if (object.type == entry.name) return &entry;
    refuse_type(context, object, names_of(table));
    return nullptr;
}

}  // namespace wavelobe::mitsuba
