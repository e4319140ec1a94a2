// The source of a scene's program (render/features.h).
#include <algorithm>
#include <array>
#include <sstream>

#include "render/feature_tables.h"
#include "shared/lights.h"

namespace wavelobe {
namespace {

class SourceWriter {
public:
    void define(const std::string& name, long value) { text_ << "#define " << name << " " << value << "\n"; }
    void define_unsigned(const std::string& name, long value) { text_ << "#define " << name << " " << value << "u\n"; }
    void include(const std::string& path) { text_ << "#include \"" << path << "\"\n"; }
    void begin_list(const std::string& name) { text_ << "#define " << name << "(X)"; }
    void list_item(const char* name, const char* macro) { text_ << " X(" << name << ", " << macro << ")"; }
    void list_item(const char* name, const char* macro, std::size_t width) {
        text_ << " X(" << name << ", " << macro << ", " << width << "u)";
    }
    void end_list() { text_ << "\n"; }
    void line(const std::string& text) { text_ << text << "\n"; }
    std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
};

void write_macros(SourceWriter& out, const FeatureSet& f) {
    out.define("HAS_TEXTURES", f.textures);
    out.define("HAS_TEXTURED_EMITTERS", f.textured_emitters);
    out.define("HAS_SMOOTH_NORMALS", f.smooth_normals);
    out.define("HAS_SMOOTH_TERMINATOR", f.smooth_terminator);
    out.define("HAS_CAUSTICS", f.caustics);
    out.define("HAS_PATH_ETA", f.transmission || f.caustics);
    out.define("HAS_UVS", f.uvs);
    out.define("HAS_SECOND_UVS", f.second_uvs);
    out.define("HAS_VERTEX_COLORS", f.vertex_colors);
    out.define("HAS_VERTEX_OPACITY", f.vertex_opacity);
    out.define("HAS_UNSAMPLED_EMITTERS", f.unsampled_emitters);
    out.define("HAS_ANALYTIC", f.analytic);
    out.define("HAS_INSTANCES", f.instances);
    out.define("HAS_ANISOTROPY", f.anisotropy);
    out.define("HAS_COAT_NORMALS", f.coat_normals);
    out.define("HAS_SHEEN", has_bit(f.lobes, LOBE_SHEEN_METALLIC_ROUGHNESS_BASE));
    out.define("HAS_TANGENTS", f.anisotropy || f.normal_maps || f.coat_normals);
    out.define("HAS_VERTEX_TANGENTS", f.vertex_tangents);
    out.define("HAS_NORMAL_MAPS", f.normal_maps);
    out.define("HAS_BUMP_MAPS", f.bump_maps);
    out.define("HAS_NESTED_SIDES", f.nested_sides);
    out.define("HAS_BLENDS", f.blends);
    out.define("HAS_NESTING", f.material_levels > 0);
    out.define_unsigned("MATERIAL_LEVELS", f.material_levels);
    out.define("HAS_TRANSMISSION", f.transmission);
    out.define("HAS_LAYERED_LOBES", has_bit(f.lobes, LOBE_LAYERED_METALLIC_ROUGHNESS));
    out.define("HAS_UNLIKE_SIDES", f.unlike_sides);
    out.define("HAS_CULLED_BACKS", f.culled_backs);
    out.define("HAS_LOBE_CHOICE", f.lobe_choice);
    out.define("HAS_MIXTURE", f.mixture);
    out.define("HAS_GGX", f.ggx);
    out.define("HAS_BECKMANN", f.beckmann);
    out.define("HAS_ORTHOGRAPHIC", f.orthographic);
    out.define("HAS_THIN_LENS", f.thin_lens);
    out.define("HAS_SIGNED_FILTER", f.signed_filter);
    out.define("HAS_ERROR_ESTIMATE", f.error_estimate);
    out.define("ESTIMATOR", static_cast<long>(f.estimator));
    out.define("INDEPENDENT_SAMPLES", f.independent_samples);
    out.define("HIDE_EMITTERS", f.hide_emitters);
    out.define_unsigned("EMISSION_RAYS", f.emission_rays);
    if (has_bit(f.layers, LAYER_COVERAGE)) out.define("ENVIRONMENT_COVERS", f.environment_covers);
    out.define("HAS_MASKS", f.masks);
    out.define("HAS_VEILED_EMITTERS", f.veiled_emitters);
    out.define("HAS_MEDIA", f.media);
    out.define("HAS_CLEAR_BOUNDARIES", f.clear_boundaries);
    out.define("HAS_OPACITY", f.masks || f.veiled_emitters);
    out.define("HAS_DELTA_LOBES", f.has_lobe_class(LOBE_CLASS_DELTA));
    out.define("HAS_GLOSSY_LOBES", f.has_lobe_class(LOBE_CLASS_GLOSSY));
    out.define("HAS_DIFFUSE_LOBES", f.has_lobe_class(LOBE_CLASS_DIFFUSE));
    out.define("HAS_LIGHTS", f.light_count > 0);
    out.define("HAS_SURFACE_LIGHTS", f.has_surface_lights());
    out.define("HAS_ENVIRONMENT", f.has_environment());
    // One light needs no choice; of several the kernels are told the number at run time.
    out.define("LIGHT_COUNT", std::min(f.light_count, 2));
    out.define("HAS_LIGHT_TREE", f.light_tree());
    // So few that the root has them all: the kernels are told how many.
    out.define("PLACED_LIGHTS", f.placed_lights <= LIGHT_CHILDREN ? f.placed_lights : 0);
    out.define("HAS_GLOSSY_RECEIVERS", f.glossy_receivers());
    out.define("HAS_LIGHT_RANGE", f.light_range);
    out.define("HAS_SMOOTH_CONES", f.smooth_cones);
    out.define("HAS_FEW_TRIANGLES", f.few_triangles);
    out.define("HAS_FACETS", f.facets());
    if (f.few_triangles) return;
    out.define_unsigned("BVH_STACK", f.bvh_stack);
    out.define_unsigned("WALKS", f.walks);
}

void write_lobes(SourceWriter& out, const FeatureSet& f) {
    for (std::size_t i = 0; i < lobe_list.size(); ++i) {
        out.define_unsigned(std::string("LOBE_") + lobe_list[i].macro, static_cast<long>(i));
    }
    for (std::size_t i = 0; i < lobe_list.size(); ++i) {
        out.define(std::string("HAS_LOBE_") + lobe_list[i].macro, has_bit(f.lobes, i));
        if (has_bit(f.lobes, i)) out.include(std::string("bsdf/") + lobe_list[i].name + ".h");
    }
    constexpr std::array<const char*, 3> lists = {"SCENE_DELTA_LOBES", "SCENE_GLOSSY_LOBES", "SCENE_DIFFUSE_LOBES"};
    for (std::uint32_t lobe_class = 0; lobe_class < lists.size(); ++lobe_class) {
        out.begin_list(lists[lobe_class]);
        for (std::size_t i = 0; i < lobe_list.size(); ++i) {
            if (has_bit(f.lobes, i) && lobe_list[i].lobe_class == lobe_class) {
                out.list_item(lobe_list[i].name, lobe_list[i].macro);
            }
        }
        out.end_list();
    }
}

void write_light_list(SourceWriter& out, const FeatureSet& f, const char* name, const Reach* reach) {
    out.begin_list(name);
    for (std::size_t i = 0; i < light_list.size(); ++i) {
        if (has_bit(f.light_kinds, i) && (reach == nullptr || light_list[i].reach == *reach)) {
            out.list_item(light_list[i].name, light_list[i].macro);
        }
    }
    out.end_list();
}

void write_lights(SourceWriter& out, const FeatureSet& f) {
    for (std::size_t i = 0; i < light_list.size(); ++i) {
        out.define_unsigned(std::string("LIGHT_") + light_list[i].macro, static_cast<long>(i));
        out.define(std::string("HAS_LIGHT_") + light_list[i].macro, has_bit(f.light_kinds, i));
    }
    if (f.light_count == 0) return;
    for (std::size_t i = 0; i < light_list.size(); ++i) {
        if (has_bit(f.light_kinds, i)) out.include(std::string("lights/") + light_list[i].name + ".h");
    }
    constexpr Reach surface = Reach::SURFACE;
    constexpr Reach environment = Reach::ENVIRONMENT;
    write_light_list(out, f, "SCENE_LIGHTS", nullptr);
    write_light_list(out, f, "SCENE_SURFACE_LIGHTS", &surface);
    write_light_list(out, f, "SCENE_ENVIRONMENT_LIGHTS", &environment);
}

void write_layers(SourceWriter& out, const FeatureSet& f) {
    out.define("HAS_LAYERS", f.layers != 0);
    out.define("HAS_MOMENTS", f.moments);
    if (f.layers == 0) return;
    constexpr std::uint32_t differential = 1U << LAYER_DP_DU | 1U << LAYER_DP_DV | 1U << LAYER_DUV_DX | 1U << LAYER_DUV_DY;
    out.define("HAS_LAYER_PARTIALS", (f.layers & differential) != 0);
    out.define("HAS_LAYER_COVERAGE", has_bit(f.layers, LAYER_COVERAGE));
    out.define("HAS_LAYER_SQUARES", f.layer_squares);
    out.define_unsigned("LAYER_CHANNELS", static_cast<long>(f.layer_channels()));
    out.begin_list("SCENE_LAYERS");
    for (std::size_t i = 0; i < layer_list.size(); ++i) {
        if (has_bit(f.layers, i)) out.list_item(layer_list[i].name, layer_list[i].macro, layer_list[i].width);
    }
    out.end_list();
}

}  // namespace

std::string program_source(const FeatureSet& features, int lanes, int block_slots, Driver driver) {
    SourceWriter out;
    out.define("LANES", lanes);
    out.define_unsigned("BLOCK_SLOTS", block_slots);
    // One at a time where each is written down.
    out.define_unsigned("SLOTS_TO_START", driver == Driver::replay ? lanes : block_slots);
    write_macros(out, features);
    write_layers(out, features);
    write_lobes(out, features);
    write_lights(out, features);
    for (const std::string& stage : features.stages()) out.include("stages/" + stage + ".h");
    if (driver != Driver::staged) {
        out.begin_list("SCENE_STAGES");
        for (std::uint32_t i = 0; i < STAGE_COUNT; ++i) {
            if (features.has_stage(i)) out.list_item(stage_list[i].name, stage_list[i].macro);
        }
        out.end_list();
        out.include(driver == Driver::replay ? "stages/replay.h" : "stages/render_tiles.h");
    } else {
        out.include("stages/stage_kernel.h");
        for (const std::string& stage : features.stages()) out.line("STAGE_KERNEL(" + stage + ")");
    }
    if (features.caustics) {
        out.include("caustics/photons.h");
        out.include("caustics/build_maps.h");
    }
    return out.text();
}

}  // namespace wavelobe
