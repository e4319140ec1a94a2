// Single XML elements: their attributes, and the properties they state.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/mitsuba/document.h"

namespace wavelobe::mitsuba {

// An element with every `$name` of its attributes replaced.
struct Element {
    std::string tag;
    std::vector<std::pair<std::string, std::string>> attributes;
    Place place;
    bool broken = false;  // a substitution failed; the fault is on record

    // Null when the attribute is not there.
    const std::string* attribute(const std::string& name) const;
    std::string text(const std::string& name) const;
    std::string label() const;  // `<float name="fov">`
};

// Records missing and unexpected attributes; false when there are any.
bool check_attributes(const Element& element, const std::vector<std::string>& required,
                      const std::vector<std::string>& optional, Faults& faults);

bool is_property_tag(const std::string& tag);
bool is_object_tag(const std::string& tag);
bool is_transform_operation(const std::string& tag);
std::vector<std::string> known_tags();

// The value of a property element; `operations` are the children of a <transform>.
Value parse_property(const Element& element, const std::vector<Element>& operations, Faults& faults);

}  // namespace wavelobe::mitsuba
