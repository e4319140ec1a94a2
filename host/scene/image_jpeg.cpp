// JPEG images through libjpeg.
#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <vector>

#include <jpeglib.h>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

// A bit for each block of 16 x 16 pixels.
constexpr double most_pixels_a_byte = 8.0 * 256.0;

// Everything a decoding needs lives here, so that a jump out of libjpeg skips no destructor.
struct Decoding {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    std::jmp_buf jump{};
    std::array<char, JMSG_LENGTH_MAX> error{};
    std::vector<JSAMPLE> pixels;

    Decoding() = default;
    Decoding(const Decoding&) = delete;
    Decoding& operator=(const Decoding&) = delete;
    ~Decoding() { jpeg_destroy_decompress(&jpeg); }
};

void on_error(j_common_ptr common) {
    auto& decoding = *static_cast<Decoding*>(common->client_data);
    common->err->format_message(common, decoding.error.data());
    std::longjmp(decoding.jump, 1);
}

// Damaged data is a warning to libjpeg, which goes on with grey; a picture with holes is no input.
void on_message(j_common_ptr common, int level) {
    if (level < 0) on_error(common);
}

bool read_header(Decoding& decoding, const std::string& content) {
    decoding.jpeg.err = jpeg_std_error(&decoding.errors);
    decoding.errors.error_exit = on_error;
    decoding.errors.emit_message = on_message;
    decoding.jpeg.client_data = &decoding;
    if (setjmp(decoding.jump) != 0) return false;
    jpeg_create_decompress(&decoding.jpeg);
    decoding.jpeg.client_data = &decoding;
    jpeg_mem_src(&decoding.jpeg, reinterpret_cast<const unsigned char*>(content.data()), content.size());
    jpeg_read_header(&decoding.jpeg, TRUE);
    // YCCK becomes CMYK; what is left to do to get RGB is ours.
    decoding.jpeg.out_color_space = decoding.jpeg.num_components == 1   ? JCS_GRAYSCALE
                                    : decoding.jpeg.num_components == 4 ? JCS_CMYK
                                                                        : JCS_RGB;
    jpeg_calc_output_dimensions(&decoding.jpeg);
    return true;
}

bool read_pixels(Decoding& decoding) {
    if (setjmp(decoding.jump) != 0) return false;
    jpeg_start_decompress(&decoding.jpeg);
    while (decoding.jpeg.output_scanline < decoding.jpeg.output_height) {
        const std::size_t stride =
            std::size_t{decoding.jpeg.output_width} * static_cast<std::size_t>(decoding.jpeg.output_components);
        JSAMPROW row = decoding.pixels.data() + stride * decoding.jpeg.output_scanline;
        jpeg_read_scanlines(&decoding.jpeg, &row, 1);
    }
    jpeg_finish_decompress(&decoding.jpeg);
    return true;
}

// Red, green or blue of four inks, as fractions of the light that each lets through: files of Adobe's programs store these, others
// the ink.
float cmyk_value(const Decoding& decoding, std::size_t i) {
    const JSAMPLE* inks = &decoding.pixels[i / 3 * 4];
    const bool inverted = decoding.jpeg.saw_Adobe_marker != 0;
    const auto passes = [inverted](JSAMPLE stored) { return static_cast<float>(inverted ? stored : 255 - stored) / 255.0F; };
    return passes(inks[i % 3]) * passes(inks[3]);
}

}  // namespace

Bitmap decode_jpeg(const std::string& path, const std::string& content, Transfer transfer) {
    Decoding decoding;
    const auto fail = [&] { refuse_image(path, std::string("damaged JPEG: ") + decoding.error.data()); };
    if (!read_header(decoding, content)) fail();
    Bitmap image = make_image(path, decoding.jpeg.output_width, decoding.jpeg.output_height, content.size(), most_pixels_a_byte);
    const auto channels = static_cast<std::size_t>(decoding.jpeg.out_color_components);
    decoding.pixels.resize(image.rgb.size() / 3 * channels);
    if (!read_pixels(decoding)) fail();
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const float value = channels == 4 ? cmyk_value(decoding, i) : static_cast<float>(decoding.pixels[channels == 3 ? i : i / 3]) / 255.0F;
        if (transfer == Transfer::alpha) image.rgb[i] = 1.0F;
        else image.rgb[i] = transfer == Transfer::linear ? value : srgb_to_linear(value);
    }
    return image;
}

}  // namespace wavelobe
