// Typed look-ups of an object's properties, with the checks that go with them.
#include "scene/mitsuba/query.h"

#include <algorithm>

#include <fmt/format.h>

#include "scene/dielectrics.h"
#include "scene/mitsuba/transforms.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

std::string number_text(double number) { return fmt::format("{:.6g}", number); }

std::string range_text(const Range& range) {
    const bool low = range.low > -1e30;
    const bool high = range.high < 1e30;
    std::string text;
    if (low) text += (range.open_low ? "above " : "at least ") + number_text(range.low);
    if (high) text += (low ? " and at most " : "at most ") + number_text(range.high);
    return text;
}

}  // namespace

Query::Query(Context& context, const Object& object) : context_(context), object_(object) {}

const Property* Query::find(const std::string& name) {
    asked_.push_back(name);
    for (const Property& property : object_.properties)
        if (property.name == name) return &property;
    return nullptr;
}

const Child* Query::find_child(const std::string& name) {
    for (const Child& child : object_.children)
        if (child.name == name) {
            taken_.push_back(&child);
            return &child;
        }
    return nullptr;
}

bool Query::has(const std::string& name) const {
    const auto named = [&](const auto& entry) { return entry.name == name; };
    return std::any_of(object_.properties.begin(), object_.properties.end(), named) ||
           std::any_of(object_.children.begin(), object_.children.end(), named);
}

void Query::wrong_type(const Property& property, const std::string& expected) {
    if (std::holds_alternative<Unreadable>(property.value)) return;  // its fault is on record
    context_.faults.add(property.place, object_.label(), "the property `" + property.name + "` has the wrong type",
                        "give it as " + expected);
}

double Query::in_range(const Property& property, double number, double otherwise, const Range& range) {
    const bool inside = (range.open_low ? number > range.low : number >= range.low) && number <= range.high;
    if (inside) return number;
    context_.faults.add(
        property.place, object_.label(),
        "`" + property.name + "` is " + number_text(number) + "; expected a number " + range_text(range), "");
    return otherwise;
}

double Query::real(const std::string& name, double otherwise, Range range) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    if (const auto* number = std::get_if<double>(&property->value))
        return in_range(*property, *number, otherwise, range);
    if (const auto* number = std::get_if<std::int64_t>(&property->value))
        return in_range(*property, static_cast<double>(*number), otherwise, range);
    wrong_type(*property, "<float>");
    return otherwise;
}

std::int64_t Query::integer(const std::string& name, std::int64_t otherwise, std::int64_t low, std::int64_t high) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    const auto* number = std::get_if<std::int64_t>(&property->value);
    if (number == nullptr) {
        const auto* real = std::get_if<double>(&property->value);
        if (real != nullptr && object_.legacy && *real >= static_cast<double>(low) && *real <= static_cast<double>(high))
            return static_cast<std::int64_t>(*real);
        wrong_type(*property, "<integer>");
        return otherwise;
    }
    if (*number >= low && *number <= high) return *number;
    context_.faults.add(property->place, object_.label(),
                        fmt::format("`{}` is {}; expected a whole number from {} to {}", name, *number, low, high),
                        "");
    return otherwise;
}

bool Query::boolean(const std::string& name, bool otherwise) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    if (const auto* flag = std::get_if<bool>(&property->value)) return *flag;
    wrong_type(*property, "<boolean>");
    return otherwise;
}

std::string Query::text(const std::string& name, const std::string& otherwise) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    if (const auto* text = std::get_if<std::string>(&property->value)) return *text;
    wrong_type(*property, "<string>");
    return otherwise;
}

glm::dvec3 Query::triple(const std::string& name, const glm::dvec3& otherwise) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    if (const auto* triple = std::get_if<glm::dvec3>(&property->value)) return *triple;
    wrong_type(*property, "<point> or <vector>");
    return otherwise;
}

glm::dvec3 Query::triple_or_real(const std::string& name) {
    const Property* property = find(name);
    if (property != nullptr && std::holds_alternative<glm::dvec3>(property->value)) return triple(name, glm::dvec3(0.0));
    return glm::dvec3(real(name, 0.0));
}

glm::dmat4 Query::transform(const std::string& name) {
    const Property* property = find(name);
    if (property == nullptr) return glm::dmat4(1.0);
    const auto* matrix = std::get_if<glm::dmat4>(&property->value);
    if (matrix == nullptr) {
        wrong_type(*property, "<transform>");
        return glm::dmat4(1.0);
    }
    if (is_invertible_affine(*matrix)) return *matrix;
    context_.faults.add(property->place, object_.label(), "`" + name + "` is not an invertible affine transform",
                        "expected a last row of 0 0 0 1 and no scale of zero");
    return glm::dmat4(1.0);
}

