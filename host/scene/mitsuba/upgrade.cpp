// Scenes of Mitsuba 0.x, brought to the names of Mitsuba 3 while they are read.
#include "scene/mitsuba/upgrade.h"

#include <algorithm>
#include <array>

#include "scene/image.h"
#include "scene/mitsuba/transforms.h"
#include "scene/mitsuba/values.h"

#include <fmt/format.h>

namespace wavelobe::mitsuba {

namespace {

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

struct Renamed {
    const char* tag;
    const char* old_type;
    const char* type;
    const char* said;  // empty: the same thing under another name
};

constexpr const char* same_light = "replaced by `path`, which computes the same light";
constexpr std::array<Renamed, 23> renamed_plugins{{
    {"film", "ldrfilm", "hdrfilm", "replaced by `hdrfilm`: pictures are linear, without tone mapping"},
    {"film", "mfilm", "hdrfilm", "replaced by `hdrfilm`"},
    {"film", "tiledhdrfilm", "hdrfilm", "replaced by `hdrfilm`"},
    {"film", "exrfilm", "hdrfilm", ""},
    {"film", "pngfilm", "hdrfilm", "replaced by `hdrfilm`: pictures are linear, without tone mapping"},
    {"integrator", "bdpt", "path", same_light},
    {"integrator", "erpt", "path", same_light},
    {"integrator", "mlt", "path", same_light},
    {"integrator", "pssmlt", "path", same_light},
    {"integrator", "photonmapper", "path", same_light},
    {"integrator", "ppm", "path", same_light},
    {"integrator", "sppm", "path", same_light},
    {"integrator", "vpl", "path", same_light},
    {"integrator", "volpath_simple", "volpath", ""},
    {"bsdf", "bump", "bumpmap", ""},
    {"bsdf", "mixturebsdf", "blendbsdf", ""},
    {"bsdf", "mixture", "blendbsdf", ""},
    {"bsdf", "lambertian", "diffuse", ""},
    {"bsdf", "mirror", "conductor", ""},
    {"texture", "vertexcolors", "mesh_attribute", ""},
    {"texture", "ldrtexture", "bitmap", ""},
    {"texture", "exrtexture", "bitmap", ""},
    {"sensor", "perspective_rdist", "perspective", "the lens distortion `kc` is left out"},
}};

Property* find(Object& object, const std::string& name) {
    const auto found = std::find_if(object.properties.begin(), object.properties.end(),
                                    [&](const Property& property) { return property.name == name; });
    return found == object.properties.end() ? nullptr : &*found;
}

void rename(Object& object, const std::string& from, const std::string& to) {
    if (find(object, to) != nullptr) return;
    if (Property* property = find(object, from)) property->name = to;
    for (Child& child : object.children)
        if (child.name == from) child.name = to;
}

void erase(Object& object, const std::string& name) {
    std::erase_if(object.properties, [&](const Property& property) { return property.name == name; });
}

// The number of a property, which goes away.
double take_number(Object& object, const std::string& name, double otherwise) {
    const Property* property = find(object, name);
    if (property == nullptr) return otherwise;
    if (const auto* real = std::get_if<double>(&property->value)) otherwise = *real;
    else if (const auto* whole = std::get_if<std::int64_t>(&property->value)) otherwise = static_cast<double>(*whole);
    erase(object, name);
    return otherwise;
}

// As Mitsuba 3 upgrades them: the offset applies first.
void upgrade_texture_placement(Object& object) {
    const std::array<const char*, 4> names{"uoffset", "voffset", "uscale", "vscale"};
    const auto given = std::find_if(names.begin(), names.end(), [&](const char* name) { return find(object, name); });
    if (given == names.end()) return;
    const Place place = find(object, *given)->place;
    const double both = take_number(object, "uvscale", 1.0);
    const glm::dvec3 offset(take_number(object, "uoffset", 0.0), take_number(object, "voffset", 0.0), 0.0);
    const glm::dvec3 scale(take_number(object, "uscale", both), take_number(object, "vscale", both), 1.0);
    if (find(object, "to_uv") == nullptr)
        object.properties.push_back({"to_uv", scaling(scale) * translation(offset), place});
}

// One blend weight takes the place of the weights of two nested materials that add up to 1.
void upgrade_mixture(Object& object) {
    const Property* weights = find(object, "weights");
    const auto* text = weights == nullptr ? nullptr : std::get_if<std::string>(&weights->value);
    if (text == nullptr) return;
    const std::vector<std::string> tokens = split(*text);
    if (tokens.size() != 2) return;  // refused by name as an unknown property would be
    const auto first = parse_real(tokens[0]), second = parse_real(tokens[1]);
    if (!first || !second || *first + *second <= 0.0) return;
    const Place place = weights->place;
    erase(object, "weights");
    object.properties.push_back({"weight", *second / (*first + *second), place});
}

void upgrade_type(Object& object, std::vector<Fault>& warnings) {
    for (const Renamed& entry : renamed_plugins) {
        if (object.tag != entry.tag || object.type != entry.old_type) continue;
        if (*entry.said != '\0')
            warnings.push_back(Fault{*object.place.file, object.place.line, object.place.column, object.label(),
                                     entry.said, ""});
        if (object.type == "vertexcolors" && find(object, "name") == nullptr)
            object.properties.push_back({"name", std::string("vertex_color"), object.place});
        if (object.type == "lambertian") rename(object, "diffuse_reflectance", "reflectance");
        object.type = entry.type;
        if (object.type == "blendbsdf") upgrade_mixture(object);
        return;
    }
}

// Names of choices that Mitsuba 3 no longer has.
void upgrade_choices(Object& object, std::vector<Fault>& warnings) {
    const auto replace = [&](const char* name, const char* from, const char* to, const char* said) {
        Property* property = find(object, name);
        const auto* text = property == nullptr ? nullptr : std::get_if<std::string>(&property->value);
        if (text == nullptr || *text != from) return;
        property->value = std::string(to);
        if (*said != '\0')
            warnings.push_back(
                Fault{*property->place.file, property->place.line, property->place.column, object.label(), said, ""});
    };
    if (object.tag == "texture") {
        replace("filter_type", "ewa", "bilinear", "");  // paths average where texels are smaller than pixels
        replace("filter_type", "trilinear", "bilinear", "");
    }
    if (object.tag == "bsdf") {
        replace("distribution", "phong", "beckmann", "the distribution `phong` is approximated by `beckmann`, of the same `alpha`");
        replace("distribution", "as", "beckmann", "the distribution `as` is approximated by `beckmann`, of the same `alpha`");
    }
}

// Mitsuba 0.x normalized the axis.
void upgrade_rotation(Element& element) {
    glm::dvec3 axis(0.0);
    const std::array<const char*, 3> names{"x", "y", "z"};
    for (int i = 0; i < 3; ++i) axis[i] = parse_real(element.text(names[static_cast<std::size_t>(i)])).value_or(0.0);
    const double length = glm::length(axis);
    if (!(length > 0.0)) return;
    for (auto& [key, value] : element.attributes) {
        const auto number = parse_real(value);
        if (number && (key == "x" || key == "y" || key == "z")) value = fmt::format("{}", *number / length);
    }
}

}  // namespace

std::string snake_case(const std::string& name) {
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool starts_word = i > 0 && is_upper(name[i]) && is_lower(name[i - 1]);
        const bool inside_capitals = i > 0 && is_upper(name[i]) && is_upper(name[i - 1]) && out.find('_') != std::string::npos;
        if (starts_word) out += '_';
        out += starts_word || inside_capitals ? static_cast<char>(name[i] - 'A' + 'a') : name[i];
    }
    return out;
}

