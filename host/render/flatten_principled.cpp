// The principled materials as kernels read them.
#include "render/flatten_materials.h"

namespace wavelobe {
namespace {

constexpr std::uint32_t bit(LobeIndex lobe) { return 1U << lobe; }

// Whether the parameter is below the value somewhere.
bool falls_below(const Parameter& p, float value) { return p.texture != nullptr || p.value.x < value; }
bool is_above_zero(const Parameter& p) { return p.texture != nullptr || p.value.x > 0.0F; }

}  // namespace

PrincipledParameters MaterialFlattener::principled_parameters(DeviceMaterial& out, const PrincipledSurface& surface) {
    out.diffuse = rgb(surface.base_color);
    out.alpha_u = scalar(surface.roughness);
    out_.features.ggx = true;
    out_.features.anisotropy = out_.features.anisotropy || is_above_zero(surface.anisotropic);
    PrincipledParameters p{};
    p.anisotropic = scalar(surface.anisotropic);
    p.spec_trans = scalar(surface.spec_trans);
    p.spec_tint = scalar(surface.spec_tint);
    p.sheen = scalar(surface.sheen);
    p.sheen_tint = scalar(surface.sheen_tint);
    p.flatness = scalar(surface.flatness);
    for (TexturedFloat* absent : {&p.clearcoat, &p.clearcoat_gloss, &p.diff_trans, &p.eta}) absent->texture = WAVELOBE_NONE;
    return p;
}

void MaterialFlattener::fill(DeviceMaterial& out, const Principled& m) {
    out.lobes = bit(LOBE_PRINCIPLED);
    if (falls_below(m.metallic, 1.0F) && falls_below(m.surface.spec_trans, 1.0F)) out.lobes |= bit(LOBE_PRINCIPLED_BASE);
    if (m.transmissive) out.flags |= MATERIAL_TRANSMISSIVE;
    out.eta.x = m.eta;
    out.metallic = scalar(m.metallic);
    PrincipledParameters p = principled_parameters(out, m.surface);
    p.clearcoat = scalar(m.clearcoat);
    p.clearcoat_gloss = scalar(m.clearcoat_gloss);
    out.extension = add_extension(p);
}

void MaterialFlattener::fill(DeviceMaterial& out, const PrincipledThin& m) {
    if (is_above_zero(m.surface.spec_trans)) out.lobes |= bit(LOBE_PRINCIPLED_THIN);
    if (falls_below(m.surface.spec_trans, 1.0F)) out.lobes |= bit(LOBE_PRINCIPLED_THIN_BASE);
    out.flags |= MATERIAL_TRANSMISSIVE;
    out.eta.x = 1.0F;  // light goes on in the medium it came from
    PrincipledParameters p = principled_parameters(out, m.surface);
    p.diff_trans = scalar(m.diff_trans);
    p.eta = scalar(m.eta);
    out.extension = add_extension(p);
}

}  // namespace wavelobe
