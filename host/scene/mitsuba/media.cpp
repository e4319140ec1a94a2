// The medium plugins: those that absorb and do not scatter.
#include <array>

#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

namespace {

constexpr const char* scattering_hint = "only absorption is supported: give `albedo` 0, or remove the medium";

// A number, colour or <volume type="constvolume">; the default, with the fault on record, otherwise.
Rgb read_constant(Query& query, const std::string& name, double otherwise) {
    for (const Child* child : query.children("volume")) {
        if (child->name != name) continue;
        if (child->object->type != "constvolume") {
            query.context().faults.add(child->place, child->object->label(),
                                       "media that vary in space are not supported: `" + name + "` must be constant",
                                       "use <volume type=\"constvolume\">, <rgb> or <float>");
            return Rgb(static_cast<float>(otherwise));
        }
        Query volume(query.context(), *child->object);
        volume.accept({"to_world"});
        const Rgb value = volume.colour("value", 1.0, ColourUse::unbounded);
        volume.finish();
        return value;
    }
    return query.colour(name, otherwise, ColourUse::unbounded);
}

Rgb read_absorption(Query& query) {
    // Mitsuba 0.x: absorption and scattering apart.
    if (query.object().legacy && query.has("sigma_a")) {
        if (query.has("sigma_s") && read_constant(query, "sigma_s", 0.0) != Rgb(0.0F))
            query.fault_at("sigma_s", "scattering media are not supported", "give `sigmaS` 0, or remove the medium");
        return read_constant(query, "sigma_a", 0.0);
    }
    const Rgb albedo = read_constant(query, "albedo", 0.75);
    if (albedo != Rgb(0.0F)) {
        const std::string stated = query.has("albedo") ? "" : " (`albedo` is 0.75 by default)";
        query.fault_at("albedo", "scattering media are not supported" + stated, scattering_hint);
    }
    return read_constant(query, "sigma_t", 1.0);
}

Medium read_homogeneous(Query& query) {
    Medium medium;
    medium.name = query.object().id;
    const Rgb absorption = read_absorption(query);
    medium.absorption = absorption * static_cast<float>(query.real("scale", 1.0, not_negative));
    // Of scattering, or of how Mitsuba samples.
    query.accept({"sample_emitters", "has_spectral_extinction"});
    for (const Child* phase : query.children("phase")) require_type(query.context(), *phase->object, known_phase_types());
    return medium;
}

}  // namespace

int read_medium(Context& context, const Object& object) {
    const auto [known, fresh] = context.media.try_emplace(&object, -1);
    if (!fresh || object.broken) return known->second;
    Query query(context, object);
    if (object.type != "homogeneous") {
        query.fault(object.type == "heterogeneous" ? "media that vary in space are not supported"
                                                   : "this type of medium is not supported; expected `homogeneous`",
                    "use a homogeneous medium of `albedo` 0, or remove it");
        return -1;
    }
    const Medium medium = read_homogeneous(query);
    query.finish();
    // Mitsuba's path tracers without `vol` in their names see no media.
    if (!context.absorbs_media) {
        query.warn("ignored: the integrator sees no media; `volpath` does");
        return -1;
    }
    context.scene.media.push_back(medium);
    return context.media[&object] = static_cast<int>(context.scene.media.size()) - 1;
}

std::optional<MediumBoundary> read_boundary(Query& query) {
    std::optional<MediumBoundary> boundary;
    bool interior = false, exterior = false;
    for (const Child* child : query.children("medium")) {
        const bool inside = child->name == "interior";
        if (!inside && child->name != "exterior") {
            query.context().faults.add(child->place, query.object().label(),
                                       "a medium has no side; expected `interior` or `exterior` for its name", "");
            continue;
        }
        bool& known = inside ? interior : exterior;
        if (known) query.context().faults.add(child->place, query.object().label(), "holds more than one " + child->name + " medium", "keep one of them");
        known = true;
        const int medium = read_medium(query.context(), *child->object);
        if (!query.context().absorbs_media) continue;
        if (!boundary) boundary.emplace();
        (inside ? boundary->interior : boundary->exterior) = medium;
    }
    return boundary;
}

int read_surrounding_medium(Query& query) {
    const std::vector<const Child*> media = query.children("medium");
    if (media.size() > 1) query.fault("holds more than one medium", "keep one of them");
    return media.empty() ? -1 : read_medium(query.context(), *media.front()->object);
}

std::vector<std::string> medium_types() { return {"homogeneous"}; }
std::vector<std::string> known_medium_types() { return {"heterogeneous", "homogeneous"}; }
std::vector<std::string> known_phase_types() {
    return {"blendphase", "hg", "isotropic", "kkay", "microflake", "mixturephase", "rayleigh", "sggx", "tabphase"};
}
std::vector<std::string> known_volume_types() { return {"constvolume", "gridvolume", "hgridvolume", "volcache"}; }

}  // namespace wavelobe::mitsuba
