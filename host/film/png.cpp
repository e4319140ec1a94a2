#include "film/png.h"

#include <png.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace wavelobe {

std::uint8_t srgb_byte(float linear) {
    if (!(linear > 0.0F)) return 0;
    if (linear >= 1.0F) return 255;
    const float encoded = linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255.0F * encoded));
}

std::string encode_png(const Image& image) {
    std::vector<std::uint8_t> bytes(image.rgb.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = srgb_byte(image.rgb[i]);

    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGB;  // 8-bit sRGB by definition of this interface
    // libpng compresses once to learn the size and once more to fill the buffer, unless given room enough at once.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string file(size, '\0');
    if (png_image_write_to_memory(&header, file.data(), &size, 0, bytes.data(), 0, nullptr) == 0) {
        throw std::runtime_error(std::string("cannot encode the PNG: ") + header.message);
    }
    file.resize(size);
    return file;
}

}  // namespace wavelobe
