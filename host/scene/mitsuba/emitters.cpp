// The emitter plugins.
#include <array>

#include "scene/image.h"
#include "scene/mitsuba/field_of_view.h"
#include "scene/mitsuba/query.h"
#include "scene/mitsuba/transforms.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

// How often a light is sampled does not change the picture, except for lights that are never sampled nor met by chance.
bool is_sampled(Query& query) { return query.real("sampling_weight", 1.0, not_negative) > 0.0; }

Rgb emission(Query& query, const std::string& name) { return query.colour(name, 1.0, ColourUse::emission); }

void count_environment(Query& query) {
    if (++query.context().environments > 1)
        query.fault("the scene has a `constant` or `envmap` emitter already", "keep one of them");
}

std::optional<Emitter> read_constant(Query& query) {
    count_environment(query);
    query.transform("to_world");
    return ConstantEmitter{emission(query, "radiance")};
}

std::optional<Emitter> read_envmap(Query& query) {
    count_environment(query);
    EnvironmentMap map;
    const std::string path = query.file("filename");
    map.scale = static_cast<float>(query.real("scale", 1.0, not_negative));
    map.to_world = glm::mat4(query.transform("to_world"));
    query.boolean("mis_compensation", false);
    if (path.empty()) return std::nullopt;
    try {
        map.image = load_image(path, Transfer::of_format);
        pad_image(map.image, 2, 3);
    } catch (const InputError& error) {
        query.context().faults.add(error, query.object().place, query.object().label());
        return std::nullopt;
    }
    return map;
}

std::optional<Emitter> read_point(Query& query) {
    if (query.has("position") && query.has("to_world"))
        query.fault("both `position` and `to_world` are given", "keep one of the two");
    const glm::dmat4 to_world = query.transform("to_world");
    const glm::dvec3 position = query.triple("position", glm::dvec3(to_world[3]));
    return PointEmitter{glm::vec3(position), emission(query, "intensity")};
}

std::optional<Emitter> read_spot(Query& query) {
    SpotEmitter spot;
    spot.to_world = glm::mat4(query.transform("to_world"));
    spot.intensity = emission(query, "intensity");
    const double cutoff = query.real("cutoff_angle", 20.0, Range{0.0, 180.0, true});
    const double beam = query.real("beam_width", cutoff * 0.75, Range{0.0, 180.0, false});
    if (beam > cutoff)
        query.fault_at("beam_width", "`beam_width` is above `cutoff_angle`", "expected a smaller angle");
    spot.cutoff_degrees = static_cast<float>(cutoff);
    spot.beam_width_degrees = static_cast<float>(beam);
    if (query.has("texture")) {
        spot.texture = query.parameter("texture", 1.0, ColourUse::unbounded).texture;
        if (spot.texture == nullptr && !query.has_unresolved_children())
            query.fault_at("texture", "`texture` does not vary over the cone", "nest a <texture>, or scale `intensity`");
    }
    return spot;
}

// Width over height of what is projected; only pictures have a shape of their own.
double aspect_of(const Parameter& irradiance) {
    const auto* bitmap = irradiance.texture == nullptr ? nullptr : std::get_if<Bitmap>(&irradiance.texture->source);
    return bitmap == nullptr ? 1.0 : static_cast<double>(bitmap->width) / bitmap->height;
}

std::optional<Emitter> read_projector(Query& query) {
    ProjectorEmitter projector;
    const glm::dmat4 to_world = query.transform("to_world");
    if (!is_similarity(to_world))
        query.fault_at("to_world", "a projector cannot be scaled unevenly or sheared", "use the same scale for all axes");
    projector.to_world = glm::mat4(to_world);
    projector.irradiance = query.parameter("irradiance", 1.0, ColourUse::emission);
    projector.scale = static_cast<float>(query.real("scale", 1.0, not_negative));
    const double aspect = aspect_of(projector.irradiance);
    projector.aspect = static_cast<float>(aspect);
    projector.fov_x_degrees = horizontal_degrees(query, aspect);
    return projector;
}

std::optional<Emitter> read_directional(Query& query) {
    if (query.has("direction") && query.has("to_world"))
        query.fault("both `direction` and `to_world` are given", "keep one of the two");
    const glm::dvec3 along_z(query.transform("to_world")[2]);
    const glm::dvec3 direction = query.triple("direction", along_z);
    if (direction == glm::dvec3(0.0))
        query.fault_at("direction", "the direction is zero", "give the way the light travels");
    return DirectionalEmitter{glm::vec3(glm::normalize(direction)), emission(query, "irradiance")};
}

struct Plugin {
    const char* name;
    std::optional<Emitter> (*read)(Query&);  // null: nested in a shape
};
constexpr std::array<Plugin, 7> plugins{{
    {"area", nullptr},
    {"constant", read_constant},
    {"directional", read_directional},
    {"envmap", read_envmap},
    {"point", read_point},
    {"projector", read_projector},
    {"spot", read_spot},
}};

// What Mitsuba has beside these, and what to do without it.
constexpr std::array<std::array<const char*, 2>, 6> known_elsewhere{{
    {"directionalarea", "give a small `spot`, or an `area` light"},
    {"sky", "render it to a picture for `envmap`, or use `constant`"},
    {"sun", "use `directional`"},
    {"sunsky", "render it to a picture for `envmap`, or use `constant` with `directional`"},
    {"timed_sunsky", "render it to a picture for `envmap`, or use `constant` with `directional`"},
    {"volumelight", "use an `area` light"},
}};

const Plugin* find_emitter(Context& context, const Object& object) {
    for (const auto& [type, instead] : known_elsewhere) {
        if (object.broken || object.type != type) continue;
        context.faults.add(object.place, object.label(),
                           "emitters of this type are not supported; expected one of " + quoted_list(names_of(plugins)), instead);
        return nullptr;
    }
    return find_plugin(context, object, plugins);
}

}  // namespace

void read_emitter(Context& context, const Object& object) {
    const auto* plugin = find_emitter(context, object);
    if (plugin == nullptr) return;
    Query query(context, object);
    context.attributes.clear();
    if (plugin->read == nullptr) {
        if (context.held_by_shapes.contains(&object)) return;
        return query.fault("an area light needs a shape to shine from", "nest it in a <shape>");
    }
    std::optional<Emitter> emitter = plugin->read(query);
    const bool sampled = is_sampled(query);
    read_surrounding_medium(query);  // paths start at the camera
    query.finish();
    if (!context.attributes.empty()) query.fault("attributes are of meshes, and it has none", "use another texture");
    if (!emitter) return;
    const bool surrounds = std::holds_alternative<ConstantEmitter>(*emitter) || std::holds_alternative<EnvironmentMap>(*emitter);
    if (sampled || surrounds) context.scene.emitters.push_back(std::move(*emitter));
}

std::optional<AreaEmitter> read_area_emitter(Context& context, const Object& object) {
    const auto* plugin = find_emitter(context, object);
    if (plugin == nullptr) return std::nullopt;
    Query query(context, object);
    if (plugin->read != nullptr) {
        query.fault("only an `area` emitter can be nested in a shape", "move it out of the shape");
        return std::nullopt;
    }
    if (query.has("to_world")) {
        query.fault_at("to_world", "an area light has no transform of its own", "transform its shape");
        query.accept({"to_world"});
    }
    AreaEmitter emitter{query.parameter("radiance", 1.0, ColourUse::emission)};
    is_sampled(query);
    read_surrounding_medium(query);
    query.finish();
    return emitter;
}

std::vector<std::string> emitter_types() { return names_of(plugins); }

}  // namespace wavelobe::mitsuba
