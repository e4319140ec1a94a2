// What a scene uses: it decides which stages, lobes and lights are compiled, and nothing else is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/render.h"

namespace wavelobe {

// Indices into lobes.def and lights.def.
enum LobeIndex : std::uint32_t {
#define LOBE(name, NAME, class_name) LOBE_##NAME,
#include "bsdf/lobes.def"
#undef LOBE
    LOBE_COUNT
};

enum LightIndex : std::uint32_t {
#define LIGHT(name, NAME, reach) LIGHT_##NAME,
#include "lights/lights.def"
#undef LIGHT
    LIGHT_KIND_COUNT
};

enum LayerIndex : std::uint32_t {
#define LAYER(name, NAME, width) LAYER_##NAME,
#include "layers/layers.def"
#undef LAYER
    LAYER_COUNT
};

struct FeatureSet {
    std::uint32_t lobes = 0;        // bit a lobe
    std::uint32_t light_kinds = 0;  // bit a kind of light
    std::uint32_t layers = 0;       // bit a layer
    bool layer_squares = false;     // the film holds the squares of layers, too
    bool moments = false;           // ... of the samples' colours
    int light_count = 0;
    bool textures = false;           // materials
    bool textured_emitters = false;
    bool smooth_normals = false;
    bool smooth_terminator = false;  // light leaves the curved surface that they stand for
    bool caustics = false;           // photons guide paths to them
    bool uvs = false;
    bool second_uvs = false;         // some texture uses the second set of coordinates
    bool vertex_colors = false;
    bool vertex_opacity = false;     // some vertices have an opacity of their own
    bool unsampled_emitters = false; // some emission is found by paths alone
    bool analytic = false;
    bool instances = false;
    bool vertex_tangents = false;    // some vertices have tangents of their own
    bool anisotropy = false;
    bool coat_normals = false;       // some coats have normals of their own
    bool normal_maps = false;   // or bump maps
    bool bump_maps = false;
    bool nested_sides = false;  // materials inside others differ between sides or are turned over
    bool blends = false;
    int material_levels = 0;    // of materials that hold others, at the most
    bool transmission = false;
    bool unlike_sides = false; // some surface is black behind, or of another material
    bool culled_backs = false;
    bool lobe_choice = false;  // the class of lobes depends on more than the shape
    bool mixture = false;      // some material is both glossy and diffuse
    bool ggx = false;
    bool beckmann = false;
    bool hide_emitters = false;
    bool environment_covers = true;
    bool orthographic = false;
    bool thin_lens = false;
    bool signed_filter = false;  // samples have weights, negative ones among them
    bool error_estimate = false; // the film is kept in two independent halves
    bool masks = false;            // rays pass some primitives, by their opacity
    bool veiled_emitters = false;  // paths go on behind some emitters
    bool light_range = false;  // some point or spot light reaches only so far
    bool smooth_cones = false;
    bool media = false;            // some of space absorbs
    bool clear_boundaries = false; // some shapes part media and are not there otherwise
    int emission_rays = 0;         // of the camera in place of each path's, for the emitters that it sees
    Estimator estimator = Estimator::mis;
    bool independent_samples = false;
    int placed_lights = 0;     // chosen by a tree; 0: there are not several with a place
    bool few_triangles = false;  // no hierarchy: every triangle is tested
    int bvh_stack = 64;          // entries of the traversal stack
    int walks = 1;               // rays that are traced in turn

    bool has_lobe_class(std::uint32_t lobe_class) const;
    bool has_surface_lights() const;
    bool light_tree() const { return placed_lights > 0; }
    bool facets() const { return few_triangles && !masks; }  // of which rays are tested against pairs
    bool glossy_receivers() const;  // lobes have a say in which light is chosen
    bool has_environment() const;

    // Sums of a pixel in the buffer of layers, the number of its samples first; 0 without any.
    std::size_t layer_channels() const;
    // Where in them a layer's first channel is.
    std::size_t layer_offset(std::uint32_t layer, bool squared) const;

    // Names of everything compiled in, for people and tests.
    std::vector<std::string> names() const;
    bool has_stage(std::uint32_t stage) const;  // STAGE_x
    // Stages in order of the pipeline.
    std::vector<std::string> stages() const;
};

// The source of the scene's program: feature macros, the headers of its lobes and lights, and its stages, a kernel each or
// all in one.
std::string program_source(const FeatureSet& features, int lanes, int block_slots, Driver driver = Driver::staged);

// Floats a block takes in the buffer of blocks (BLOCK_WORDS of kernels/core/block.h).
std::size_t block_words(const FeatureSet& features, int block_slots);

const char* stage_name(std::uint32_t stage);

// Class of each lobe (LOBE_CLASS_x) and its name.
std::uint32_t lobe_class(std::uint32_t lobe);

}  // namespace wavelobe
