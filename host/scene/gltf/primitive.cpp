#include "scene/gltf/primitive.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wavelobe::gltf {

namespace {

enum Mode { points = 0, lines = 1, line_loop = 2, line_strip = 3, triangle_list = 4, triangle_strip = 5, triangle_fan = 6 };

bool shows_triangles(std::int64_t mode) { return mode >= triangle_list; }

template <class V>
std::vector<V> grouped(const std::vector<float>& numbers) {
    std::vector<V> out(numbers.size() / static_cast<std::size_t>(V::length()));
    for (std::size_t i = 0; i < out.size(); ++i)
        for (int k = 0; k < V::length(); ++k) out[i][k] = numbers[i * static_cast<std::size_t>(V::length()) + static_cast<std::size_t>(k)];
    return out;
}

// Strips turn every second triangle over; fans share their first vertex (specification, section 3.7.2.1).
std::vector<glm::uvec3> assemble(const std::vector<std::uint32_t>& order, std::int64_t mode) {
    std::vector<glm::uvec3> out;
    if (order.size() < 3) return out;
    const std::size_t count = mode == triangle_list ? order.size() / 3 : order.size() - 2;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (mode == triangle_list) out.emplace_back(order[3 * i], order[3 * i + 1], order[3 * i + 2]);
        else if (mode == triangle_fan) out.emplace_back(order[i + 1], order[i + 2], order[0]);
        else out.emplace_back(order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]);
    }
    return out;
}

}  // namespace

Meshes::Meshes(Document& document, const Accessors& accessors) : document_(document), accessors_(accessors) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        for (const std::string& name : document.root.texts(list)) quantized_ = quantized_ || name == "KHR_mesh_quantization";
}

// Specification, section 3.7.2.1, and KHR_mesh_quantization.
void Meshes::check_format(const Element& attributes, const std::string& name, std::size_t accessor) {
    const Accessor& a = accessors_[accessor];
    const bool is_float = a.component_type == 5126;
    const bool is_unsigned = a.component_type == 5121 || a.component_type == 5123;
    const bool is_small = is_unsigned || a.component_type == 5120 || a.component_type == 5122;
    bool fits = is_float;
    if (name.starts_with("JOINTS_")) fits = is_unsigned && !a.normalized;
    else if (name.starts_with("WEIGHTS_") || name.starts_with("COLOR_")) fits = is_float || (is_unsigned && a.normalized);
    else if (name.starts_with("TEXCOORD_")) fits = is_float || (is_unsigned && a.normalized) || (quantized_ && is_small);
    else if (quantized_) fits = is_float || is_small;
    if (!fits)
        attributes.fault(fmt::format("{} is accessor {} of component type {}{}, which such an attribute may not have", name, accessor,
                                     a.component_type, a.normalized ? ", normalized" : ""),
                         name.starts_with("JOINTS_") ? "expected 5121 or 5123" : "expected 5126, or normalized 5121 or 5123 where these may be");
}

// Positions far outside the bounds that the file states come of damage; those a rounding outside do not.
void Meshes::check_bounds(const Element& attributes, std::size_t accessor, const std::vector<float>& values) {
    const Element& element = document_.accessors[accessor];
    if (accessors_[accessor].normalized || !element.has("min") || !element.has("max")) return;
    const std::vector<double> low = element.numbers("min");
    const std::vector<double> high = element.numbers("max");
    const std::size_t n = accessors_[accessor].components;
    if (low.size() != n || high.size() != n) {
        element.fault(fmt::format("`min` and `max` have {} and {} numbers; expected {}", low.size(), high.size(), n));
        return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double least = low[i % n];
        const double most = high[i % n];
        const double slack = 0.01 * std::abs(most - least) + 1e-3 * std::max(std::abs(least), std::abs(most)) + 1e-6;
        const auto value = static_cast<double>(values[i]);
        if (value >= least - slack && value <= most + slack) continue;
        attributes.fault(fmt::format("POSITION: element {} of accessor {} has {}, outside its `min` {} and `max` {}", i / n, accessor, value, least, most),
                         "the buffer may be damaged");
        return;
    }
}

