// Images from files: PNG, JPEG, OpenEXR, Radiance HDR, PFM, PPM, BMP and TGA, told apart by their first bytes.
#pragma once

#include <string>

#include "scene/scene.h"

namespace wavelobe {

// How stored numbers become linear ones. 8 and 16 bit formats hold sRGB unless told otherwise, floating
// point formats are linear.
// `alpha`: all three channels become the alpha of the file, one where it has none.
enum class Transfer { of_format, linear, alpha };

// Grey images have three equal channels; alpha is left out. Throws InputError naming the file.
Bitmap load_image(const std::string& path, Transfer transfer);

// The same of a file in memory; `name` is for messages. OpenEXR is refused.
Bitmap decode_image(const std::string& name, const std::string& content, Transfer transfer);

// All three channels become the luminance.
void reduce_to_luminance(Bitmap& image);

// Repeats the last column and row until the image has at least that size.
void pad_image(Bitmap& image, int min_width, int min_height);

float srgb_to_linear(float encoded);

}  // namespace wavelobe
