// The spectrum plugins: each is a constant colour here.
#include <array>

#include "scene/mitsuba/query.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

// Samples as a property, or as the text of numbers; empty, with the fault on record, when they are unusable.
SampledSpectrum checked(Query& query, SampledSpectrum spectrum) {
    if (const std::string fault = fault_of(spectrum); !fault.empty()) {
        query.fault(fault, "");
        return {};
    }
    return spectrum;
}

std::vector<double> numbers(Query& query, const std::string& name) {
    std::vector<double> values;
    for (const std::string& token : split(query.text(name, ""))) {
        const auto number = parse_real(token);
        if (!number) {
            query.fault_at(name, "cannot read `" + token + "` in `" + name + "`; expected finite numbers", "");
            return {};
        }
        values.push_back(*number);
    }
    return values;
}

Rgb sampled(Query& query, const SampledSpectrum& spectrum, ColourUse use) {
    return spectrum.values.empty() ? Rgb(0.0F) : Rgb(query.sampled_colour(spectrum, use));
}

Rgb read_uniform(Query& query, ColourUse) {
    query.accept({"wavelength_min", "wavelength_max"});
    return Rgb(static_cast<float>(query.real("value", 1.0, not_negative)));
}

// Three numbers of any meaning, such as a normal, or one.
Rgb read_raw_constant(Query& query, ColourUse) {
    if (!query.has("value")) query.fault("the property `value` is missing", "give it as <float> or <vector>");
    return Rgb(query.triple_or_real("value"));
}

Rgb read_srgb(Query& query, ColourUse use) {
    query.boolean("unbounded", false);
    return query.colour("color", 0.0, use);
}

// Seen in sRGB, D65 is white.
Rgb read_d65(Query& query, ColourUse use) {
    const auto scale = static_cast<float>(query.real("scale", 1.0, not_negative));
    return query.has("color") ? scale * query.colour("color", 1.0, use) : Rgb(scale);
}

Rgb read_blackbody(Query& query, ColourUse use) {
    query.accept({"wavelength_min", "wavelength_max"});
    if (!query.has("temperature")) query.fault("the property `temperature` is missing", "give it in kelvin");
    const double kelvin = query.real("temperature", 6500.0, positive);
    const double scale = query.real("scale", 1.0, not_negative);
    return static_cast<float>(scale) * sampled(query, blackbody(kelvin), use);
}

Rgb read_irregular(Query& query, ColourUse use) {
    if (query.has("value")) return query.colour("value", 0.0, use);
    SampledSpectrum spectrum{numbers(query, "wavelengths"), numbers(query, "values")};
    return sampled(query, checked(query, std::move(spectrum)), use);
}

Rgb read_regular(Query& query, ColourUse use) {
    if (query.has("value")) return query.colour("value", 0.0, use);
    SampledSpectrum spectrum{{}, numbers(query, "values")};
    const double first = query.real("wavelength_min", 360.0);
    const double last = query.real("wavelength_max", 830.0);
    const auto steps = static_cast<double>(spectrum.values.size()) - 1.0;
    for (std::size_t i = 0; i < spectrum.values.size(); ++i)
        spectrum.wavelengths.push_back(first + (last - first) * static_cast<double>(i) / steps);
    return sampled(query, checked(query, std::move(spectrum)), use);
}

struct Plugin {
    const char* name;
    Rgb (*read)(Query&, ColourUse);
};
constexpr std::array<Plugin, 8> plugins{{
    {"blackbody", read_blackbody},
    {"d65", read_d65},
    {"irregular", read_irregular},
    {"rawconstant", read_raw_constant},
    {"regular", read_regular},
    {"rgb", read_srgb},
    {"srgb", read_srgb},
    {"uniform", read_uniform},
}};

}  // namespace

std::optional<Rgb> read_spectrum_object(Context& context, const Object& object, ColourUse use) {
    if (object.tag != "texture" && object.tag != "spectrum") return std::nullopt;
    for (const Plugin& plugin : plugins) {
        if (object.type != plugin.name) continue;
        // A texture inside D65 is the texture.
        const bool holds_texture = object.type == "d65" && !object.children.empty();
        if (holds_texture) return std::nullopt;
        Query query(context, object);
        const Rgb rgb = plugin.read(query, use);
        query.finish();
        return rgb;
    }
    return std::nullopt;
}

std::vector<std::string> spectrum_types() { return names_of(plugins); }

}  // namespace wavelobe::mitsuba