std::size_t Query::choice(const std::string& name, const std::vector<std::string>& choices, std::size_t otherwise) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    const auto* text = std::get_if<std::string>(&property->value);
    if (text == nullptr) {
        wrong_type(*property, "<string>");
        return otherwise;
    }
    const auto found = std::find(choices.begin(), choices.end(), lower_case(*text));
    if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
    context_.faults.add(property->place, object_.label(),
                        "`" + name + "` is `" + *text + "`; expected one of " + quoted_list(choices),
                        suggestion(*text, choices));
    return otherwise;
}

std::optional<Rgb> Query::colour_value(const Property& property, ColourUse use) {
    glm::dvec3 rgb(0.0);
    if (const auto* number = std::get_if<double>(&property.value)) rgb = glm::dvec3(*number);
    else if (const auto* whole = std::get_if<std::int64_t>(&property.value))
        rgb = glm::dvec3(static_cast<double>(*whole));
    else if (const auto* colour = std::get_if<Colour>(&property.value)) rgb = colour->rgb;
    else if (const auto* spectrum = std::get_if<UniformSpectrum>(&property.value))
        rgb = spectrum->value * (use != ColourUse::emission ? glm::dvec3(1.0) : equal_energy_rgb());
    else if (const auto* sampled = std::get_if<SampledSpectrum>(&property.value)) rgb = sampled_colour(*sampled, use);
    else {
        wrong_type(property, "<float>, <rgb> or <spectrum>");
        return std::nullopt;
    }
    const bool negative = rgb.r < 0.0 || rgb.g < 0.0 || rgb.b < 0.0;
    const bool above_one = rgb.r > 1.0 || rgb.g > 1.0 || rgb.b > 1.0;
    const bool bounded = use == ColourUse::reflectance && std::holds_alternative<Colour>(property.value);
    if (bounded && above_one && !negative && object_.legacy) {
        warn(fmt::format("`{}` is above 1 and taken as 1", property.name));
        return Rgb(glm::min(rgb, glm::dvec3(1.0)));
    }
    if (negative && object_.legacy && use == ColourUse::unbounded) {
        warn(fmt::format("components of `{}` below 0 are taken as 0", property.name));
        return Rgb(glm::max(rgb, glm::dvec3(0.0)));
    }
    if (negative || (bounded && above_one)) {
        context_.faults.add(
            property.place, object_.label(),
            fmt::format("`{}` is {:.6g}, {:.6g}, {:.6g}; expected components {}", property.name, rgb.r, rgb.g,
                        rgb.b, use == ColourUse::reflectance ? "from 0 to 1" : "that are not negative"),
            "");
        return std::nullopt;
    }
    return Rgb(rgb);
}

// Colours out of gamut are clamped to what the parameter allows.
glm::dvec3 Query::sampled_colour(const SampledSpectrum& spectrum, ColourUse use) {
    const Illuminant illuminant = use == ColourUse::emission ? Illuminant::none : Illuminant::d65;
    const glm::dvec3 rgb = glm::max(spectrum_to_rgb(spectrum, illuminant), glm::dvec3(0.0));
    return use == ColourUse::reflectance ? glm::min(rgb, glm::dvec3(1.0)) : rgb;
}

Rgb Query::colour(const std::string& name, double otherwise, ColourUse use) {
    const Parameter parameter = this->parameter(name, otherwise, use);
    if (parameter.texture != nullptr)
        fault_at(name, "`" + name + "` cannot vary over a texture", "give it as <rgb> or <float>");
    return parameter.value;
}

Parameter Query::parameter(const std::string& name, double otherwise, ColourUse use) {
    Parameter result{Rgb(static_cast<float>(otherwise)), nullptr};
    if (const Property* property = find(name)) {
        result.value = colour_value(*property, use).value_or(result.value);
    } else if (const Child* child = find_child(name); child != nullptr && child->object != nullptr) {
        if (const auto rgb = read_spectrum_object(context_, *child->object, use)) result.value = *rgb;
        else result.texture = read_texture(context_, *child->object, TextureUse::colour);
    }
    return result;
}

Parameter Query::scalar_parameter(const std::string& name, double otherwise, Range range) {
    Parameter result{Rgb(static_cast<float>(otherwise)), nullptr};
    if (const Property* property = find(name)) {
        double number = otherwise;
        if (const auto rgb = colour_value(*property, ColourUse::unbounded))
            number =
                (static_cast<double>(rgb->r) + static_cast<double>(rgb->g) + static_cast<double>(rgb->b)) / 3.0;
        result.value = Rgb(static_cast<float>(in_range(*property, number, otherwise, range)));
    } else if (const Child* child = find_child(name); child != nullptr && child->object != nullptr) {
        if (const auto rgb = read_spectrum_object(context_, *child->object, ColourUse::unbounded))
            result.value = Rgb((rgb->r + rgb->g + rgb->b) / 3.0F);
        else result.texture = read_texture(context_, *child->object, TextureUse::scalar);
    }
    return result;
}

