// Textures, and parameters that may vary over one.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

namespace wavelobe {

using Rgb = glm::vec3;

enum class Wrap : std::uint8_t { repeat, mirror, clamp };
enum class Filter : std::uint8_t { nearest, bilinear };

// Row 0 is the top of the image, as in the file. A look-up at (u, v), to_uv applied, uses texel
// coordinates x = u * width, y = v * height: v grows downwards from the top row, with no flip (mesh
// readers flip v where the format asks for it). Texel (i, j) covers [i, i + 1) x [j, j + 1):
// nearest takes (floor(x), floor(y)); bilinear blends the four texels around (x - 0.5, y - 0.5), from
// (floor(x - 0.5), floor(y - 0.5)) on. The wrap mode applies to each integer texel index.
struct Bitmap {
    int width = 0;
    int height = 0;
    std::vector<float> rgb;  // width * height * 3, linear
    Filter filter = Filter::bilinear;
    Wrap wrap = Wrap::repeat;
    std::optional<Wrap> row_wrap{};  // of rows, where it differs from that of columns
};

// color0 where (u, v), to_uv applied, has both or neither of its fractions above one half.
struct Checkerboard {
    Rgb color0{0.4F};
    Rgb color1{0.2F};
};

struct Texture {
    std::variant<Bitmap, Checkerboard> source;
    glm::mat3 to_uv{1.0F};  // applied to (u, v, 1) before the look-up
    std::string name;
    bool second_uvs = false;  // looked up at TriangleMesh::second_uvs
};

// A material parameter: a constant, or a texture over the surface's (u, v).
// A scalar parameter (roughness) uses the red channel; readers fold colours into it.
struct Parameter {
    Rgb value{0.0F};
    std::shared_ptr<const Texture> texture;  // null: constant
    int channel = 0;                         // of the bitmap that a scalar uses: red, green or blue
};

}  // namespace wavelobe
