// What the image formats have in common.
#include "scene/image.h"

#include <algorithm>
#include <cmath>

#include "scene/file.h"
#include "scene/image_formats.h"

namespace wavelobe {

namespace {

constexpr std::int64_t max_side = 65536;
constexpr std::int64_t max_pixels = std::int64_t{1} << 28;

}  // namespace

float srgb_to_linear(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

Bitmap make_image(const std::string& path, std::int64_t width, std::int64_t height, std::size_t bytes, double most_pixels_a_byte) {
    if (width <= 0 || height <= 0 || width > max_side || height > max_side || width * height > max_pixels)
        refuse_image(path, "the image claims " + std::to_string(width) + " x " + std::to_string(height) +
                               " pixels; expected at most " + std::to_string(max_side) + " a side and " +
                               std::to_string(max_pixels) + " in all");
    if (static_cast<double>(width * height) > static_cast<double>(bytes) * most_pixels_a_byte)
        refuse_image(path, "the file ends inside its data: " + std::to_string(bytes) + " bytes cannot hold the " + std::to_string(width) +
                               " x " + std::to_string(height) + " pixels it claims");
    Bitmap image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.rgb.resize(static_cast<std::size_t>(width * height) * 3);
    return image;
}

Bitmap load_image(const std::string& path, Transfer transfer) {
    const std::string content = read_file(path);
    if (content.starts_with("\x76\x2f\x31\x01")) {
        check_exr_header(path, content);
        return decode_exr(path);
    }
    return decode_image(path, content, transfer);
}

Bitmap decode_image(const std::string& path, const std::string& content, Transfer transfer) {
    if (content.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(path, content, transfer);
    if (content.starts_with("\xff\xd8")) return decode_jpeg(path, content, transfer);
    if (content.starts_with("#?")) return decode_radiance(path, content);
    for (const char* mark : {"P2", "P3", "P5", "P6", "PF", "Pf"})
        if (content.starts_with(mark)) return decode_netpbm(path, content, transfer);
    if (content.starts_with("BM")) return decode_bmp(path, content, transfer);
    // Targa files have no mark.
    if (path.ends_with(".tga") || path.ends_with(".TGA")) return decode_tga(path, content, transfer);
    throw InputError(Fault{path, 0, 0, "",
                           "not an image of a supported format; expected PNG, JPEG, OpenEXR, Radiance HDR, PFM, PPM, BMP or TGA",
                           "convert the image"});
}

void reduce_to_luminance(Bitmap& image) {
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        const float luminance =
            0.212671F * image.rgb[i] + 0.715160F * image.rgb[i + 1] + 0.072169F * image.rgb[i + 2];
        std::fill_n(image.rgb.begin() + static_cast<std::ptrdiff_t>(i), 3, luminance);
    }
}

void pad_image(Bitmap& image, int min_width, int min_height) {
    const int width = std::max(image.width, min_width);
    const int height = std::max(image.height, min_height);
    if (width == image.width && height == image.height) return;
    Bitmap padded = image;
    padded.width = width;
    padded.height = height;
    padded.rgb.clear();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int from = std::min(y, image.height - 1) * image.width + std::min(x, image.width - 1);
            const auto pixel = image.rgb.begin() + std::ptrdiff_t{3} * from;
            padded.rgb.insert(padded.rgb.end(), pixel, pixel + 3);
        }
    image = std::move(padded);
}

}  // namespace wavelobe
