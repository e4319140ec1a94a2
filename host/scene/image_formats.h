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
Bitmap decode_radiance(const std::string& path, const std::string& content);

[[noreturn]] inline void refuse_image(const std::string& path, const std::string& message) {
    throw InputError(Fault{path, 0, 0, "", message, "save the image again"});
}

// An image of that size, all black; refused when no picture could be that large. Decoders call this
// before they allocate anything of the size a header claims.
Bitmap make_image(const std::string& path, std::int64_t width, std::int64_t height);

}  // namespace wavelobe
