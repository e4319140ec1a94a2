// How a scene is seen and what the picture holds: filter, film, camera, integrator.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace wavelobe {

struct ReconstructionFilter {
    enum class Kind : std::uint8_t { box, tent, gaussian, mitchell, lanczos } kind = Kind::gaussian;
    float radius = 2.0F;  // half width in pixels (box 0.5, tent 1, gaussian 4 stddev, mitchell 2, lanczos its lobes)
    float stddev = 0.5F;  // gaussian only
    float b = 1.0F / 3.0F;  // mitchell only: the parameters of the family; Catmull-Rom's spline has 0 and 1/2
    float c = 1.0F / 3.0F;

    // Some samples count negatively.
    bool is_signed() const { return kind == Kind::mitchell || kind == Kind::lanczos; }
};

struct Film {
    int width = 768;
    int height = 576;
    int crop_x = 0;
    int crop_y = 0;
    int crop_width = 768;
    int crop_height = 576;
    ReconstructionFilter filter;
};

// Looks along its own +z with +y up and +x to the left of the picture, as Mitsuba does. Orthographic: the film spans [-1, 1] of
// its x axis, and to_world may scale.
struct Camera {
    enum class Projection : std::uint8_t { perspective, orthographic } projection = Projection::perspective;
    glm::mat4 to_world{1.0F};
    float fov_x_degrees = 39.3077F;  // horizontal, over the whole film (readers resolve fov_axis)
    float near_clip = 0.01F;
    float far_clip = 10000.0F;
    float aperture_radius = 0.0F;  // of a thin lens, perspective only; 0: a pinhole
    float focus_distance = 1.0F;   // depth of the plane that is sharp
    glm::vec2 principal_point_offset{0.0F};
};

// What a picture holds beside its colours: the mean over each pixel's samples of one channel of a layer
// (kernels/layers/layers.def), or of its square.
enum class LayerKind : std::uint8_t {
#define LAYER(name, NAME, width) name,
#include "layers/layers.def"
#undef LAYER
    rgb,  // of the light itself
    xyz,
};

struct PictureChannel {
    std::string name;  // in the file, such as `normals.X`
    LayerKind kind = LayerKind::depth;
    int component = 0;
    bool squared = false;
};

struct Integrator {
    int max_depth = -1;  // path edges seen from the camera; -1: unlimited, 1: emitters alone
    int rr_depth = 1;    // Russian roulette from this depth on (kernels/stages/continue_path.h)
    bool hide_emitters = false;
    bool environment_covers = true;  // where nothing but the environment is seen, the picture is covered
    bool radiance = true;  // false: the channels are all there is, the colours stay black
    std::vector<PictureChannel> channels{};
};

}  // namespace wavelobe
