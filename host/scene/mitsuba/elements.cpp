// Single XML elements: their attributes, and the properties they state.
#include "scene/mitsuba/elements.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/mitsuba/transforms.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

using Names = std::vector<std::string>;

// `blackbody` and `subsurface` are of Mitsuba 0.x.
const Names property_tags{"float", "integer", "boolean",  "string",    "point",
                          "vector", "rgb",    "spectrum", "transform", "blackbody"};
const Names object_tags{"scene",   "bsdf",    "shape",   "emitter", "sensor", "integrator", "film",
                        "sampler", "rfilter", "texture", "medium",  "phase",  "volume",     "subsurface"};
const Names operation_tags{"translate", "rotate", "scale", "lookat", "matrix"};
const Names other_tags{"default", "ref", "include", "alias", "path"};

bool contains(const Names& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

Value refuse(const Element& element, Faults& faults, const std::string& message, const std::string& expected) {
    faults.add(element.place, element.label(), message, expected);
    return Unreadable{};
}

Value refuse_value(const Element& element, Faults& faults, const std::string& expected) {
    return refuse(element, faults, "cannot read the value `" + element.text("value") + "`; expected " + expected,
                  "");
}

// x, y and z, or `value` for all of them; a component that is left out takes `missing`.
std::optional<glm::dvec3> parse_xyz(const Element& element, double missing, Faults& faults) {
    constexpr std::array<const char*, 3> axes{"x", "y", "z"};
    if (const std::string* value = element.attribute("value")) {
        const bool mixed =
            std::any_of(axes.begin(), axes.end(), [&](const char* axis) { return element.attribute(axis); });
        if (mixed) {
            refuse(element, faults, "`value` cannot be combined with `x`, `y` and `z`",
                   "keep one of the two forms");
            return std::nullopt;
        }
        const auto triple = parse_triple(*value);
        if (!triple) refuse_value(element, faults, "one or three finite numbers");
        return triple;
    }
    glm::dvec3 triple(missing);
    for (int i = 0; i < 3; ++i) {
        const std::string* text = element.attribute(axes[static_cast<std::size_t>(i)]);
        if (text == nullptr) continue;
        const auto number = parse_real(*text);
        if (!number) {
            refuse(element, faults,
                   "cannot read `" + *text + "` for `" + axes[static_cast<std::size_t>(i)] +
                       "`; expected a finite number",
                   "");
            return std::nullopt;
        }
        triple[i] = *number;
    }
    return triple;
}

std::optional<glm::dmat4> parse_rotate(const Element& element, Faults& faults) {
    if (!check_attributes(element, {"angle"}, {"x", "y", "z", "value"}, faults)) return std::nullopt;
    const auto axis = parse_xyz(element, 0.0, faults);
    if (!axis) return std::nullopt;
    if (*axis == glm::dvec3(0.0)) {
        refuse(element, faults, "the rotation axis is zero", "set one of `x`, `y` and `z`");
        return std::nullopt;
    }
    const auto angle = parse_real(element.text("angle"));
    if (!angle) {
        refuse(element, faults,
               "cannot read the angle `" + element.text("angle") + "`; expected degrees as a finite number", "");
        return std::nullopt;
    }
    return rotation(*axis, *angle);
}

std::optional<glm::dmat4> parse_look_at(const Element& element, Faults& faults) {
    if (!check_attributes(element, {"origin", "target"}, {"up"}, faults)) return std::nullopt;
    std::array<glm::dvec3, 3> points{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};
    constexpr std::array<const char*, 3> names{"origin", "target", "up"};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string text = element.text(names[i]);
        if (i == 2 && text.empty()) continue;
        const auto point = split(text).size() == 3 ? parse_triple(text) : std::nullopt;
        if (!point) {
            refuse(element, faults,
                   "cannot read `" + text + "` for `" + names[i] + "`; expected three finite numbers", "");
            return std::nullopt;
        }
        points[i] = *point;
    }
    const auto matrix = look_at(points[0], points[1], points[2]);
    if (!matrix)
        refuse(element, faults, "the view direction is zero or parallel to `up`",
               "choose a target apart from the origin and another `up`");
    return matrix;
}

