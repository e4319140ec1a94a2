#include "scene/presence.h"

#include <algorithm>
#include <limits>

namespace wavelobe {

// Of the red channel. Interpolated values lie between those of texels; NaN counts as partial.
PresenceFinder::Range PresenceFinder::texture_range(const Texture& texture) {
    const auto [entry, added] = ranges_.try_emplace(&texture);
    Range& range = entry->second;
    if (!added) return range;
    if (const auto* board = std::get_if<Checkerboard>(&texture.source)) {
        const auto [low, high] = std::minmax(board->color0.r, board->color1.r);
        return range = {low, high};
    }
    const Bitmap& bitmap = std::get<Bitmap>(texture.source);
    range = {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i + 2 < bitmap.rgb.size(); i += 3) {
        if (!(bitmap.rgb[i] == bitmap.rgb[i])) return range = {-1.0F, 2.0F};
        range.low = std::min(range.low, bitmap.rgb[i]);
        range.high = std::max(range.high, bitmap.rgb[i]);
    }
    return range;
}

Presence PresenceFinder::find(const Shape& shape) {
    const Opacity& opacity = shape.material.opacity;
    Range range{opacity.value.value.r, opacity.value.value.r};
    if (opacity.value.texture) {
        range = texture_range(*opacity.value.texture);
        range = {range.low * opacity.texture_scale, range.high * opacity.texture_scale};
    }
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry); mesh != nullptr && !mesh->alphas.empty()) {
        const auto [low, high] = std::minmax_element(mesh->alphas.begin(), mesh->alphas.end());
        range = {range.low * *low, range.high * *high};
    }
    // Interpolation between equal texels may round: opaque but for a millionth is opaque.
    constexpr float rounding = 8.0F * std::numeric_limits<float>::epsilon();
    const float whole = opacity.cutoff ? *opacity.cutoff : 1.0F - rounding;
    const float some = opacity.cutoff ? *opacity.cutoff : std::numeric_limits<float>::min();
    if (range.low >= whole) return Presence::whole;
    return range.high < some ? Presence::absent : Presence::partial;
}

}  // namespace wavelobe
