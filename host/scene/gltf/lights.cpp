#include "scene/gltf/lights.h"

#include <cmath>

#include <fmt/format.h>

namespace wavelobe::gltf {

namespace {

struct Punctual {
    std::string type;
    Rgb intensity{1.0F};
    double inner = 0.0;  // radians from the axis
    double outer = 0.0;
    float range = 0.0F;  // 0: none
};

Punctual read_light(const Element& light) {
    Punctual out;
    light.require("type");
    out.type = light.text("type", "point");
    if (out.type != "point" && out.type != "spot" && out.type != "directional")
        light.fault("type `" + out.type + "`; expected directional, point or spot");
    const auto color = light.vector<3>("color", {1, 1, 1}, {0.0, 1e30});
    out.intensity = Rgb{color[0], color[1], color[2]} * static_cast<float>(light.number("intensity", 1.0, {0.0, 1e30}));
    if (light.has("range")) out.range = static_cast<float>(light.number("range", 1.0, {1e-30, 1e30}));
    if (out.type == "spot") light.require("spot");
    const Element spot = light.object("spot");
    constexpr double quarter = 1.5707963267948966;
    out.inner = spot.number("innerConeAngle", 0.0, {0.0, quarter + 1e-6});
    out.outer = spot.number("outerConeAngle", 0.5 * quarter, {1e-6, quarter + 1e-6});
    if (out.type == "spot" && out.inner >= out.outer) spot.fault("`innerConeAngle` is not below `outerConeAngle`");
    return out;
}

// Ours shine along +z, those of glTF along -Z.
glm::mat4 turned(const glm::dmat4& world) {
    const glm::dvec3 forward = -glm::normalize(glm::dvec3(world[2]));
    const glm::dvec3 helper = std::abs(forward.y) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 left = glm::normalize(glm::cross(helper, forward));
    return glm::mat4(glm::vec4(left, 0), glm::vec4(glm::cross(forward, left), 0), glm::vec4(forward, 0), glm::vec4(world[3]));
}

Emitter emitter_of(const Punctual& light, const glm::dmat4& world) {
    const glm::mat4 frame = turned(world);
    if (light.type == "directional") return DirectionalEmitter{glm::vec3(frame[2]), light.intensity};
    if (light.type == "point") return PointEmitter{glm::vec3(world[3]), light.intensity, light.range};
    const auto degrees = [](double radians) { return static_cast<float>(glm::degrees(radians)); };
    return SpotEmitter{frame, light.intensity, degrees(light.outer), degrees(light.inner), light.range, true};
}

}  // namespace

void add_punctual_lights(Document& document, const NodeTree& tree, Scene& scene) {
    std::vector<Punctual> lights;
    document.root.extension("KHR_lights_punctual").require("lights");
    document.root.extension("KHR_lights_punctual").refuse_empty("lights");
    for (const Element& light : document.root.extension("KHR_lights_punctual").objects("lights")) lights.push_back(read_light(light));
    const auto light_of = [&](std::size_t node) {
        return document.nodes[node].extension("KHR_lights_punctual").index("light", lights.size(), "lights");
    };
    for (std::size_t node = 0; node < document.nodes.size(); ++node) {
        document.nodes[node].extension("KHR_lights_punctual").require("light");
        light_of(node);
    }
    for (const std::size_t node : tree.shown) {
        const auto index = light_of(node);
        if (!index) continue;
        if (!(glm::length(glm::dvec3(tree.world[node][2])) > 0.0)) {
            document.nodes[node].fault("shrinks its light to nothing", "give it another scale");
            continue;
        }
        scene.emitters.push_back(emitter_of(lights[*index], tree.world[node]));
    }
}

}  // namespace wavelobe::gltf
