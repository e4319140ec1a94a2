// The integrator plugins.
#include <array>
#include <limits>

#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

namespace {

constexpr std::int64_t int_max = std::numeric_limits<int>::max();

Integrator read_path(Query& query) {
    Integrator integrator;
    integrator.max_depth = static_cast<int>(query.integer("max_depth", -1, -1, int_max));
    integrator.rr_depth = static_cast<int>(query.integer("rr_depth", 5, 1, int_max));
    return integrator;
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
    Integrator integrator;
    integrator.max_depth = 2;
    return integrator;
}

struct Plugin {
    const char* name;
    Integrator (*read)(Query&);
};
constexpr std::array<Plugin, 4> plugins{{
    {"direct", read_direct},
    {"path", read_path},
    {"volpath", read_path},
    {"volpathmis", read_path},
}};

}  // namespace

void read_integrator(Context& context, const Object& object) {
    const auto* plugin = find_plugin(context, object, plugins);
    if (plugin == nullptr) return;
    Query query(context, object);
    if (++context.integrators > 1) query.fault("the scene has an integrator already", "keep one of them");
    Integrator integrator = plugin->read(query);
    integrator.hide_emitters = query.boolean("hide_emitters", false);
    if (sees_media(object.type)) query.accept({"use_spectral_mis"});
    query.accept({"block_size", "samples_per_pass", "timeout"});
    query.finish();
    context.scene.integrator = integrator;
}

bool sees_media(const std::string& integrator) { return integrator.starts_with("volpath"); }

std::vector<std::string> integrator_types() { return names_of(plugins); }

}  // namespace wavelobe::mitsuba
