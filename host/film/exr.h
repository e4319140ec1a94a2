// Rendered pictures as OpenEXR files. They are read back by load_image (scene/image.h).
#pragma once

#include <cstdint>
#include <string>

#include "render/render.h"
#include "scene/projection.h"
#include "scene/scene.h"

namespace wavelobe {

// What a rendered picture says about itself, beside its size and matrices.
struct PictureNotes {
    std::string scene;
    int samples_per_pixel = 0;
    std::uint64_t samples = 0;  // made so far: fewer than asked for when rendering was stopped
    std::uint32_t seed = 0;
    double seconds = 0.0;  // of rendering
};

// The file's bytes: linear RGB and the picture's further channels as 32-bit floats, ZIP-compressed, the data window being the crop window within the
// film's display window. Attributes: `software`, `worldToCamera` and `worldToNDC` as the OpenEXR library defines them
// (row vectors; camera space with x right, y up, z forward), and `wavelobe.scene`, `.spp`, `.samples`, `.seed`, `.seconds`.
std::string encode_exr(const Image& image, const Film& film, const Camera& camera, const PictureNotes& notes);

}  // namespace wavelobe
