#include "scene/gltf/draco.h"

#include <cmath>

#include <draco/compression/decode.h>
#include <fmt/format.h>

namespace wavelobe::gltf {

namespace {

// What a number of an accessor's integer type is divided by where it is normalized.
float greatest_of(int component_type) {
    switch (component_type) {
        case 5120: return 127.0F;
        case 5121: return 255.0F;
        case 5122: return 32767.0F;
        case 5123: return 65535.0F;
        default: return 1.0F;
    }
}

std::unique_ptr<draco::Mesh> decode(const Element& place, std::string_view bytes) {
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(bytes.data(), bytes.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (decoded.ok()) return std::move(decoded).value();
        place.fault(fmt::format("cannot be decompressed: {}", decoded.status().error_msg()), "the file may be damaged");
    } catch (const std::exception& error) {
        place.fault(fmt::format("cannot be decompressed: {}", error.what()), "the file may be damaged");
    }
    return nullptr;
}

std::vector<float> numbers_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute, const Accessor& accessor) {
    const auto components = static_cast<std::int8_t>(accessor.components);
    const bool divides = accessor.normalized && !attribute.normalized();
    const float scale = divides ? 1.0F / greatest_of(accessor.component_type) : 1.0F;
    std::vector<float> out(accessor.count * accessor.components);
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        float* to = out.data() + i * accessor.components;
        if (!attribute.ConvertValue(attribute.mapped_index(draco::PointIndex(i)), components, to)) return {};
        for (std::size_t k = 0; divides && k < accessor.components; ++k) to[k] = std::max(to[k] * scale, -1.0F);
    }
    return out;
}

}  // namespace

std::optional<UnpackedPrimitive> unpack_draco(Document& document, const Accessors& accessors, const Element& primitive) {
    const Element extension = primitive.extension("KHR_draco_mesh_compression");
    if (!extension.present()) return {};
    for (const char* name : {"bufferView", "attributes"}) extension.require(name);
    const auto view = extension.index("bufferView", document.views.size(), "buffer views");
    if (!view || !document.views[*view].readable) return {};
    const std::unique_ptr<draco::Mesh> mesh = decode(extension, document.views[*view].bytes);
    if (!mesh) return {};
    UnpackedPrimitive out;
    const Element packed = extension.object("attributes");
    const Element described = primitive.object("attributes");
    for (const std::string& name : packed.keys()) {
        const auto id = packed.whole(name.c_str(), 0, 0, 0xffffffffLL);
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        const auto index = described.index(name.c_str(), accessors.size(), "accessors");
        if (attribute == nullptr || !index) {
            packed.fault(fmt::format("{} is {}", name, attribute == nullptr ? fmt::format("attribute {}, which the compressed mesh does not have", id)
                                                                              : "no attribute of the primitive"));
            continue;
        }
        const Accessor& accessor = accessors[*index];
        if (!accessor.readable) continue;
        if (accessor.count != mesh->num_points()) {
            packed.fault(fmt::format("{}: accessor {} has {} elements, and the compressed mesh {} vertices", name, *index, accessor.count, mesh->num_points()));
            continue;
        }
        std::vector<float> numbers = numbers_of(*mesh, *attribute, accessor);
        if (numbers.empty()) packed.fault(fmt::format("{} cannot be read from the compressed mesh", name));
        else out.attributes.emplace(name, std::move(numbers));
    }
    for (std::uint32_t face = 0; face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(face))) out.indices.push_back(corner.value());
    return out;
}

}  // namespace wavelobe::gltf
