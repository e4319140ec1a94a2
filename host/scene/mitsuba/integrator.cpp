// The integrator plugins.
#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string_view>

#include "scene/mitsuba/query.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

constexpr std::int64_t int_max = std::numeric_limits<int>::max();

Integrator read_integrator_object(Context& context, const Object& object);

Integrator read_path(Query& query) {
    Integrator integrator;
    integrator.max_depth = static_cast<int>(query.integer("max_depth", -1, -1, int_max));
    integrator.rr_depth = static_cast<int>(query.integer("rr_depth", 1, 1, int_max));
    return integrator;
}

// Written to be differentiated; their pictures are those of `path`, with another limit where none is given.
Integrator read_replayed(Query& query) {
    Integrator integrator;
    integrator.max_depth = static_cast<int>(query.integer("max_depth", 6, -1, int_max));
    integrator.rr_depth = static_cast<int>(query.integer("rr_depth", 1, 1, int_max));
    integrator.environment_covers = false;
    query.accept({"guiding", "guiding_proj", "guiding_rounds", "project_seed", "sppc", "sppi", "sppp"});
    return integrator;
}

Integrator read_direct_projective(Query& query) {
    Integrator integrator = read_replayed(query);
    integrator.max_depth = 2;
    return integrator;
}

// Light finds the same ways from the emitters to the camera as from the camera to them.
Integrator read_particle_tracer(Query& query) {
    query.warn("replaced by `path`, which computes the same light");
    return read_path(query);
}

Integrator read_volpathmis(Query& query) {
    query.boolean("use_spectral_mis", true);
    return read_path(query);
}

bool is_light_without_extent(const Object& object) {
    constexpr std::array<std::string_view, 4> types{"point", "spot", "directional", "projector"};
    return object.tag == "emitter" && std::ranges::find(types, object.type) != types.end();
}

// Emitted and once-scattered light: paths of at most two edges. How many samples go to which strategy
// does not change the expected picture.
Integrator read_direct(Query& query) {
    const bool separate = query.has("emitter_samples") || query.has("bsdf_samples");
    if (query.has("shading_samples") && separate)
        query.fault("`shading_samples` is given along with `emitter_samples` or `bsdf_samples`",
                    "keep one of the two forms");
    const std::int64_t shading = query.integer("shading_samples", 1, 1, int_max);
    const std::int64_t emitter = query.integer("emitter_samples", shading, 0, int_max);
    const std::int64_t bsdf = query.integer("bsdf_samples", shading, 0, int_max);
    if (emitter + bsdf == 0) query.fault("both sample counts are zero", "take at least one sample of one kind");
    if (emitter > 1 && std::ranges::any_of(query.context().document.objects, is_light_without_extent))
        query.warn("Mitsuba 3.9 shows point, spot, directional and projector lights as many times as bright as it takes samples of emitters; here they are as bright as they say");
    Integrator integrator;
    integrator.max_depth = 2;
    integrator.environment_covers = false;
    return integrator;
}

// ---- channels beside the colours --------------------------------------------------------------------------------

// A kind of layer with the ends of its channels' names, as Mitsuba's.
struct LayerName {
    const char* name;
    LayerKind kind;
    const char* ends;
};
constexpr std::array<LayerName, 12> layer_names{{
    {"albedo", LayerKind::albedo, "RGB"},
    {"depth", LayerKind::depth, "T"},
    {"dp_du", LayerKind::dp_du, "XYZ"},
    {"dp_dv", LayerKind::dp_dv, "XYZ"},
    {"duv_dx", LayerKind::duv_dx, "UV"},
    {"duv_dy", LayerKind::duv_dy, "UV"},
    {"geo_normal", LayerKind::geo_normal, "XYZ"},
    {"position", LayerKind::position, "XYZ"},
    {"prim_index", LayerKind::prim_index, "I"},
    {"sh_normal", LayerKind::sh_normal, "XYZ"},
    {"shape_index", LayerKind::shape_index, "I"},
    {"uv", LayerKind::uv, "UV"},
}};

void add_channels(std::vector<PictureChannel>& channels, const std::string& name, LayerKind kind, const std::string& ends) {
    for (std::size_t i = 0; i < ends.size(); ++i) channels.push_back({name + "." + ends[i], kind, static_cast<int>(i), false});
}

void add_layer(Query& query, const std::string& token, std::vector<PictureChannel>& channels) {
    const std::size_t colon = token.find(':');
    const std::string name = token.substr(0, colon);
    const std::string type = colon == std::string::npos ? "" : token.substr(colon + 1);
    if (name.empty() || type.empty())
        return query.fault_at("aovs", "cannot read `" + token + "` in `aovs`; expected name:type, such as `normals:sh_normal`", "");
    for (const LayerName& layer : layer_names)
        if (type == layer.name) return add_channels(channels, name, layer.kind, layer.ends);
    query.fault_at("aovs", "`" + type + "` is no type of layer; expected one of " + quoted_list(names_of(layer_names)),
                   suggestion(type, names_of(layer_names)));
}

