#include "scene/gltf/instancing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wavelobe::gltf {

namespace {

constexpr std::size_t most_instances = std::size_t{1} << 20;

}  // namespace

std::vector<glm::dmat4> instances_of(Document& document, const Accessors& accessors, std::size_t node) {
    const Element extension = document.nodes[node].extension("EXT_mesh_gpu_instancing");
    if (!extension.present()) return {glm::dmat4(1.0)};
    extension.require("attributes");
    const Element attributes = extension.object("attributes");
    std::size_t count = 0;
    const auto read = [&](const char* name, std::size_t components) -> std::vector<float> {
        const auto index = attributes.index(name, accessors.size(), "accessors");
        if (!index || !accessors[*index].readable) return {};
        const Accessor& accessor = accessors[*index];
        if (accessor.components != components) {
            attributes.fault(fmt::format("{} is accessor {} of type {}; expected VEC{}", name, *index, accessor.type, components));
            return {};
        }
        if (count > 0 && accessor.count != count)
            attributes.fault(fmt::format("{} has {} elements, and another attribute {}", name, accessor.count, count));
        if (accessor.count > most_instances) attributes.fault(fmt::format("{} instances; expected at most {}", accessor.count, most_instances));
        count = accessor.count;
        std::vector<float> values = accessors.floats(*index);
        if (std::any_of(values.begin(), values.end(), [](float v) { return !std::isfinite(v); }))
            attributes.fault(fmt::format("{}: accessor {} has values that are not finite", name, *index));
        return values;
    };
    const std::vector<float> translations = read("TRANSLATION", 3);
    const std::vector<float> rotations = read("ROTATION", 4);
    const std::vector<float> scales = read("SCALE", 3);
    std::vector<glm::dmat4> out;
    if (!document.faults.empty()) return out;
    for (std::size_t i = 0; i < count; ++i) {
        LocalTransform t;
        if (!translations.empty()) t.translation = {translations[3 * i], translations[3 * i + 1], translations[3 * i + 2]};
        if (!scales.empty()) t.scale = {scales[3 * i], scales[3 * i + 1], scales[3 * i + 2]};
        if (!rotations.empty()) {
            const glm::dquat q(rotations[4 * i + 3], rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2]);
            if (glm::length(q) > 0.0) t.rotation = glm::normalize(q);
        }
        out.push_back(t.to_parent());
    }
    return out;
}

}  // namespace wavelobe::gltf
