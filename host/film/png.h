// 8-bit sRGB pictures.
#pragma once

#include <cstdint>
#include <string>

#include "render/render.h"

namespace wavelobe {

// sRGB transfer function (IEC 61966-2-1) of a linear value, clamped to [0, 1], as a byte rounded to nearest; NaN is 0.
std::uint8_t srgb_byte(float linear);

// The file's bytes. Values are clamped: no exposure, no tone curve.
std::string encode_png(const Image& image);

}  // namespace wavelobe
