// The decoders behind load_image; each takes a whole file.
#pragma once

#include <cstdint>
#include <string>

#include "scene/fault.h"
#include "scene/image.h"

namespace wavelobe {

Bitmap decode_png(const std::string& path, const std::string& content, Transfer transfer);
Bitmap decode_jpeg(const std::string& path, const std::string& content, Transfer transfer);
Bitmap decode_exr(const std::string& path);
// Refuses a file whose header claims more than the file can hold.
void check_exr_header(const std::string& path, const std::string& content);
Bitmap decode_radiance(const std::string& path, const std::string& content);
// Portable pixmaps and float maps, by their first two bytes.
Bitmap decode_netpbm(const std::string& path, const std::string& content, Transfer transfer);
Bitmap decode_bmp(const std::string& path, const std::string& content, Transfer transfer);
Bitmap decode_tga(const std::string& path, const std::string& content, Transfer transfer);

[[noreturn]] inline void refuse_image(const std::string& path, const std::string& message) {
    throw InputError(Fault{path, 0, 0, "", message, "save the image again"});
}

// An image of that size, all black; refused when no picture could be that large, or none of a file of `bytes` at the densest
// packing there is. Decoders call this before they allocate anything of the size a header claims.
Bitmap make_image(const std::string& path, std::int64_t width, std::int64_t height, std::size_t bytes, double most_pixels_a_byte);

// A stored fraction as a linear number.
inline float linear_value(float value, Transfer transfer) { return transfer == Transfer::linear ? value : srgb_to_linear(value); }

}  // namespace wavelobe
