// Windows bitmaps and Targa images: palettes, grey, 15 to 32 bits, with or without run lengths.
#include <array>
#include <cstring>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

using Rgba = std::array<std::uint8_t, 4>;

// Little-endian numbers of a file, checked.
class Bytes {
public:
    Bytes(const std::string& path, const std::string& content) : path_(path), content_(content) {}

    std::uint32_t number(std::size_t at, std::size_t size) const {
        if (at > content_.size() || content_.size() - at < size)
            refuse_image(path_, "damaged image: the file ends inside its data (at byte " + std::to_string(content_.size()) + ")");
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < size; ++k) value |= std::uint32_t{static_cast<std::uint8_t>(content_[at + k])} << (8 * k);
        return value;
    }

    // Stored as blue, green, red and perhaps alpha; 1 byte: grey; 2: five bits each.
    Rgba pixel(std::size_t at, std::size_t size) const {
        const std::uint32_t v = number(at, size);
        const auto byte = [v](unsigned shift) { return static_cast<std::uint8_t>(v >> shift); };
        const auto five = [v](unsigned shift) { return static_cast<std::uint8_t>(((v >> shift) & 31U) * 255U / 31U); };
        if (size == 1) return {byte(0), byte(0), byte(0), 255};
        if (size == 2) return {five(10), five(5), five(0), 255};
        return {byte(16), byte(8), byte(0), size == 4 ? byte(24) : std::uint8_t{255}};
    }

private:
    const std::string& path_;
    const std::string& content_;
};

void put(Bitmap& image, std::size_t x, std::size_t y, const Rgba& pixel, Transfer transfer) {
    float* out = &image.rgb[3 * (y * static_cast<std::size_t>(image.width) + x)];
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = transfer == Transfer::alpha ? static_cast<float>(pixel[3]) / 255.0F
                                             : linear_value(static_cast<float>(pixel[k]) / 255.0F, transfer);
}

}  // namespace

Bitmap decode_bmp(const std::string& path, const std::string& content, Transfer transfer) {
    const Bytes bytes(path, content);
    const std::size_t first = bytes.number(10, 4), header = bytes.number(14, 4);
    if (header < 40) refuse_image(path, "the bitmap's header is of OS/2; expected one of Windows");
    const auto width = static_cast<std::int32_t>(bytes.number(18, 4));
    const std::int64_t rows = static_cast<std::int32_t>(bytes.number(22, 4));
    const std::uint32_t bits = bytes.number(28, 2), coding = bytes.number(30, 4);
    // Masks (3) are taken for the usual ones.
    if ((coding != 0 && !(coding == 3 && bits == 32)) || (bits != 1 && bits != 4 && bits != 8 && bits != 16 && bits != 24 && bits != 32))
        refuse_image(path, "the bitmap is compressed, or of a depth that is not supported; expected 1, 4, 8, 16, 24 or 32 bits as they are");
    Bitmap image = make_image(path, width, rows < 0 ? -rows : rows, content.size(), 8.0);
    const std::size_t stride = (static_cast<std::size_t>(width) * bits + 31) / 32 * 4;
    const std::size_t palette = 14 + header;
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        const std::size_t row = first + y * stride;
        const std::size_t to = rows < 0 ? y : static_cast<std::size_t>(image.height) - 1 - y;
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
            Rgba pixel;
            if (bits <= 8) {
                const std::uint32_t byte = bytes.number(row + x * bits / 8, 1);
                const std::uint32_t index = (byte >> (8 - bits - x * bits % 8)) & ((1U << bits) - 1U);
                pixel = bytes.pixel(palette + std::size_t{4} * index, 3);
            } else {
                pixel = bytes.pixel(row + x * bits / 8, bits / 8);
                // Without masks the fourth byte means nothing.
                if (coding == 0) pixel[3] = 255;
            }
            put(image, x, to, pixel, transfer);
        }
    }
    return image;
}

Bitmap decode_tga(const std::string& path, const std::string& content, Transfer transfer) {
    const Bytes bytes(path, content);
    const std::uint32_t kind = bytes.number(2, 1), bits = bytes.number(16, 1), order = bytes.number(17, 1);
    const bool packed = kind >= 9, indexed = (kind & 7U) == 1;
    const std::size_t size = (bits + 7) / 8, entry = (bytes.number(7, 1) + 7) / 8;
    const bool known = (kind & ~8U) >= 1 && (kind & ~8U) <= 3 && (bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32);
    if (!known || (indexed && (size != 1 || entry < 2 || entry > 4)))
        refuse_image(path, "not a Targa image of a supported kind; expected colours, grey or a palette, 8 to 32 bits");
    // A run of 128 pixels takes two bytes at least.
    Bitmap image = make_image(path, bytes.number(12, 2), bytes.number(14, 2), content.size(), 64.0);
    const std::size_t palette = 18 + bytes.number(0, 1), start = bytes.number(3, 2);
    std::size_t at = palette + (bytes.number(1, 1) != 0 ? bytes.number(5, 2) * entry : 0);
    const auto next = [&] {
        const std::uint32_t index = indexed ? bytes.number(at, 1) : 0;
        const bool inside = index >= start && index - start < bytes.number(5, 2);
        if (indexed && !inside) refuse_image(path, "damaged image: a pixel names a colour that is not in the palette");
        const Rgba pixel = indexed ? bytes.pixel(palette + (index - start) * entry, entry) : bytes.pixel(at, size);
        at += size;
        return pixel;
    };
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    std::uint32_t left = 0;
    bool repeats = false;
    Rgba pixel{};
    for (std::size_t i = 0; i < width * height; ++i) {
        const bool starts = packed && left == 0;
        if (starts) {
            const std::uint32_t code = bytes.number(at++, 1);
            repeats = code >= 128;
            left = (code & 127U) + 1;
        }
        if (!packed || starts || !repeats) pixel = next();
        if (packed) --left;
        const std::size_t x = i % width, y = i / width;
        put(image, (order & 16U) != 0 ? width - 1 - x : x, (order & 32U) != 0 ? y : height - 1 - y, pixel, transfer);
    }
    return image;
}

}  // namespace wavelobe