std::vector<float> Meshes::attribute(const Element& attributes, const std::string& name, std::initializer_list<const char*> types,
                                     std::size_t vertices) {
    const auto index = attributes.index(name.c_str(), accessors_.size(), "accessors");
    if (!index || !accessors_[*index].readable) return {};
    const Accessor& accessor = accessors_[*index];
    const bool fits = std::any_of(types.begin(), types.end(), [&](const char* type) { return accessor.type == type; });
    if (!fits) {
        attributes.fault(fmt::format("{} is accessor {} of type {}; expected {}", name, *index, accessor.type, fmt::join(types, " or ")));
        return {};
    }
    if (vertices > 0 && accessor.count != vertices) {
        attributes.fault(fmt::format("{} has {} elements, and POSITION {}", name, accessor.count, vertices));
        return {};
    }
    check_format(attributes, name, *index);
    const bool packed = unpacked_ && unpacked_->attributes.contains(name);
    std::vector<float> out = packed ? std::move(unpacked_->attributes.extract(name).mapped()) : accessors_.floats(*index);
    if (packed && name == "POSITION") check_bounds(attributes, *index, out);
    const auto bad = std::find_if(out.begin(), out.end(), [](float v) { return !std::isfinite(v); });
    if (bad == out.end()) return out;
    attributes.fault(fmt::format("{}: element {} of accessor {} is not finite", name,
                                 static_cast<std::size_t>(bad - out.begin()) / accessor.components, *index));
    return {};
}

std::vector<std::uint32_t> Meshes::vertex_order(const Element& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> order;
    if (unpacked_) return std::move(unpacked_->indices);
    if (!primitive.has("indices")) {
        order.resize(vertices);
        for (std::size_t i = 0; i < vertices; ++i) order[i] = static_cast<std::uint32_t>(i);
        return order;
    }
    const auto index = primitive.index("indices", accessors_.size(), "accessors");
    if (!index || !accessors_[*index].readable) return {};
    if (accessors_[*index].components != 1) {
        primitive.fault(fmt::format("`indices` is accessor {} of type {}; expected SCALAR", *index, accessors_[*index].type));
        return {};
    }
    order = accessors_.integers(*index);
    const int type = accessors_[*index].component_type;
    const std::uint32_t restart = type == 5121 ? 0xffU : type == 5123 ? 0xffffU : 0xffffffffU;
    if (const auto found = std::find(order.begin(), order.end(), restart); found != order.end() && restart < vertices)
        primitive.fault(fmt::format("index {} of accessor {} is {}, the restart value, which glTF forbids", found - order.begin(), *index, restart));
    const auto bad = std::find_if(order.begin(), order.end(), [&](std::uint32_t v) { return v >= vertices; });
    if (bad == order.end()) return order;
    primitive.fault(fmt::format("index {} of accessor {} is {}; the primitive has {} vertices", bad - order.begin(), *index, *bad, vertices));
    return {};
}

void Meshes::read_triangles(const Element& primitive, Primitive& out) {
    const std::size_t vertices = out.mesh.positions.size();
    const std::int64_t mode = primitive.whole("mode", triangle_list, points, triangle_fan);
    const bool packed = unpacked_.has_value();
    const std::vector<std::uint32_t> order = vertex_order(primitive, vertices);
    if (packed) {
        out.mesh.triangles = assemble(order, triangle_list);
        return;
    }
    if (mode == triangle_list && order.size() % 3 != 0)
        document_.warn(fmt::format("{}: {}: {} vertices are no whole number of triangles; the last are passed over", document_.file,
                                   primitive.path(), order.size()));
    out.mesh.triangles = assemble(order, mode);
}

