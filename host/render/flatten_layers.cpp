#include "render/flatten_layers.h"

#include <map>

namespace wavelobe {

void flatten_layers(const Scene& scene, DeviceScene& out) {
    out.channels = scene.integrator.channels;
    out.radiance = scene.integrator.radiance;
    FeatureSet& f = out.features;
    for (const PictureChannel& channel : out.channels) {
        const auto layer = static_cast<std::uint32_t>(channel.kind);
        if (layer < LAYER_COUNT) {
            f.layers |= 1U << layer;
            f.layer_squares = f.layer_squares || channel.squared;
        } else {
            f.moments = f.moments || channel.squared;
        }
    }
    if (f.layers == 0) return;
    std::map<const Shape*, std::uint32_t> numbers;
    for (const Shape& shape : scene.shapes) numbers.emplace(&shape, static_cast<std::uint32_t>(numbers.size()) + 1);
    out.parameters.layer_first_instance = static_cast<std::uint32_t>(numbers.size()) + 1;
    for (const Shape* shape : out.shape_sources) {
        const auto number = numbers.find(shape);
        out.layer_shapes.push_back(number == numbers.end() ? 0 : number->second);
    }
}

}  // namespace wavelobe
