// The principled BSDFs.
#include <cmath>

#include "scene/mitsuba/principled.h"

namespace wavelobe::mitsuba {

namespace {

PrincipledSurface read_surface(Query& query) {
    const auto share = [&](const char* name, double otherwise) { return query.scalar_parameter(name, otherwise, not_negative); };
    PrincipledSurface s;
    s.base_color = query.parameter("base_color", 0.5, ColourUse::reflectance);
    s.roughness = share("roughness", 0.5);
    s.anisotropic = query.scalar_parameter("anisotropic", 0.0, {0.0, 1.0});
    s.spec_trans = query.scalar_parameter("spec_trans", 0.0, {0.0, 1.0});
    s.spec_tint = share("spec_tint", 0.0);
    s.sheen = share("sheen", 0.0);
    s.sheen_tint = share("sheen_tint", 0.0);
    s.flatness = share("flatness", 0.0);
    return s;
}

Bsdf make(Query& query, MaterialModel model, bool transmissive) {
    auto material = std::make_shared<const Material>(Material{std::move(model), query.object().id});
    return {material, transmissive ? material : nullptr, transmissive};
}

}  // namespace

Bsdf read_principled(Query& query) {
    // How samples are shared out does not change the picture.
    query.accept({"main_specular_sampling_rate", "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate"});
    Principled m;
    m.surface = read_surface(query);
    m.metallic = query.scalar_parameter("metallic", 0.0, {0.0, 1.0});
    m.clearcoat = query.scalar_parameter("clearcoat", 0.0, not_negative);
    m.clearcoat_gloss = query.scalar_parameter("clearcoat_gloss", 0.0, {0.0, 1.0});
    m.transmissive = m.surface.spec_trans.texture != nullptr || m.surface.spec_trans.value.x > 0.0F;
    const double eta = query.real("eta", 1.5, positive);
    double specular = query.real("specular", 0.5, {0.0, 12.0});
    if (query.has("eta") && query.has("specular"))
        query.fault("both `eta` and `specular` are given", "keep one of the two: each says what the other is");
    if (query.has("eta")) {
        m.eta = m.transmissive && eta == 1.0 ? 1.001F : static_cast<float>(eta);
    } else {
        if (m.transmissive && specular == 0.0) specular = 1e-3;
        m.eta = static_cast<float>(2.0 / (1.0 - std::sqrt(0.08 * specular)) - 1.0);
    }
    return make(query, m, m.transmissive);
}

Bsdf read_principled_thin(Query& query) {
    query.accept({"specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate",
                  "diffuse_transmittance_sampling_rate", "diffuse_reflectance_sampling_rate"});
    PrincipledThin m;
    m.surface = read_surface(query);
    m.eta = query.scalar_parameter("eta", 1.5, positive);
    m.diff_trans = query.scalar_parameter("diff_trans", 0.0, {0.0, 2.0});
    return make(query, m, true);
}

}  // namespace wavelobe::mitsuba