void Meshes::read_influences(const Element& attributes, Primitive& out) {
    std::vector<float> sums;
    for (int set = 0; set < 8; ++set) {
        const std::string joints = fmt::format("JOINTS_{}", set);
        const std::string weights = fmt::format("WEIGHTS_{}", set);
        if (attributes.has(joints.c_str()) != attributes.has(weights.c_str()))
            attributes.fault(fmt::format("has one of {} and {}; expected both or neither", joints, weights));
        if (!attributes.has(joints.c_str()) || !attributes.has(weights.c_str())) break;
        Influence influence{grouped<glm::vec4>(attribute(attributes, joints, {"VEC4"}, out.mesh.positions.size())),
                            grouped<glm::vec4>(attribute(attributes, weights, {"VEC4"}, out.mesh.positions.size()))};
        for (std::size_t i = 0; i < influence.weights.size(); ++i)
            if (glm::any(glm::lessThan(influence.weights[i], glm::vec4(0.0F)))) {
                attributes.fault(fmt::format("{}: element {} is negative", weights, i));
                break;
            }
        sums.resize(std::max(sums.size(), influence.weights.size()), 0.0F);
        for (std::size_t i = 0; i < influence.weights.size(); ++i) sums[i] += glm::dot(influence.weights[i], glm::vec4(1.0F));
        if (!influence.joints.empty() && !influence.weights.empty()) out.influences.push_back(std::move(influence));
    }
    // What rounding and coarse formats do to sums is far less; a vertex of no weights follows nothing.
    const auto bad = std::find_if(sums.begin(), sums.end(), [](float sum) { return sum != 0.0F && std::abs(sum - 1.0F) > 0.05F; });
    if (bad != sums.end()) attributes.fault(fmt::format("the weights of vertex {} sum to {:.4g}; expected 1", bad - sums.begin(), *bad));
}

std::vector<std::vector<glm::vec2>> Meshes::read_uv_sets(const Element& attributes, std::size_t vertices) {
    std::vector<std::vector<glm::vec2>> out;
    for (int set = 0; attributes.has(fmt::format("TEXCOORD_{}", set).c_str()); ++set)
        out.push_back(grouped<glm::vec2>(attribute(attributes, fmt::format("TEXCOORD_{}", set), {"VEC2"}, vertices)));
    return out;
}

std::vector<glm::vec4> Meshes::read_colors(const Element& attributes, std::size_t vertices, float alpha) {
    const auto accessor = attributes.index("COLOR_0", accessors_.size(), "accessors");
    const std::vector<float> numbers = attribute(attributes, "COLOR_0", {"VEC3", "VEC4"}, vertices);
    const auto outside = std::find_if(numbers.begin(), numbers.end(), [](float v) { return !(v >= 0.0F && v <= 1.0F); });
    if (alpha == 1.0F && outside != numbers.end())
        attributes.fault(fmt::format("COLOR_0: vertex {} has {}; expected numbers from 0 to 1",
                                     static_cast<std::size_t>(outside - numbers.begin()) / accessors_[*accessor].components, *outside));
    if (!accessor || accessors_[*accessor].components == 4) return grouped<glm::vec4>(numbers);
    std::vector<glm::vec4> out;
    for (const glm::vec3& color : grouped<glm::vec3>(numbers)) out.emplace_back(color, alpha);
    return out;
}

MorphTarget Meshes::read_target(const Element& attributes, const Element& target, std::size_t vertices) {
    for (const std::string& name : target.keys())
        if (!attributes.has(name.c_str())) target.fault(fmt::format("moves {}, which the primitive does not have", name));
    const auto vectors = [&](const char* name) { return grouped<glm::vec3>(attribute(target, name, {"VEC3"}, vertices)); };
    return {vectors("POSITION"), vectors("NORMAL"), vectors("TANGENT"), read_colors(target, vertices, 0.0F), read_uv_sets(target, vertices)};
}

