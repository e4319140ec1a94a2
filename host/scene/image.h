// Images from files: PNG, JPEG, OpenEXR and Radiance HDR, told apart by their first bytes.
#pragma once

#include <string>

#include "scene/scene.h"

namespace wavelobe {

// How stored numbers become linear ones. 8 and 16 bit formats hold sRGB unless told otherwise, floating
// point formats are linear.
enum class Transfer { of_format, linear };

// Grey images have three equal channels; alpha is left out. Throws InputError naming the file.
Bitmap load_image(const std::string& path, Transfer transfer);

// All three channels become the luminance.
void reduce_to_luminance(Bitmap& image);

// Repeats the last column and row until the image has at least that size.
void pad_image(Bitmap& image, int min_width, int min_height);

float srgb_to_linear(float encoded);

}  // namespace wavelobe
