#include "render/vertex_coordinates.h"

#include "scene/fault.h"

namespace wavelobe {

// Kernels gather by signed 32-bit offsets.
std::uint32_t vertex_offset(std::size_t value, const Shape& shape) {
    if (value > 0x7fffffffU) throw InputError(Fault{"", 0, 0, shape.name, "the scene has more vertex data than 32-bit offsets reach", "reduce the meshes"});
    return static_cast<std::uint32_t>(value);
}

namespace {

std::uint32_t add_set(const Shape& shape, const TriangleMesh& mesh, const std::vector<glm::vec2>& uvs, std::vector<float>& out) {
    if (uvs.empty()) return WAVELOBE_NONE;
    const std::uint32_t first = vertex_offset(out.size(), shape);
    for (const glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) out.insert(out.end(), {uvs[t[corner]].x, uvs[t[corner]].y});
    return first;
}

}  // namespace

void add_vertex_coordinates(const Shape& shape, const TriangleMesh& mesh, DeviceShape& record, DeviceScene& out) {
    record.first_uv = add_set(shape, mesh, mesh.uvs, out.uvs);
    record.first_second_uv = add_set(shape, mesh, mesh.second_uvs, out.uvs);
    if ((record.flags & SHAPE_MASKED) == 0) return;
    DeviceOpacity& opacity = out.opacities.back();
    const auto& texture = shape.material.opacity.value.texture;
    const bool second = texture && texture->second_uvs && !mesh.second_uvs.empty();
    opacity.first_uv = second ? record.first_second_uv : record.first_uv;
    if (mesh.alphas.empty()) return;
    out.features.vertex_opacity = true;
    opacity.first_alpha = vertex_offset(out.uvs.size(), shape);
    for (const glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) out.uvs.push_back(mesh.alphas[t[corner]]);
}

}  // namespace wavelobe
