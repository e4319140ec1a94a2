#include "scene/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace wavelobe::gltf {

namespace {

enum class Interpolation { step, linear, cubic };

struct Keys {
    std::vector<float> times;   // seconds, ascending
    std::vector<float> values;  // `width` a key; three times that for cubic splines: in-tangent, value, out-tangent
    std::size_t width = 0;
    bool given = false;  // whether the values are of the file, not zeros for want of any
    Interpolation interpolation = Interpolation::linear;
};

Keys read_keys(const Document& document, const Element& sampler, const Accessors& accessors) {
    Keys keys;
    for (const char* name : {"input", "output"}) sampler.require(name), accessors.refuse_stride(sampler, name);
    const auto input = sampler.index("input", accessors.size(), "accessors");
    const auto output = sampler.index("output", accessors.size(), "accessors");
    const std::string how = sampler.text("interpolation", "LINEAR");
    if (how == "STEP") keys.interpolation = Interpolation::step;
    else if (how == "CUBICSPLINE") keys.interpolation = Interpolation::cubic;
    else if (how != "LINEAR") sampler.fault("interpolation `" + how + "`; expected LINEAR, STEP or CUBICSPLINE");
    if (!input || !output || !accessors[*input].readable || !accessors[*output].readable) return {};
    const Element& times = document.accessors[*input];
    if (!times.has("min") || !times.has("max"))
        sampler.fault(fmt::format("`input` is accessor {} without `min` and `max`, which times must have", *input));
    if (accessors[*input].components != 1 || accessors[*input].component_type != 5126) {
        sampler.fault("`input` is not of floats");
        return {};
    }
    keys.times = accessors.floats(*input);
    keys.values = accessors.floats(*output);
    keys.given = accessors.has_data(*output);
    const auto finite = [](float v) { return std::isfinite(v); };
    if (!std::all_of(keys.times.begin(), keys.times.end(), finite) || !std::all_of(keys.values.begin(), keys.values.end(), finite)) {
        sampler.fault("has keys that are not finite");
        return {};
    }
    if (keys.interpolation == Interpolation::cubic && keys.times.size() < 2) sampler.fault("has one key; cubic splines need two");
    // Without data they are all 0, which is no time that anything is between.
    if (accessors.has_data(*input) && std::adjacent_find(keys.times.begin(), keys.times.end(), std::greater_equal<>()) != keys.times.end()) {
        sampler.fault("has times that do not ascend");
        return {};
    }
    const std::size_t rows = keys.times.size() * (keys.interpolation == Interpolation::cubic ? 3 : 1);
    keys.width = keys.values.size() / rows;
    if (keys.width == 0 || keys.values.size() % rows != 0) {
        sampler.fault(fmt::format("{} numbers for {} keys", keys.values.size(), keys.times.size()));
        return {};
    }
    return keys;
}

// The value at a time, that of the first or last key outside their range (specification, section 3.11 and appendix C).
std::vector<double> value_at(const Keys& keys, double time, bool rotation) {
    const bool cubic = keys.interpolation == Interpolation::cubic;
    const std::size_t n = keys.width;
    const auto value = [&](std::size_t key, std::size_t row, std::size_t i) {
        return static_cast<double>(keys.values[(cubic ? 3 * key + row : key) * n + i]);
    };
    const auto next = static_cast<std::size_t>(
        std::upper_bound(keys.times.begin(), keys.times.end(), time, [](double t, float key) { return t < static_cast<double>(key); }) - keys.times.begin());
    const std::size_t k = next == 0 ? 0 : next - 1;
    std::vector<double> out(n);
    for (std::size_t i = 0; i < n; ++i) out[i] = value(k, 1, i);
    if (next == 0 || next == keys.times.size() || keys.interpolation == Interpolation::step) return out;

    const double span = static_cast<double>(keys.times[next]) - static_cast<double>(keys.times[k]);
    const double t = (time - static_cast<double>(keys.times[k])) / span;
    if (cubic) {
        const double t2 = t * t;
        const double t3 = t2 * t;
        for (std::size_t i = 0; i < n; ++i)
            out[i] = (2 * t3 - 3 * t2 + 1) * value(k, 1, i) + span * (t3 - 2 * t2 + t) * value(k, 2, i) +
                     (-2 * t3 + 3 * t2) * value(next, 1, i) + span * (t3 - t2) * value(next, 0, i);
    } else if (rotation) {
        const glm::dquat a(value(k, 1, 3), value(k, 1, 0), value(k, 1, 1), value(k, 1, 2));
        const glm::dquat b(value(next, 1, 3), value(next, 1, 0), value(next, 1, 1), value(next, 1, 2));
        const glm::dquat q = glm::slerp(a, b, t);
        out = {q.x, q.y, q.z, q.w};
    } else {
        for (std::size_t i = 0; i < n; ++i) out[i] = (1.0 - t) * out[i] + t * value(next, 1, i);
    }
    return out;
}

// Rotations are unit quaternions but for the tangents of their splines; those that rounding leaves a little off are.
void check_rotations(const Element& target, const Keys& keys) {
    const std::size_t rows = keys.interpolation == Interpolation::cubic ? 3 : 1;
    for (std::size_t key = 0; keys.given && key < keys.times.size(); ++key) {
        const float* q = keys.values.data() + 4 * (rows * key + rows / 2);
        const double length = std::sqrt(static_cast<double>(q[0]) * q[0] + static_cast<double>(q[1]) * q[1] + static_cast<double>(q[2]) * q[2] + static_cast<double>(q[3]) * q[3]);
        if (std::abs(length - 1.0) < 0.05) continue;
        target.fault(fmt::format("key {} is a `rotation` of length {:.4g}", key, length), "expected a unit quaternion");
        return;
    }
}

// Whether a node has what the keys set, in as many numbers.
void check_channel(Document& document, const Element& target, const std::string& path, const Keys& keys, std::size_t node) {
    if (keys.width == 0) return;
    std::size_t expected = keys.width;
    if (path == "translation" || path == "scale") expected = 3;
    if (path == "rotation") expected = 4;
    if (path == "weights") {
        const auto mesh = document.nodes[node].index("mesh", document.meshes.size(), "meshes");
        expected = 0;
        if (mesh)
            for (const Element& primitive : document.meshes[*mesh].objects("primitives"))
                expected = std::max(expected, primitive.objects("targets").size());
    } else if (document.nodes[node].has("matrix") && path != "pointer") {
        target.fault(fmt::format("sets the `{}` of node {}, which has a `matrix` instead", path, node));
    }
    if (path == "rotation" && keys.width == 4) check_rotations(target, keys);
    if (keys.width != expected) target.fault(fmt::format("has {} numbers a key for `{}` of node {}; expected {}", keys.width, path, node, expected));
}

void set_channel(const std::string& path, const Keys& keys, double time, LocalTransform& local) {
    const std::vector<double> v = value_at(keys, time, path == "rotation");
    if (path == "weights") local.weights = v;
    else if (path == "translation") local.translation = {v[0], v[1], v[2]};
    else if (path == "scale") local.scale = {v[0], v[1], v[2]};
    else if (const glm::dquat q(v[3], v[0], v[1], v[2]); glm::length(q) > 0.0) local.rotation = glm::normalize(q);
}

void animate_one(Document& document, const Element& animation, const Accessors& accessors, std::optional<double> time, NodeTree& tree) {
    std::vector<Keys> samplers;
    for (const Element& sampler : animation.objects("samplers")) samplers.push_back(read_keys(document, sampler, accessors));
    std::set<std::pair<std::size_t, std::string>> targets;
    for (const Element& channel : animation.objects("channels")) {
        for (const char* name : {"sampler", "target"}) channel.require(name);
        const auto sampler = channel.index("sampler", samplers.size(), "samplers");
        const Element target = channel.object("target");
        target.require("path");
        const auto node = target.index("node", document.nodes.size(), "nodes");
        const std::string path = target.text("path", "translation");
        const bool known = path == "translation" || path == "rotation" || path == "scale" || path == "weights";
        if (sampler && node) check_channel(document, target, path, samplers[*sampler], *node);
        if (node && !targets.emplace(*node, path).second) target.fault(fmt::format("the `{}` of node {} has another channel already", path, *node));
        if (!known) document.warn(fmt::format("{}: {}: the path `{}` is passed over", document.file, target.path(), path));
        if (!known || !time || !sampler || !node || samplers[*sampler].width == 0) continue;
        set_channel(path, samplers[*sampler], *time, tree.local[*node]);
    }
}

}  // namespace

void animate(Document& document, const Accessors& accessors, std::optional<double> time, NodeTree& tree) {
    for (std::size_t i = 0; i < document.animations.size(); ++i)
        animate_one(document, document.animations[i], accessors, i == 0 ? time : std::nullopt, tree);
    if (!time) return;
    if (document.animations.empty()) document.warn(document.file + ": no animation; --frame-time changes nothing");
    else if (document.animations.size() > 1)
        document.warn(fmt::format("{}: of {} animations the first is shown", document.file, document.animations.size()));
}

}  // namespace wavelobe::gltf
