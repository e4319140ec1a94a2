#include "render/features.h"

#include "render/feature_tables.h"

namespace wavelobe {
namespace {

bool has_reach(const FeatureSet& features, Reach reach) {
    for (std::size_t i = 0; i < light_list.size(); ++i) {
        if (has_bit(features.light_kinds, i) && light_list[i].reach == reach) return true;
    }
    return false;
}

}  // namespace

std::size_t FeatureSet::layer_offset(std::uint32_t layer, bool squared) const {
    std::size_t before = 0, all = 0;
    for (std::size_t i = 0; i < layer_list.size(); ++i) {
        if (!has_bit(layers, i)) continue;
        if (i < layer) before += layer_list[i].width;
        all += layer_list[i].width;
    }
    return 1 + before + (squared ? all : 0);
}

std::size_t FeatureSet::layer_channels() const { return layers == 0 ? 0 : layer_offset(LAYER_COUNT, layer_squares); }

std::uint32_t lobe_class(std::uint32_t lobe) { return lobe_list[lobe].lobe_class; }

bool FeatureSet::has_lobe_class(std::uint32_t wanted) const {
    for (std::size_t i = 0; i < lobe_list.size(); ++i) {
        if (has_bit(lobes, i) && lobe_list[i].lobe_class == wanted) return true;
    }
    return false;
}

bool FeatureSet::glossy_receivers() const { return light_tree() && has_lobe_class(LOBE_CLASS_GLOSSY); }

bool FeatureSet::has_surface_lights() const { return has_reach(*this, Reach::SURFACE); }
bool FeatureSet::has_environment() const { return has_reach(*this, Reach::ENVIRONMENT); }

std::vector<std::string> FeatureSet::names() const {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < lobe_list.size(); ++i) {
        if (has_bit(lobes, i)) out.push_back(std::string("lobe:") + lobe_list[i].name);
    }
    for (std::size_t i = 0; i < light_list.size(); ++i) {
        if (has_bit(light_kinds, i)) out.push_back(std::string("light:") + light_list[i].name);
    }
    const auto add = [&out](bool present, const char* name) {
        if (present) out.emplace_back(name);
    };
    for (std::size_t i = 0; i < layer_list.size(); ++i) {
        if (has_bit(layers, i)) out.push_back(std::string("layer:") + layer_list[i].name);
    }
    add(moments, "moments");
    add(light_count > 1, "light_choice");
    add(textures, "textures");
    add(textured_emitters, "textured_emitters");
    add(smooth_normals, "smooth_normals");
    add(smooth_terminator, "smooth_terminator");
    add(caustics, "caustics");
    add(uvs, "uvs");
    add(second_uvs, "second_uvs");
    add(vertex_colors, "vertex_colors");
    add(vertex_opacity, "vertex_opacity");
    add(unsampled_emitters, "unsampled_emitters");
    add(analytic, "analytic_shapes");
    add(instances, "instances");
    add(walks > 1, "walks_in_turn");
    add(anisotropy, "anisotropy");
    add(coat_normals, "coat_normals");
    add(vertex_tangents, "vertex_tangents");
    add(normal_maps, "normal_maps");
    add(bump_maps, "bump_maps");
    add(nested_sides, "nested_sides");
    add(blends, "blends");
    add(transmission, "transmission");
    add(unlike_sides, "unlike_sides");
    add(lobe_choice, "lobe_choice");
    add(mixture, "mixture");
    add(ggx, "ggx");
    add(beckmann, "beckmann");
    add(hide_emitters, "hide_emitters");
    add(orthographic, "orthographic");
    add(thin_lens, "thin_lens");
    add(signed_filter, "signed_filter");
    add(error_estimate, "error_estimate");
    add(emission_rays > 0, "emission_rays");
    add(masks, "masks");
    add(veiled_emitters, "veiled_emitters");
    add(media, "media");
    add(clear_boundaries, "clear_boundaries");
    add(light_tree(), "light_tree");
    add(few_triangles, "few_triangles");
    return out;
}

bool FeatureSet::has_stage(std::uint32_t stage) const {
    const bool glossy = has_lobe_class(LOBE_CLASS_GLOSSY);
    const bool diffuse = has_lobe_class(LOBE_CLASS_DIFFUSE);
    switch (stage) {
        case STAGE_RECORD_LAYERS: return layers != 0;
        case STAGE_INTERSECT_SHADOW: return light_count > 0 && (glossy || diffuse);
        case STAGE_SHADE_ESCAPED: return has_environment();
        case STAGE_SHADE_EMITTED: return has_surface_lights();
        case STAGE_SCATTER_DELTA: return has_lobe_class(LOBE_CLASS_DELTA);
        case STAGE_SCATTER_GLOSSY: return glossy;
        case STAGE_SCATTER_DIFFUSE: return diffuse;
        default: return true;
    }
}

std::vector<std::string> FeatureSet::stages() const {
    std::vector<std::string> out;
    for (std::uint32_t i = 0; i < STAGE_COUNT; ++i) {
        if (has_stage(i)) out.emplace_back(stage_list[i].name);
    }
    return out;
}

const char* stage_name(std::uint32_t stage) { return stage_list[stage].name; }

std::size_t block_words(const FeatureSet& features, int block_slots) {
    const std::size_t stride = static_cast<std::size_t>(block_slots) + QUEUE_PADDING;
    const std::size_t fields = RAY_FIELDS + (features.light_tree() ? 1 : 0) + (features.glossy_receivers() ? 1 : 0) +
                               (features.instances ? 1 : 0) + (features.media ? 1 : 0);
    const std::size_t traced = features.analytic ? fields : fields - 3;  // without the origin
    std::size_t queues = 0;
    if (features.has_environment()) ++queues;
    if (features.has_surface_lights()) ++queues;
    for (const std::uint32_t c : {LOBE_CLASS_DELTA, LOBE_CLASS_GLOSSY, LOBE_CLASS_DIFFUSE}) {
        if (features.has_lobe_class(c)) ++queues;
    }
    return stride * (fields + queues * traced + SHADOW_FIELDS + (features.media ? 1 : 0) + (features.facets() ? 1 : 0)) +
           std::size_t{3} * TILE_PIXELS * BLOCK_SAMPLES;
}

}  // namespace wavelobe
