// What the kernels' lists say of each lobe, light, layer and stage.
#pragma once

#include <array>
#include <cstdint>

#include "render/features.h"
#include "shared/block.h"
#include "shared/materials.h"

namespace wavelobe {

struct LobeEntry {
    const char* name;
    const char* macro;
    std::uint32_t lobe_class;
};

inline constexpr std::array<LobeEntry, LOBE_COUNT> lobe_list = {{
#define LOBE(name, NAME, class_name) {#name, #NAME, LOBE_CLASS_##class_name},
#include "bsdf/lobes.def"
#undef LOBE
}};

enum class Reach { SURFACE, ENVIRONMENT, DELTA };

struct LightEntry {
    const char* name;
    const char* macro;
    Reach reach;
};

inline constexpr std::array<LightEntry, LIGHT_KIND_COUNT> light_list = {{
#define LIGHT(name, NAME, reach) {#name, #NAME, Reach::reach},
#include "lights/lights.def"
#undef LIGHT
}};

struct LayerEntry {
    const char* name;
    const char* macro;
    std::size_t width;
};

inline constexpr std::array<LayerEntry, LAYER_COUNT> layer_list = {{
#define LAYER(name, NAME, width) {#name, #NAME, width},
#include "layers/layers.def"
#undef LAYER
}};

struct StageEntry {
    const char* name;
    const char* macro;
};

inline constexpr std::array<StageEntry, STAGE_COUNT> stage_list = {{
#define STAGE(name, NAME) {#name, #NAME},
#include "stages/stages.def"
#undef STAGE
}};

inline bool has_bit(std::uint32_t mask, std::size_t bit) { return ((mask >> bit) & 1U) != 0; }

}  // namespace wavelobe
