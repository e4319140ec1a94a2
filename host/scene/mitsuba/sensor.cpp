// The sensor plugins, and the samplers nested in them.
#include <array>
#include <cmath>
#include <limits>

#include "scene/mitsuba/query.h"
#include "scene/mitsuba/transforms.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

// Every sampler is replaced by the renderer's own; the counts and the seed stay.
struct SamplerPlugin {
    const char* name;
    std::vector<std::string> (*accepted)();
};
const std::array<SamplerPlugin, 8> sampler_plugins{{
    {"halton", [] { return std::vector<std::string>{"scramble"}; }},
    {"hammersley", [] { return std::vector<std::string>{"scramble"}; }},
    {"independent", [] { return std::vector<std::string>{}; }},
    {"ldsampler", [] { return std::vector<std::string>{"dimension"}; }},
    {"multijitter", [] { return std::vector<std::string>{"jitter"}; }},
    {"orthogonal",
     [] {
         return std::vector<std::string>{"jitter", "strength"};
     }},
    {"sobol", [] { return std::vector<std::string>{"scramble"}; }},
    {"stratified", [] { return std::vector<std::string>{"dimension", "jitter"}; }},
}};

struct Sampling {
    int sample_count = 4;
    std::uint32_t seed = 0;
};

Sampling read_sampler(Context& context, const Object& object) {
    const auto* plugin = find_plugin(context, object, sampler_plugins);
    if (plugin == nullptr) return {};
    Query query(context, object);
    Sampling sampling;
    sampling.sample_count = static_cast<int>(query.integer("sample_count", 4, 1, std::numeric_limits<int>::max()));
    sampling.seed =
        static_cast<std::uint32_t>(query.integer("seed", 0, 0, std::numeric_limits<std::uint32_t>::max()));
    query.accept(plugin->accepted());
    query.finish();
    return sampling;
}

double degrees_of_tangent(double half_tangent) { return glm::degrees(2.0 * std::atan(half_tangent)); }

// The tangent of half the field of view that `fov` or `focal_length` states, and the axis it holds for.
struct FieldOfView {
    double half_tangent = 0.0;
    enum class Axis { x, y, diagonal, smaller, larger } axis = Axis::x;
};

FieldOfView read_field_of_view(Query& query) {
    if (query.has("fov") && query.has("focal_length"))
        query.fault("both `fov` and `focal_length` are given", "keep one of the two");
    using Axis = FieldOfView::Axis;
    const double fov = query.real("fov", 45.0, Range{0.0, 179.999, true});
    const auto axis = static_cast<Axis>(query.choice("fov_axis", {"x", "y", "diagonal", "smaller", "larger"}, 0));
    std::string focal_length = query.text("focal_length", "50mm");
    if (query.has("fov")) return {std::tan(glm::radians(fov) / 2.0), axis};

    // The diagonal of a 35 mm film frame, 36 x 24 mm.
    if (focal_length.ends_with("mm")) focal_length.resize(focal_length.size() - 2);
    const auto millimetres = parse_real(focal_length);
    if (!millimetres || *millimetres <= 0.0) {
        query.fault_at("focal_length", "cannot read the focal length; expected a positive number such as 50mm", "");
        return {std::tan(glm::radians(20.0)), Axis::x};
    }
    return {std::hypot(36.0, 24.0) / (2.0 * *millimetres), Axis::diagonal};
}

float horizontal_degrees(Query& query, const Film& film) {
    using Axis = FieldOfView::Axis;
    const double aspect = static_cast<double>(film.width) / film.height;
    FieldOfView view = read_field_of_view(query);
    if (view.axis == Axis::smaller) view.axis = aspect > 1.0 ? Axis::y : Axis::x;
    if (view.axis == Axis::larger) view.axis = aspect > 1.0 ? Axis::x : Axis::y;
    if (view.axis == Axis::y) view.half_tangent *= aspect;
    if (view.axis == Axis::diagonal) view.half_tangent /= std::sqrt(1.0 + 1.0 / (aspect * aspect));
    return static_cast<float>(degrees_of_tangent(view.half_tangent));
}

PerspectiveCamera read_perspective(Query& query, const Film& film) {
    PerspectiveCamera camera;
    const glm::dmat4 to_world = query.transform("to_world");
    if (has_scale(to_world))
        query.fault_at("to_world", "the transform of a camera cannot scale", "remove the scale factors");
    camera.to_world = glm::mat4(to_world);
    camera.fov_x_degrees = horizontal_degrees(query, film);
    const double near_clip = query.real("near_clip", 0.01, positive);
    const double far_clip = query.real("far_clip", 10000.0, positive);
    if (near_clip >= far_clip) query.fault("`near_clip` is not below `far_clip`", "");
    camera.near_clip = static_cast<float>(near_clip);
    camera.far_clip = static_cast<float>(far_clip);
    camera.principal_point_offset = glm::vec2(
        glm::dvec2(query.real("principal_point_offset_x", 0.0), query.real("principal_point_offset_y", 0.0)));
    query.real("focus_distance", far_clip);
    const double open = query.real("shutter_open", 0.0);
    if (query.real("shutter_close", 0.0) < open && query.has("shutter_close"))
        query.fault("`shutter_close` is before `shutter_open`", "");
    return camera;
}

struct Plugin {
    const char* name;
    PerspectiveCamera (*read)(Query&, const Film&);
};
constexpr std::array<Plugin, 1> plugins{{
    {"perspective", read_perspective},
}};

const Object* only_child(Query& query, const std::string& tag) {
    const std::vector<const Child*> children = query.children(tag);
    if (children.size() > 1) query.fault("holds more than one " + tag, "keep one of them");
    return children.empty() ? nullptr : children.front()->object;
}

}  // namespace

void read_sensor(Context& context, const Object& object) {
    const auto* plugin = find_plugin(context, object, plugins);
    if (plugin == nullptr) return;
    Query query(context, object);
    const Object* film_object = only_child(query, "film");
    const Object* sampler_object = only_child(query, "sampler");
    const Film film = film_object != nullptr ? read_film(context, *film_object) : Film{};
    const Sampling sampling = sampler_object != nullptr ? read_sampler(context, *sampler_object) : Sampling{};
    const PerspectiveCamera camera = plugin->read(query, film);
    const int medium = read_surrounding_medium(query);
    query.finish();
    if (++context.sensors > 1) return query.warn("ignored: the first sensor of the scene is the one that is used");
    context.scene.camera = camera;
    context.scene.camera_medium = medium;
    context.scene.film = film;
    context.scene.sample_count = sampling.sample_count;
    context.scene.seed = sampling.seed;
}

std::vector<std::string> sensor_types() { return names_of(plugins); }
std::vector<std::string> sampler_types() { return names_of(sampler_plugins); }

}  // namespace wavelobe::mitsuba
