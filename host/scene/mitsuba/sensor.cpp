// The sensor plugins, and the samplers nested in them.
#include <array>
#include <limits>

#include "scene/mitsuba/field_of_view.h"
#include "scene/mitsuba/transforms.h"

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
    sampling.sample_count = static_cast<int>(query.integer("sample_count", 4, 1, 1 << 24));
    sampling.seed =
        static_cast<std::uint32_t>(query.integer("seed", 0, 0, std::numeric_limits<std::uint32_t>::max()));
    query.accept(plugin->accepted());
    query.finish();
    return sampling;
}

// What all of them have: the transform, planes of depth, and times of a shutter that nothing here moves under.
Camera read_projective(Query& query) {
    Camera camera;
    camera.to_world = glm::mat4(query.transform("to_world"));
    const double near_clip = query.real("near_clip", 0.01, positive);
    const double far_clip = query.real("far_clip", 10000.0, positive);
    if (near_clip >= far_clip) query.fault("`near_clip` is not below `far_clip`", "");
    camera.near_clip = static_cast<float>(near_clip);
    camera.far_clip = static_cast<float>(far_clip);
    camera.focus_distance = static_cast<float>(query.real("focus_distance", far_clip, positive));
    const double open = query.real("shutter_open", 0.0);
    if (query.real("shutter_close", 0.0) < open && query.has("shutter_close"))
        query.fault("`shutter_close` is before `shutter_open`", "");
    return camera;
}

void refuse_scale(Query& query, const Camera& camera) {
    if (has_scale(glm::dmat4(camera.to_world)))
        query.fault_at("to_world", "the transform of a camera cannot scale", "remove the scale factors");
}

Camera read_perspective(Query& query, const Film& film) {
    Camera camera = read_projective(query);
    refuse_scale(query, camera);
    camera.fov_x_degrees = horizontal_degrees(query, static_cast<double>(film.width) / film.height);
    camera.principal_point_offset = glm::vec2(
        glm::dvec2(query.real("principal_point_offset_x", 0.0), query.real("principal_point_offset_y", 0.0)));
    return camera;
}

Camera read_thin_lens(Query& query, const Film& film) {
    Camera camera = read_projective(query);
    refuse_scale(query, camera);
    camera.fov_x_degrees = horizontal_degrees(query, static_cast<double>(film.width) / film.height);
    if (!query.has("aperture_radius"))
        query.fault("the property `aperture_radius` is missing", "give the radius of the lens in scene units");
    camera.aperture_radius = static_cast<float>(query.real("aperture_radius", 1.0, not_negative));
    return camera;
}

// The film spans [-1, 1] of the transform's x axis.
Camera read_orthographic(Query& query, const Film&) {
    Camera camera = read_projective(query);
    camera.projection = Camera::Projection::orthographic;
    return camera;
}

struct Plugin {
    const char* name;
    Camera (*read)(Query&, const Film&);
};
constexpr std::array<Plugin, 3> plugins{{
    {"orthographic", read_orthographic},
    {"perspective", read_perspective},
    {"thinlens", read_thin_lens},
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
    const Camera camera = plugin->read(query, film);
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
