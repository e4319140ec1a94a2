// Reads Mitsuba 3 XML scenes into the neutral scene.
#include "scene/mitsuba_reader.h"

#include <algorithm>
#include <filesystem>

#include "scene/mitsuba/context.h"
#include "scene/mitsuba/query.h"
#include "scene/supported.h"

namespace wavelobe {

namespace {

using namespace mitsuba;

// Settings of the acceleration structures of other renderers: they change no picture.
const std::vector<std::string> ignored_settings{"allow_thread_reordering",
                                                "compact_acceleration_structures",
                                                "embree_use_robust_intersections",
                                                "kd_intersection_cost",
                                                "kd_traversal_cost",
                                                "kd_empty_space_bonus",
                                                "kd_stop_prims",
                                                "kd_max_depth",
                                                "kd_min_max_bins",
                                                "kd_clip",
                                                "kd_retract_bad_splits",
                                                "kd_exact_primitive_threshold"};

void read_top_level(Context& context, const Object& object) {
    if (object.tag == "bsdf") read_bsdf(context, object);
    else if (object.tag == "texture" || object.tag == "spectrum") {
        if (!read_spectrum_object(context, object, ColourUse::unbounded)) read_texture(context, object, TextureUse::colour);
    }
    else if (object.tag == "shape") read_shape(context, object);
    else if (object.tag == "emitter") read_emitter(context, object);
    else if (object.tag == "sensor") read_sensor(context, object);
    else if (object.tag == "integrator") read_integrator(context, object);
    else if (object.tag == "film") read_film(context, object);
    // What refers to these decides; what nothing refers to must be something all the same.
    else if (object.tag == "sampler") require_type(context, object, sampler_types());
    else if (object.tag == "rfilter") require_type(context, object, filter_types());
    else if (object.tag == "medium") require_type(context, object, known_medium_types());
    else if (object.tag == "phase") require_type(context, object, known_phase_types());
    else if (object.tag == "volume") require_type(context, object, known_volume_types());
    else
        context.faults.add(object.place, object.label(), "a " + object.tag + " is not supported",
                           "remove it from the scene");
}

void read_scene_object(Context& context, const Object& root) {
    Query query(context, root);
    query.accept(ignored_settings);
    for (const Property& property : root.properties)
        if (std::find(ignored_settings.begin(), ignored_settings.end(), property.name) == ignored_settings.end())
            context.faults.add(property.place, root.label(), "unknown property `" + property.name + "`",
                               "remove it");
    for (const Object& object : context.document.objects)
        if (object.tag == "shape")
            for (const Child& child : object.children) context.held_by_shapes.insert(child.object);
    for (const Child& child : root.children)
        if (child.object != nullptr && child.object->tag == "integrator" && sees_media(*child.object)) context.absorbs_media = true;
    for (const Child& child : root.children)
        if (child.object != nullptr) read_top_level(context, *child.object);
    if (context.sensors == 0)
        context.faults.add(root.place, root.label(), "the scene has no sensor",
                           "add <sensor type=\"perspective\"> with a film and a transform");
}

}  // namespace

Scene read_mitsuba_scene(const std::string& path, const Definitions& definitions) {
    Faults faults;
    const std::unique_ptr<Document> document = read_document(path, definitions, faults);
    Scene scene;
    scene.name = std::filesystem::path(path).stem().string();
    for (const Fault& warning : document->warnings) scene.warnings.push_back(warning.text());
    if (document->root != nullptr) {
        Context context(*document, scene, faults);
        read_scene_object(context, *document->root);
        context.mesh_attributes.finish();
    }
    if (!faults.empty()) throw InputError(std::move(faults.list()));
    return scene;
}

std::vector<SupportedPlugins> supported_plugins() {
    return {{"integrator", integrator_types()}, {"sensor", sensor_types()},
            {"sampler", sampler_types()},       {"film", film_types()},
            {"rfilter", filter_types()},        {"bsdf", bsdf_types()},
            {"texture", texture_types()},   {"spectrum", spectrum_types()},
                  {"shape", shape_types()},           {"medium", medium_types()},
            {"emitter", emitter_types()}};
}

}  // namespace wavelobe
