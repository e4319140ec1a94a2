// How bright colours and textures are, as one number.
#pragma once

#include "scene/scene.h"

namespace wavelobe {

// Rec. 709 luminance.
double luminance(const Rgb& color);

// Mean luminance of a texture's source, or the luminance of a constant.
double mean_luminance(const Parameter& radiance);

}  // namespace wavelobe