double Query::refractive_index(const std::string& name, const std::string& otherwise) {
    const Property* property = find(name);
    const double fallback = find_dielectric(otherwise).value_or(1.0);
    if (property == nullptr) return fallback;
    if (const auto* number = std::get_if<double>(&property->value))
        return in_range(*property, *number, fallback, positive);
    if (const auto* whole = std::get_if<std::int64_t>(&property->value))
        return in_range(*property, static_cast<double>(*whole), fallback, positive);
    const auto* text = std::get_if<std::string>(&property->value);
    if (text == nullptr) {
        wrong_type(*property, "<float>, or <string> with the name of a dielectric");
        return fallback;
    }
    if (const auto index = find_dielectric(lower_case(*text))) return *index;
    context_.faults.add(
        property->place, object_.label(),
        "`" + *text + "` is no dielectric known here; expected one of " + quoted_list(dielectric_names()),
        suggestion(*text, dielectric_names()));
    return fallback;
}

std::string Query::file(const std::string& name) {
    const Property* property = find(name);
    if (property == nullptr) {
        fault("the property `" + name + "` is missing",
              "name the file with <string name=\"" + name + "\" value=\"...\"/>");
        return {};
    }
    const auto* text = std::get_if<std::string>(&property->value);
    if (text == nullptr) {
        wrong_type(*property, "<string>");
        return {};
    }
    std::string path = context_.document.find_file(*text, property->place);
    if (path.empty())
        context_.faults.add(property->place, object_.label(), "the file `" + *text + "` does not exist",
                            "check the name, or add its folder with <path>");
    return path;
}

std::vector<const Child*> Query::children(const std::string& tag) {
    std::vector<const Child*> found;
    for (const Child& child : object_.children) {
        if (child.object == nullptr || child.object->tag != tag) continue;
        found.push_back(&child);
        taken_.push_back(&child);
    }
    return found;
}

bool Query::has_unresolved_children() const {
    return std::any_of(object_.children.begin(), object_.children.end(),
                       [](const Child& child) { return child.object == nullptr; });
}

void Query::accept(const std::vector<std::string>& names) {
    asked_.insert(asked_.end(), names.begin(), names.end());
}

void Query::fault(const std::string& message, const std::string& hint) {
    context_.faults.add(object_.place, object_.label(), message, hint);
}

void Query::fault_at(const std::string& name, const std::string& message, const std::string& hint) {
    Place place = object_.place;
    for (const Property& property : object_.properties)
        if (property.name == name) place = property.place;
    for (const Child& child : object_.children)
        if (child.name == name) place = child.place;
    context_.faults.add(place, object_.label(), message, hint);
}

void Query::warn(const std::string& message) {
    context_.scene.warnings.push_back(
        Fault{*object_.place.file, object_.place.line, object_.place.column, object_.label(), message, ""}.text());
}

void Query::finish() {
    std::sort(asked_.begin(), asked_.end());
    asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
    const std::string expected =
        asked_.empty() ? "; it takes no properties" : "; expected only " + quoted_list(asked_);
    for (const Property& property : object_.properties) {
        if (std::binary_search(asked_.begin(), asked_.end(), property.name)) continue;
        const std::string message = "unknown property `" + property.name + "`";
        if (object_.legacy && !is_misspelled(property.name, asked_)) warn(message + " is ignored");
        else
            context_.faults.add(property.place, object_.label(), message + expected,
                                suggestion(property.name, asked_));
    }
    for (const Child& child : object_.children) {
        if (child.object == nullptr || std::find(taken_.begin(), taken_.end(), &child) != taken_.end()) continue;
        const std::string name = child.name.empty() ? "" : " named `" + child.name + "`";
        if (std::any_of(taken_.begin(), taken_.end(), [&](const Child* taken) { return !name.empty() && taken->name == child.name; })) {
            context_.faults.add(child.place, object_.label(), "holds more than one object" + name, "keep one of them");
            continue;
        }
        context_.faults.add(child.place, object_.label(),
                            "cannot hold a nested " + child.object->label() + name + expected,
                            child.name.empty() ? "" : suggestion(child.name, asked_));
    }
}

void refuse_type(Context& context, const Object& object, const std::vector<std::string>& supported) {
    context.faults.add(
        object.place, object.label(),
        "this type of " + object.tag + " is not supported; expected one of " + quoted_list(supported),
        suggestion(object.type, supported));
}

void require_type(Context& context, const Object& object, const std::vector<std::string>& known) {
    if (!object.broken && std::find(known.begin(), known.end(), object.type) == known.end()) refuse_type(context, object, known);
}

}  // namespace wavelobe::mitsuba