std::optional<glm::dmat4> parse_matrix(const Element& element, Faults& faults) {
    if (!check_attributes(element, {"value"}, {}, faults)) return std::nullopt;
    const Names tokens = split(element.text("value"));
    const int size = tokens.size() == 16 ? 4 : 3;
    if (tokens.size() != 16 && tokens.size() != 9) {
        refuse(element, faults, "a matrix has 9 or 16 values, found " + std::to_string(tokens.size()), "");
        return std::nullopt;
    }
    glm::dmat4 matrix(1.0);
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const std::string& token = tokens[static_cast<std::size_t>(row * size + column)];
            const auto number = parse_real(token);
            if (!number) {
                refuse(element, faults, "cannot read the matrix value `" + token + "`; expected a finite number",
                       "");
                return std::nullopt;
            }
            matrix[column][row] = *number;
        }
    return matrix;
}

std::optional<glm::dmat4> parse_operation(const Element& element, Faults& faults) {
    if (element.broken) return std::nullopt;
    if (element.tag == "rotate") return parse_rotate(element, faults);
    if (element.tag == "lookat") return parse_look_at(element, faults);
    if (element.tag == "matrix") return parse_matrix(element, faults);
    if (element.tag == "translate" || element.tag == "scale") {
        if (!check_attributes(element, {}, {"x", "y", "z", "value"}, faults)) return std::nullopt;
        const bool translate = element.tag == "translate";
        const auto triple = parse_xyz(element, translate ? 0.0 : 1.0, faults);
        if (!triple) return std::nullopt;
        return translate ? translation(*triple) : scaling(*triple);
    }
    refuse(element, faults, "not an operation of a <transform>; expected one of " + quoted_list(operation_tags),
           suggestion(element.tag, operation_tags));
    return std::nullopt;
}

// Later operations apply to what the earlier ones produced.
Value parse_transform(const std::vector<Element>& operations, Faults& faults) {
    glm::dmat4 matrix(1.0);
    bool complete = true;
    for (const Element& operation : operations) {
        const auto step = parse_operation(operation, faults);
        complete = complete && step.has_value();
        if (step) matrix = *step * matrix;
    }
    if (!complete) return Unreadable{};
    return matrix;
}

// One number, or pairs of wavelength and value.
Value parse_spectrum(const Element& element, Faults& faults) {
    if (!check_attributes(element, {"name", "value"}, {}, faults)) return Unreadable{};
    const std::string text = element.text("value");
    if (text.find(':') == std::string::npos) {
        const auto number = parse_real(text);
        if (!number) return refuse_value(element, faults, "one finite number, or pairs wavelength:value");
        return UniformSpectrum{*number};
    }
    SampledSpectrum spectrum;
    for (const std::string& token : split(text)) {
        const std::size_t colon = token.find(':');
        const auto wavelength = parse_real(token.substr(0, colon));
        const auto value = colon == std::string::npos ? std::nullopt : parse_real(token.substr(colon + 1));
        if (!wavelength || !value)
            return refuse(element, faults, "cannot read `" + token + "`; expected a pair wavelength:value", "");
        spectrum.wavelengths.push_back(*wavelength);
        spectrum.values.push_back(*value);
    }
    if (const std::string fault = fault_of(spectrum); !fault.empty()) return refuse(element, faults, fault, "");
    return spectrum;
}

