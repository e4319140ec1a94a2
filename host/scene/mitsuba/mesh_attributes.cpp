#include "scene/mitsuba/mesh_attributes.h"

#include <algorithm>
#include <bit>

namespace wavelobe::mitsuba {

namespace {

// Rows of so many triangles keep the texels' coordinates small.
constexpr std::size_t row_length = 4096;

std::size_t columns_for(std::size_t triangles) { return std::bit_ceil(std::min(std::max<std::size_t>(triangles, 1), row_length)); }
std::size_t rows_for(std::size_t triangles) { return (std::max<std::size_t>(triangles, 1) + row_length - 1) / row_length; }

// Column and row of a triangle's first texel.
glm::uvec2 first_texel(std::size_t triangle) { return {2 * (triangle % row_length), 2 * (triangle / row_length)}; }

// In texels, at the centres of the first three.
glm::vec2 coordinates(std::size_t triangle, std::size_t corner) {
    const glm::vec2 first = glm::vec2(first_texel(triangle)) + 0.5F;
    return first + (corner == 1 ? glm::vec2(1.0F, 0.0F) : corner == 2 ? glm::vec2(0.0F, 1.0F) : glm::vec2(0.0F));
}

template <class T>
void split_corners(std::vector<T>& values, const std::vector<glm::uvec3>& triangles) {
    if (values.empty()) return;
    std::vector<T> out;
    out.reserve(3 * triangles.size());
    for (const glm::uvec3& t : triangles) out.insert(out.end(), {values[t.x], values[t.y], values[t.z]});
    values = std::move(out);
}

}  // namespace

std::shared_ptr<const Texture> MeshAttributes::add(Lookup lookup) {
    lookups_.push_back(std::move(lookup));
    return lookups_.back().texture;
}

std::shared_ptr<const Texture> MeshAttributes::add_texture(const std::string& attribute, float scale, const std::string& name) {
    Bitmap bitmap;
    bitmap.wrap = Wrap::clamp;
    return add({attribute, scale, 0.0F, std::make_shared<Texture>(Texture{std::move(bitmap), glm::mat3(1.0F), name, true})});
}

std::shared_ptr<const Texture> MeshAttributes::inverted(const Texture& texture) {
    const auto found = std::find_if(lookups_.begin(), lookups_.end(), [&](const Lookup& l) { return l.texture.get() == &texture; });
    if (found == lookups_.end()) return nullptr;
    return add({found->attribute, -found->scale, 1.0F - found->offset, std::make_shared<Texture>(texture)});
}

void MeshAttributes::add_mesh(TriangleMesh& mesh, const std::vector<MeshAttribute>& attributes) {
    const std::size_t count = mesh.triangles.size();
    for (const MeshAttribute& attribute : attributes) {
        Values values{triangles_, {}};
        values.corners.reserve(3 * count);
        for (std::size_t i = 0; i < count; ++i)
            for (int corner = 0; corner < 3; ++corner)
                values.corners.push_back(attribute.values[attribute.of_faces ? i : mesh.triangles[i][corner]]);
        values_[attribute.name].push_back(std::move(values));
    }
    split_corners(mesh.positions, mesh.triangles);
    split_corners(mesh.normals, mesh.triangles);
    split_corners(mesh.uvs, mesh.triangles);
    mesh.second_uvs.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto first = static_cast<std::uint32_t>(3 * i);
        mesh.triangles[i] = {first, first + 1, first + 2};
        for (std::size_t corner = 0; corner < 3; ++corner) mesh.second_uvs.push_back(coordinates(triangles_ + i, corner));
    }
    triangles_ += count;
}

void MeshAttributes::fill(const Lookup& lookup) const {
    const std::size_t width = 2 * columns_for(triangles_), height = 2 * rows_for(triangles_);
    Bitmap& bitmap = std::get<Bitmap>(lookup.texture->source);
    bitmap.width = static_cast<int>(width);
    bitmap.height = static_cast<int>(height);
    bitmap.rgb.assign(width * height * 3, 0.0F);
    lookup.texture->to_uv[0][0] = 1.0F / static_cast<float>(width);
    lookup.texture->to_uv[1][1] = 1.0F / static_cast<float>(height);
    const auto found = values_.find(lookup.attribute);
    if (found == values_.end()) return;
    for (const Values& values : found->second)
        for (std::size_t i = 0; 3 * i < values.corners.size(); ++i) {
            const Rgb* corner = &values.corners[3 * i];
            // The fourth continues the plane through the three.
            const Rgb texels[4] = {corner[0], corner[1], corner[2], corner[1] + corner[2] - corner[0]};
            const glm::uvec2 first = first_texel(values.first + i);
            for (std::size_t k = 0; k < 4; ++k) {
                const Rgb value = lookup.scale * texels[k] + lookup.offset;
                float* texel = &bitmap.rgb[3 * ((first.y + k / 2) * width + first.x + k % 2)];
                for (int channel = 0; channel < 3; ++channel) texel[channel] = value[channel];
            }
        }
}

void MeshAttributes::finish() {
    for (const Lookup& lookup : lookups_) fill(lookup);
}

}  // namespace wavelobe::mitsuba
