// The film and reconstruction filter plugins.
#include <array>

#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

namespace {

using Kind = ReconstructionFilter::Kind;

// Pixels: a filter beyond this sees no picture any more.
constexpr double max_radius = 1000.0;

float radius(Query& query, double otherwise) {
    return static_cast<float>(query.real("radius", otherwise, Range{1e-3, max_radius}));
}

// Mitsuba 0.x let boxes have a radius.
ReconstructionFilter read_box(Query& query) {
    return {.kind = Kind::box, .radius = query.object().legacy ? radius(query, 0.5) : 0.5F};
}

ReconstructionFilter read_tent(Query& query) {
    return {.kind = Kind::tent, .radius = radius(query, 1.0)};
}

ReconstructionFilter read_gaussian(Query& query) {
    const auto stddev = static_cast<float>(query.real("stddev", 0.5, Range{1e-3, 0.25 * max_radius}));
    return {.kind = Kind::gaussian, .radius = 4.0F * stddev, .stddev = stddev};
}

ReconstructionFilter read_mitchell(Query& query) {
    const auto parameter = [&](const char* name) { return static_cast<float>(query.real(name, 1.0 / 3.0, Range{-10.0, 10.0})); };
    return {.kind = Kind::mitchell, .b = parameter("B"), .c = parameter("C")};
}

ReconstructionFilter read_catmullrom(Query&) { return {.kind = Kind::mitchell, .b = 0.0F, .c = 0.5F}; }

ReconstructionFilter read_lanczos(Query& query) {
    return {.kind = Kind::lanczos, .radius = static_cast<float>(query.integer("lobes", 3, 1, 32))};
}

struct FilterPlugin {
    const char* name;
    ReconstructionFilter (*read)(Query&);
};
constexpr std::array<FilterPlugin, 6> filter_plugins{{
    {"box", read_box},
    {"catmullrom", read_catmullrom},
    {"gaussian", read_gaussian},
    {"lanczos", read_lanczos},
    {"mitchell", read_mitchell},
    {"tent", read_tent},
}};

ReconstructionFilter read_filter(Context& context, const Object& object) {
    const auto* plugin = find_plugin(context, object, filter_plugins);
    if (plugin == nullptr) return {};
    Query query(context, object);
    const ReconstructionFilter filter = plugin->read(query);
    query.finish();
    return filter;
}

// Far above any picture, and small enough for the pixel count to stay in range.
constexpr std::int64_t max_side = 65536;

// What a file is written as is chosen when rendering; a scene only has to name something sensible.
void accept_output_formats(Query& query) {
    query.choice("file_format", {"openexr", "exr", "rgbe", "pfm"}, 0);
    query.choice("pixel_format", {"luminance", "luminance_alpha", "rgb", "rgba", "xyz", "xyza"}, 2);
    query.choice("component_format", {"float16", "float32", "uint32"}, 0);
    query.boolean("sample_border", false);
    query.accept({"banner", "compensate", "high_quality_edges"});
}

Film read_hdr_film(Query& query) {
    const auto size = [&](const std::string& name, std::int64_t otherwise, std::int64_t low) {
        return static_cast<int>(query.integer(name, otherwise, low, max_side));
    };
    Film film;
    film.width = size("width", 768, 1);
    film.height = size("height", 576, 1);
    film.crop_width = size("crop_width", film.width, 1);
    film.crop_height = size("crop_height", film.height, 1);
    film.crop_x = size("crop_offset_x", 0, 0);
    film.crop_y = size("crop_offset_y", 0, 0);
    if (film.crop_x + film.crop_width > film.width || film.crop_y + film.crop_height > film.height)
        query.fault("the crop window reaches beyond the film",
                    "let offset plus size stay within `width` and `height`");
    accept_output_formats(query);
    const std::vector<const Child*> filters = query.children("rfilter");
    if (filters.size() > 1) query.fault("holds more than one reconstruction filter", "keep one of them");
    if (!filters.empty()) film.filter = read_filter(query.context(), *filters.front()->object);
    return film;
}

struct FilmPlugin {
    const char* name;
    Film (*read)(Query&);
};
constexpr std::array<FilmPlugin, 1> film_plugins{{
    {"hdrfilm", read_hdr_film},
}};

}  // namespace

Film read_film(Context& context, const Object& object) {
    const auto* plugin = find_plugin(context, object, film_plugins);
    if (plugin == nullptr) return {};
    Query query(context, object);
    const Film film = plugin->read(query);
    query.finish();
    return film;
}

std::vector<std::string> film_types() { return names_of(film_plugins); }
std::vector<std::string> filter_types() { return names_of(filter_plugins); }

}  // namespace wavelobe::mitsuba
