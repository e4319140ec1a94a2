#include "cli/arguments.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <tuple>

#include "scene/fault.h"

namespace wavelobe {

namespace {

template <class T>
std::optional<T> parse_number(std::string_view text) {
    T value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size()) return {};
    return value;
}

// `WIDTHxHEIGHT`
std::optional<std::pair<int, int>> parse_resolution(std::string_view text) {
    const std::size_t sign = text.find('x');
    if (sign == std::string_view::npos) return {};
    const auto width = parse_number<int>(text.substr(0, sign));
    const auto height = parse_number<int>(text.substr(sign + 1));
    if (!width || !height || *width < 1 || *height < 1 || *width > 65536 || *height > 65536) return {};
    return std::pair(*width, *height);
}

}  // namespace

CLI::Validator whole_number(std::int64_t least, std::int64_t greatest) {
    const auto check = [least, greatest](const std::string& text) -> std::string {
        const auto value = parse_number<std::int64_t>(text);
        if (value && *value >= least && *value <= greatest) return {};
        return "\"" + text + "\" is not a whole number from " + std::to_string(least) + " to " + std::to_string(greatest);
    };
    return CLI::Validator(check, "");
}

void SceneArguments::add_to(CLI::App& command) {
    command.add_option("SCENE", path, "Mitsuba 3 XML file, or glTF 2.0 (.gltf, .glb)")->required();
    const auto is_definition = [](const std::string& text) -> std::string {
        const std::size_t sign = text.find('=');
        if (sign != std::string::npos && sign > 0) return {};
        return "\"" + text + "\" is not of the form NAME=VALUE";
    };
    command.add_option("-D,--define", definitions, "Value of a <default> of the scene; may be given more than once")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false)
        ->check(CLI::Validator(is_definition, ""));
    const auto is_resolution = [](const std::string& text) -> std::string {
        return parse_resolution(text) ? "" : "\"" + text + "\" is not of the form WIDTHxHEIGHT, each from 1 to 65536";
    };
    command.add_option("--resolution", resolution, "Size of a glTF scene's picture (default: 720 pixels high, at most 1280 wide)")
        ->type_name("WIDTHxHEIGHT")
        ->take_last()
        ->check(CLI::Validator(is_resolution, ""));
    command.add_option("--frame-time", frame_time, "Time in the animation of a glTF scene (default: as its nodes stand without)")
        ->type_name("SECONDS")
        ->take_last()
        ->check(CLI::Range(-1e9, 1e9));
}

Scene SceneArguments::read() const {
    if (is_gltf(path)) {
        if (!definitions.empty())
            throw InputError(Fault{"-D", 0, 0, "", "a glTF scene has no <default>s to define", "leave it out"});
        GltfOptions options;
        if (const auto size = parse_resolution(resolution)) std::tie(options.width, options.height) = *size;
        options.frame_time = frame_time;
        return read_gltf_scene(path, options);
    }
    if (frame_time)
        throw InputError(Fault{"--frame-time", 0, 0, "", "is for glTF scenes", "leave it out"});
    if (!resolution.empty())
        throw InputError(Fault{"--resolution", 0, 0, "", "is for glTF scenes; a Mitsuba scene's <film> has its size", "leave it out"});
    Definitions values;
    for (const std::string& text : definitions) {
        const std::size_t sign = text.find('=');
        values[text.substr(0, sign)] = text.substr(sign + 1);
    }
    return read_mitsuba_scene(path, values);
}

void print_warnings(const Scene& scene) {
    for (const std::string& warning : scene.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
}

void print_notes(const Scene& scene) {
    for (const std::string& note : scene.notes) std::printf("%s\n", note.c_str());
}

namespace {

// N whole numbers with commas between them.
template <std::size_t N>
std::optional<std::array<int, N>> parse_numbers(const std::string& text) {
    std::array<int, N> values{};
    std::string_view rest = text;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool last = i + 1 == values.size();
        const std::size_t end = last ? rest.size() : rest.find(',');
        if (end == std::string_view::npos) return {};
        const auto value = parse_number<int>(rest.substr(0, end));
        if (!value) return {};
        values[i] = *value;
        if (!last) rest.remove_prefix(end + 1);
    }
    return values;
}

}  // namespace

std::optional<PixelWindow> parse_window(const std::string& text) {
    const auto values = parse_numbers<4>(text);
    if (!values) return {};
    return PixelWindow{(*values)[0], (*values)[1], (*values)[2], (*values)[3]};
}

std::optional<SampleName> parse_sample_name(const std::string& text) {
    const auto values = parse_numbers<3>(text);
    if (!values || (*values)[2] < 0) return {};
    return SampleName{(*values)[0], (*values)[1], static_cast<std::uint32_t>((*values)[2])};
}

void set_crop_window(Film& film, const PixelWindow& window) {
    const bool inside = window.x0 >= 0 && window.y0 >= 0 && window.x1 <= film.width && window.y1 <= film.height;
    if (!inside || window.x0 >= window.x1 || window.y0 >= window.y1) {
        throw InputError(Fault{"--crop", 0, 0, "",
                               "X0,Y0,X1,Y1 must be a window of at least one pixel within the film of " +
                                   std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels",
                               ""});
    }
    film.crop_x = window.x0;
    film.crop_y = window.y0;
    film.crop_width = window.x1 - window.x0;
    film.crop_height = window.y1 - window.y0;
}

}  // namespace wavelobe