// The one integrator inside another, and the name of its channels; without one there is no light in the picture.
struct Nested {
    std::string name;
    Integrator integrator;
};

std::optional<Nested> read_nested(Query& query) {
    const std::vector<const Child*> children = query.children("integrator");
    if (children.size() > 1)
        query.fault_at(children[1]->name, "holds more than one integrator; here the picture has the light of one", "keep the first");
    if (children.empty()) return std::nullopt;
    // Mitsuba numbers what has no name.
    const std::string& name = children.front()->name;
    return Nested{name.empty() ? "_arg_0" : name, read_integrator_object(query.context(), *children.front()->object)};
}

Integrator without_light() {
    Integrator integrator;
    integrator.max_depth = 1;
    integrator.radiance = false;
    return integrator;
}

Integrator read_aov(Query& query) {
    const std::optional<Nested> nested = read_nested(query);
    Integrator integrator = nested ? nested->integrator : without_light();
    std::vector<PictureChannel> channels;
    if (nested) {
        add_channels(channels, nested->name, LayerKind::rgb, "RGB");
        add_channels(channels, nested->name, LayerKind::coverage, "A");
        for (PictureChannel channel : integrator.channels) {
            channel.name = nested->name + "." + channel.name;
            channels.push_back(std::move(channel));
        }
    }
    if (!query.has("aovs")) query.fault("the property `aovs` is missing", "list name:type pairs, such as `depth:depth`");
    for (const std::string& token : split(query.text("aovs", ""))) add_layer(query, token, channels);
    integrator.channels = std::move(channels);
    return integrator;
}

// Every channel of what is nested, and its square.
Integrator read_moment(Query& query) {
    const std::optional<Nested> nested = read_nested(query);
    if (!nested) {
        query.fault("holds no integrator to take moments of", "nest one, such as <integrator type=\"path\"/>");
        return {};
    }
    Integrator integrator = nested->integrator;
    std::vector<PictureChannel> channels;
    for (PictureChannel channel : integrator.channels) {
        if (channel.squared) {
            query.fault("moments of moments are not supported", "nest another integrator");
            return integrator;
        }
        channel.name = nested->name + "." + channel.name;
        channels.push_back(std::move(channel));
    }
    add_channels(channels, nested->name, LayerKind::xyz, "XYZ");
    const std::size_t count = channels.size();
    for (std::size_t i = 0; i < count; ++i)
        channels.push_back({"m2_" + channels[i].name, channels[i].kind, channels[i].component, true});
    integrator.channels = std::move(channels);
    return integrator;
}

void refuse_equal_names(Query& query, const Integrator& integrator) {
    std::set<std::string> names{"R", "G", "B"};
    for (const PictureChannel& channel : integrator.channels)
        if (!names.insert(channel.name).second)
            query.fault("two channels of the picture have the name `" + channel.name + "`", "give each a name of its own");
}

struct Plugin {
    const char* name;
    Integrator (*read)(Query&);
    bool holds_another;
};
// Without media `volpath` computes what `path` does.
constexpr std::array<Plugin, 12> plugins{{
    {"aov", read_aov, true},
    {"direct", read_direct, false},
    {"direct_projective", read_direct_projective, false},
    {"moment", read_moment, true},
    {"path", read_path, false},
    {"prb", read_replayed, false},
    {"prb_basic", read_replayed, false},
    {"prb_projective", read_replayed, false},
    {"prbvolpath", read_replayed, false},
    {"ptracer", read_particle_tracer, false},
    {"volpath", read_path, false},
    {"volpathmis", read_volpathmis, false},
}};

Integrator read_integrator_object(Context& context, const Object& object) {
    const auto* plugin = find_plugin(context, object, plugins);
    if (plugin == nullptr) return {};
    Query query(context, object);
    Integrator integrator = plugin->read(query);
    if (plugin->holds_another) query.boolean("hide_emitters", false);
    else integrator.hide_emitters = query.boolean("hide_emitters", false);
    query.accept({"block_size", "samples_per_pass", "timeout"});
    query.finish();
    return integrator;
}

}  // namespace

void read_integrator(Context& context, const Object& object) {
    Query query(context, object);
    if (++context.integrators > 1) query.fault("the scene has an integrator already", "keep one of them");
    const Integrator integrator = read_integrator_object(context, object);
    refuse_equal_names(query, integrator);
    context.scene.integrator = integrator;
}

bool sees_media(const Object& integrator) {
    return integrator.type.starts_with("volpath") || integrator.type == "prbvolpath" ||
           std::ranges::any_of(integrator.children, [](const Child& c) { return c.object != nullptr && sees_media(*c.object); });
}

std::vector<std::string> integrator_types() { return names_of(plugins); }

}  // namespace wavelobe::mitsuba