Value parse_blackbody(const Element& element, Faults& faults) {
    if (!check_attributes(element, {"name", "temperature"}, {"scale"}, faults)) return Unreadable{};
    std::string text = element.text("temperature");
    if (text.ends_with('K') || text.ends_with('k')) text.pop_back();
    const auto kelvin = parse_real(text);
    const auto scale = element.attribute("scale") == nullptr ? 1.0 : parse_real(element.text("scale"));
    if (!kelvin || *kelvin <= 0.0 || !scale)
        return refuse(element, faults, "cannot read the temperature; expected a positive number of kelvin", "");
    SampledSpectrum spectrum = blackbody(*kelvin);
    for (double& value : spectrum.values) value *= *scale;
    return spectrum;
}

Value parse_simple(const Element& element, Faults& faults) {
    if (!check_attributes(element, {"name", "value"}, {}, faults)) return Unreadable{};
    const std::string text = element.text("value");
    if (element.tag == "float") {
        if (const auto number = parse_real(text)) return *number;
        return refuse_value(element, faults, "a finite number");
    }
    if (element.tag == "integer") {
        if (const auto number = parse_integer(text)) return *number;
        return refuse_value(element, faults, "a whole number");
    }
    if (element.tag == "boolean") {
        if (const auto flag = parse_boolean(text)) return *flag;
        return refuse_value(element, faults, "`true` or `false`");
    }
    if (element.tag == "rgb") {
        if (const auto rgb = parse_rgb(text)) return Colour{*rgb};
        return refuse_value(element, faults, "one or three finite numbers, or #rrggbb");
    }
    return text;
}

}  // namespace

const std::string* Element::attribute(const std::string& name) const {
    for (const auto& [key, value] : attributes)
        if (key == name) return &value;
    return nullptr;
}

std::string Element::text(const std::string& name) const {
    const std::string* value = attribute(name);
    return value == nullptr ? std::string() : *value;
}

std::string Element::label() const {
    const std::string* name = attribute("name");
    return "<" + tag + (name == nullptr ? "" : " name=\"" + *name + "\"") + ">";
}

bool check_attributes(const Element& element, const Names& required, const Names& optional, Faults& faults) {
    Names allowed = required;
    allowed.insert(allowed.end(), optional.begin(), optional.end());
    bool fine = true;
    for (const auto& [name, value] : element.attributes) {
        if (contains(allowed, name)) continue;
        faults.add(element.place, element.label(),
                   "unexpected attribute `" + name + "`; expected only " + quoted_list(allowed),
                   suggestion(name, allowed));
        fine = false;
    }
    for (const std::string& name : required) {
        if (element.attribute(name) != nullptr) continue;
        faults.add(element.place, element.label(), "the attribute `" + name + "` is missing", "add it");
        fine = false;
    }
    return fine;
}

bool is_property_tag(const std::string& tag) { return contains(property_tags, tag); }
bool is_object_tag(const std::string& tag) { return contains(object_tags, tag); }
bool is_transform_operation(const std::string& tag) { return contains(operation_tags, tag); }

Names known_tags() {
    Names tags = object_tags;
    for (const Names* more : {&property_tags, &operation_tags, &other_tags})
        tags.insert(tags.end(), more->begin(), more->end());
    return tags;
}

Value parse_property(const Element& element, const std::vector<Element>& operations, Faults& faults) {
    if (element.broken) return Unreadable{};
    if (element.tag == "transform") {
        const bool fine = check_attributes(element, {"name"}, {}, faults);
        const Value matrix = parse_transform(operations, faults);
        return fine ? matrix : Unreadable{};
    }
    if (element.tag == "spectrum") return parse_spectrum(element, faults);
    if (element.tag == "blackbody") return parse_blackbody(element, faults);
    if (element.tag == "point" || element.tag == "vector") {
        const bool whole = element.attribute("value") != nullptr;
        const Names components = whole ? Names{"name", "value"} : Names{"name", "x", "y", "z"};
        if (!check_attributes(element, components, {}, faults)) return Unreadable{};
        const auto triple = parse_xyz(element, 0.0, faults);
        return triple ? Value(*triple) : Value(Unreadable{});
    }
    return parse_simple(element, faults);
}

}  // namespace wavelobe::mitsuba