Primitive Meshes::read(const Element& primitive) {
    Primitive out;
    const Element attributes = primitive.object("attributes");
    unpacked_ = unpack_draco(document_, accessors_, primitive);
    const auto in_types = [&](const char* name, std::initializer_list<const char*> types) {
        return attribute(attributes, name, types, out.mesh.positions.size());
    };
    out.mesh.positions = grouped<glm::vec3>(in_types("POSITION", {"VEC3"}));
    if (out.mesh.positions.empty()) return out;
    out.mesh.normals = grouped<glm::vec3>(in_types("NORMAL", {"VEC3"}));
    out.uv_sets = read_uv_sets(attributes, out.mesh.positions.size());
    out.tangents = grouped<glm::vec4>(in_types("TANGENT", {"VEC4"}));
    const auto tangents = attributes.index("TANGENT", accessors_.size(), "accessors");
    const bool given = tangents && (unpacked_ || accessors_.has_data(*tangents));
    const auto bad = std::find_if(out.tangents.begin(), out.tangents.end(), [](const glm::vec4& t) { return std::abs(std::abs(t.w) - 1.0F) > 0.1F; });
    if (given && bad != out.tangents.end())
        attributes.fault(fmt::format("TANGENT: vertex {} has a handedness of {}; expected 1 or -1", bad - out.tangents.begin(), bad->w));
    out.colors = read_colors(attributes, out.mesh.positions.size(), 1.0F);
    read_influences(attributes, out);
    for (const Element& target : primitive.objects("targets")) out.targets.push_back(read_target(attributes, target, out.mesh.positions.size()));
    out.path = primitive.path();
    out.material = primitive.index("material", document_.materials.size(), "materials");
    read_triangles(primitive, out);
    return out;
}

void Meshes::check() {
    read_.resize(document_.meshes.size());
    for (std::size_t m = 0; m < document_.meshes.size(); ++m) {
        const Element& mesh = document_.meshes[m];
        mesh.require("primitives");
        for (const Element& primitive : mesh.objects("primitives")) {
            primitive.require("attributes");
            primitive.whole("mode", triangle_list, points, triangle_fan);
            primitive.index("material", document_.materials.size(), "materials");
        }
        check_weights(m, mesh);
        primitives(m);
    }
}

void Meshes::check_weights(std::size_t mesh, const Element& owner) {
    const std::size_t weights = owner.numbers("weights").size();
    std::size_t targets = 0;
    for (const Element& primitive : document_.meshes[mesh].objects("primitives")) {
        const std::size_t own = primitive.objects("targets").size();
        if (targets > 0 && own != targets) primitive.fault(fmt::format("has {} morph targets, and another primitive of its mesh {}", own, targets));
        targets = std::max(targets, own);
    }
    if (owner.has("weights") && weights != targets) owner.fault(fmt::format("has {} `weights` for {} morph targets", weights, targets));
}

const std::vector<Primitive>& Meshes::primitives(std::size_t mesh) {
    std::unique_ptr<std::vector<Primitive>>& slot = read_[mesh];
    if (slot) return *slot;
    slot = std::make_unique<std::vector<Primitive>>();
    for (const Element& primitive : document_.meshes[mesh].objects("primitives")) {
        const std::int64_t mode = primitive.whole("mode", triangle_list, points, triangle_fan);
        if (!primitive.object("attributes").has("POSITION")) {
            document_.warn(fmt::format("{}: {}: has no POSITION and is passed over", document_.file, primitive.path()));
        } else if (!shows_triangles(mode)) {
            document_.warn(fmt::format("{}: {}: {} are passed over; triangles alone are shown", document_.file, primitive.path(),
                                       mode == points ? "points" : "lines"));
        } else {
            slot->push_back(read(primitive));
        }
    }
    return *slot;
}

}  // namespace wavelobe::gltf
