// Attributes of meshes, looked up as textures.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace wavelobe::mitsuba {

// A use of an attribute by what a shape holds.
struct AttributeUse {
    std::string name;
    bool scalar = false;  // asks for one value

    auto operator<=>(const AttributeUse&) const = default;
};

// One texture holds an attribute of all meshes. Each triangle has four texels of its own, among which its coordinates of the
// second set lie so that the bilinear filter is the interpolation between its corners.
class MeshAttributes {
public:
    std::shared_ptr<const Texture> add_texture(const std::string& attribute, float scale, const std::string& name);
    // 1 minus a texture of one channel; null where that is of no attribute.
    std::shared_ptr<const Texture> inverted(const Texture& texture);

    // The corners of each triangle become vertices of their own.
    void add_mesh(TriangleMesh& mesh, const std::vector<MeshAttribute>& attributes);

    // Fills the textures, once all meshes are known.
    void finish();

private:
    struct Lookup {
        std::string attribute;
        float scale = 1.0F;
        float offset = 0.0F;
        std::shared_ptr<Texture> texture;
    };
    // Values at the corners of triangles that follow each other.
    struct Values {
        std::size_t first = 0;
        std::vector<Rgb> corners;
    };

    std::shared_ptr<const Texture> add(Lookup lookup);
    void fill(const Lookup& lookup) const;

    std::vector<Lookup> lookups_;
    std::map<std::string, std::vector<Values>> values_;
    std::size_t triangles_ = 0;
};

}  // namespace wavelobe::mitsuba