void upgrade_element(Element& element) {
    static const std::array<std::array<const char*, 2>, 3> tags{
        {{"lookAt", "lookat"}, {"camera", "sensor"}, {"luminaire", "emitter"}}};
    for (const auto& [from, to] : tags)
        if (element.tag == from) element.tag = to;
    const bool parameter = element.tag == "default";
    for (auto& [key, value] : element.attributes)
        if (key == "name" && !parameter) value = snake_case(value);
    std::erase_if(element.attributes, [](const auto& attribute) { return attribute.first == "intent"; });

    if (element.tag == "rotate") upgrade_rotation(element);
    if (element.tag == "srgb") {
        // Encoded values become linear ones.
        element.tag = "rgb";
        for (auto& [key, value] : element.attributes) {
            if (key != "value") continue;
            if (const auto rgb = parse_rgb(value))
                value = fmt::format("{} {} {}", srgb_to_linear(static_cast<float>(rgb->r)),
                                    srgb_to_linear(static_cast<float>(rgb->g)), srgb_to_linear(static_cast<float>(rgb->b)));
        }
    }
    // Three plain numbers are a colour.
    const std::string text = element.text("value");
    if (element.tag == "spectrum" && text.find(':') == std::string::npos && (split(text).size() == 3 || text.starts_with('#')))
        element.tag = "rgb";
}

void upgrade_object(Object& object, std::vector<Fault>& warnings) {
    object.legacy = true;
    upgrade_type(object, warnings);
    upgrade_choices(object, warnings);
    if (object.type == "diffuse") rename(object, "diffuse_reflectance", "reflectance");
    if (object.tag == "texture") upgrade_texture_placement(object);
    // Where 0.x wrote its pictures, and how, is no part of a scene here.
    if (object.tag == "film")
        for (const char* name : {"file_format", "pixel_format", "component_format", "gamma", "exposure", "key", "burn",
                                 "tonemap_method", "attach_log", "high_quality_edges", "channel_names", "banner", "label",
                                 "alpha", "digits", "variable"})
            erase(object, name);
}

}  // namespace wavelobe::mitsuba
