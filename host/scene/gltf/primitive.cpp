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

std::vector<float> Meshes::attribute(const Element& attributes, const char* name, std::initializer_list<const char*> types,
                                     std::size_t vertices) {
    const auto index = attributes.index(name, accessors_.size(), "accessors");
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
    std::vector<float> out = accessors_.floats(*index);
    const auto bad = std::find_if(out.begin(), out.end(), [](float v) { return !std::isfinite(v); });
    if (bad == out.end()) return out;
    attributes.fault(fmt::format("{}: element {} of accessor {} is not finite", name,
                                 static_cast<std::size_t>(bad - out.begin()) / accessor.components, *index));
    return {};
}

std::vector<std::uint32_t> Meshes::vertex_order(const Element& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> order;
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
    const auto bad = std::find_if(order.begin(), order.end(), [&](std::uint32_t v) { return v >= vertices; });
    if (bad == order.end()) return order;
    primitive.fault(fmt::format("index {} of accessor {} is {}; the primitive has {} vertices", bad - order.begin(), *index, *bad, vertices));
    return {};
}

void Meshes::read_triangles(const Element& primitive, Primitive& out) {
    const std::size_t vertices = out.mesh.positions.size();
    const std::int64_t mode = primitive.whole("mode", triangle_list, points, triangle_fan);
    const std::vector<std::uint32_t> order = vertex_order(primitive, vertices);
    if (mode == triangle_list && order.size() % 3 != 0)
        document_.warn(fmt::format("{}: {}: {} vertices are no whole number of triangles; the last are passed over", document_.file,
                                   primitive.path(), order.size()));
    out.mesh.triangles = assemble(order, mode);
}

Primitive Meshes::read(const Element& primitive) {
    Primitive out;
    const Element attributes = primitive.object("attributes");
    const auto in_types = [&](const char* name, std::initializer_list<const char*> types) {
        return attribute(attributes, name, types, out.mesh.positions.size());
    };
    out.mesh.positions = grouped<glm::vec3>(in_types("POSITION", {"VEC3"}));
    if (out.mesh.positions.empty()) return out;
    out.mesh.normals = grouped<glm::vec3>(in_types("NORMAL", {"VEC3"}));
    out.mesh.uvs = grouped<glm::vec2>(in_types("TEXCOORD_0", {"VEC2"}));
    out.second_uvs = grouped<glm::vec2>(in_types("TEXCOORD_1", {"VEC2"}));
    out.tangents = grouped<glm::vec4>(in_types("TANGENT", {"VEC4"}));
    const auto color = attributes.index("COLOR_0", accessors_.size(), "accessors");
    const std::vector<float> colors = in_types("COLOR_0", {"VEC3", "VEC4"});
    if (color && accessors_[*color].components == 3)
        for (const glm::vec3& c : grouped<glm::vec3>(colors)) out.colors.emplace_back(c, 1.0F);
    else out.colors = grouped<glm::vec4>(colors);
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
        primitives(m);
    }
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
