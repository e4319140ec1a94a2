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

struct FeatureSet {
    std::uint32_t lobes = 0;        // bit a lobe
    std::uint32_t light_kinds = 0;  // bit a kind of light
    int light_count = 0;
    bool textures = false;           // materials
    bool textured_emitters = false;
    bool smooth_normals = false;
    bool uvs = false;
    bool vertex_colors = false;
    bool analytic = false;
    bool instances = false;
    bool anisotropy = false;
    bool normal_maps = false;   // or bump maps
    bool bump_maps = false;
    bool nested_sides = false;  // materials inside others differ between sides or are turned over
    bool blends = false;
    int material_levels = 0;    // of materials that hold others, at the most
    bool transmission = false;
    bool unlike_sides = false; // some surface is black behind, or of another material
    bool lobe_choice = false;  // the class of lobes depends on more than the shape
    bool mixture = false;      // some material is both glossy and diffuse
    bool ggx = false;
    bool beckmann = false;
    bool hide_emitters = false;
    bool signed_filter = false;  // samples have weights, negative ones among them
    bool error_estimate = false; // the film is kept in two independent halves
    bool masks = false;            // rays pass some primitives, by their opacity
    bool veiled_emitters = false;  // paths go on behind some emitters
    Estimator estimator = Estimator::mis;
    bool independent_samples = false;
    bool light_tree = false;   // several lights with a place: chosen by a tree
    bool few_triangles = false;  // no hierarchy: every triangle is tested
    int bvh_stack = 64;          // entries of the traversal stack

    bool has_lobe_class(std::uint32_t lobe_class) const;
    bool has_surface_lights() const;
    bool has_environment() const;

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
