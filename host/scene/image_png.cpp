// PNG images through libpng.
#include <array>
#include <csetjmp>
#include <cstring>
#include <memory>

#include <png.h>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

// Deflate at its best on pixels of one bit.
constexpr double most_pixels_a_byte = 1032.0 * 8.0;

// Everything a decoding needs lives here, so that a jump out of libpng skips no destructor.
struct Decoding {
    const std::string& content;
    std::size_t position = 0;
    std::array<char, 128> error{};
    png_structp png = nullptr;
    png_infop info = nullptr;
    png_uint_32 width = 0;
    png_uint_32 height = 0;
    int channels = 0;
    int depth = 0;
    std::vector<png_byte> pixels;
    std::vector<png_bytep> rows;

    explicit Decoding(const std::string& file_content) : content(file_content) {}
    Decoding(const Decoding&) = delete;
    Decoding& operator=(const Decoding&) = delete;
    ~Decoding() { png_destroy_read_struct(&png, &info, nullptr); }
};

Decoding& decoding_of(png_voidp pointer) { return *static_cast<Decoding*>(pointer); }

void on_error(png_structp png, png_const_charp message) {
    Decoding& decoding = decoding_of(png_get_error_ptr(png));
    std::strncpy(decoding.error.data(), message, decoding.error.size() - 1);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, std::size_t size) {
    Decoding& decoding = decoding_of(png_get_io_ptr(png));
    if (size > decoding.content.size() - decoding.position) png_error(png, "the file ends inside its data");
    std::memcpy(out, decoding.content.data() + decoding.position, size);
    decoding.position += size;
}

// Palettes, transparency and small depths expand to 8 or 16 bit grey or RGB, with or without alpha.
bool read_header(Decoding& decoding) {
    if (setjmp(png_jmpbuf(decoding.png)) != 0) return false;
    png_set_read_fn(decoding.png, &decoding, on_read);
    png_read_info(decoding.png, decoding.info);
    png_set_expand(decoding.png);
    png_set_interlace_handling(decoding.png);
    png_read_update_info(decoding.png, decoding.info);
    decoding.width = png_get_image_width(decoding.png, decoding.info);
    decoding.height = png_get_image_height(decoding.png, decoding.info);
    decoding.channels = png_get_channels(decoding.png, decoding.info);
    decoding.depth = png_get_bit_depth(decoding.png, decoding.info);
    return true;
}

bool read_pixels(Decoding& decoding) {
    if (setjmp(png_jmpbuf(decoding.png)) != 0) return false;
    png_read_image(decoding.png, decoding.rows.data());
    png_read_end(decoding.png, nullptr);
    return true;
}

float sample(const Decoding& decoding, std::size_t at) {
    if (decoding.depth == 8) return static_cast<float>(decoding.pixels[at]) / 255.0F;
    return static_cast<float>(decoding.pixels[2 * at] * 256 + decoding.pixels[2 * at + 1]) / 65535.0F;
}

}  // namespace

Bitmap decode_png(const std::string& path, const std::string& content, Transfer transfer) {
    Decoding decoding(content);
    decoding.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoding, on_error, on_warning);
    decoding.info = png_create_info_struct(decoding.png);
    const auto fail = [&] { refuse_image(path, std::string("damaged PNG: ") + decoding.error.data()); };
    if (!read_header(decoding)) fail();
    Bitmap image = make_image(path, decoding.width, decoding.height, content.size(), most_pixels_a_byte);
    const std::size_t stride = png_get_rowbytes(decoding.png, decoding.info);
    decoding.pixels.resize(stride * decoding.height);
    for (png_uint_32 y = 0; y < decoding.height; ++y) decoding.rows.push_back(decoding.pixels.data() + y * stride);
    if (!read_pixels(decoding)) fail();

    const auto channels = static_cast<std::size_t>(decoding.channels);
    const std::size_t colours = channels >= 3 ? 3 : 1;
    if (transfer == Transfer::alpha) {
        for (std::size_t i = 0; i < image.rgb.size(); ++i)
            image.rgb[i] = channels > colours ? sample(decoding, i / 3 * channels + colours) : 1.0F;
        return image;
    }
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const float value = sample(decoding, i / 3 * channels + (colours == 3 ? i % 3 : 0));
        image.rgb[i] = transfer == Transfer::linear ? value : srgb_to_linear(value);
    }
    return image;
}

}  // namespace wavelobe
