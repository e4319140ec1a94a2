// Portable pixmaps (P2, P3, P5, P6: 8 or 16 bits, as sRGB) and float maps (PF, Pf: linear, rows from the bottom).
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

class NetpbmReader {
public:
    NetpbmReader(const std::string& path, const std::string& content, Transfer transfer)
        : path_(path), content_(content), transfer_(transfer), kind_(content[1]) {}

    Bitmap read() {
        channels_ = kind_ == '3' || kind_ == '6' || kind_ == 'F' ? 3 : 1;
        const auto width = number<std::int64_t>(), height = number<std::int64_t>();
        const bool floats = kind_ == 'F' || kind_ == 'f';
        const auto scale = floats ? number<double>() : static_cast<double>(number<std::int64_t>());
        if (!std::isfinite(scale) || scale == 0.0 || (!floats && (scale < 1.0 || scale > 65535.0)))
            fail("the largest value or scale is out of range");
        // Text has a digit and a blank for each value.
        Bitmap image = make_image(path_, width, height, content_.size(), 1.0);
        ++position_;  // one blank ends the header
        if (floats) read_floats(image, scale < 0.0);
        else read_integers(image, static_cast<float>(scale));
        if (transfer_ == Transfer::alpha) image.rgb.assign(image.rgb.size(), 1.0F);
        return image;
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        refuse_image(path_, "damaged image: " + message + " (at byte " + std::to_string(position_) + ")");
    }

    // The next number in text; `#` starts a comment.
    template <typename T>
    T number() {
        while (position_ < content_.size() && (std::strchr(" \t\r\n", content_[position_]) != nullptr || content_[position_] == '#')) {
            if (content_[position_] == '#') position_ = std::min(content_.find('\n', position_), content_.size() - 1);
            ++position_;
        }
        T value{};
        const char* end = content_.data() + content_.size();
        const auto [behind, error] = std::from_chars(content_.data() + std::min(position_, content_.size()), end, value);
        if (error != std::errc{}) fail("expected a number");
        position_ = static_cast<std::size_t>(behind - content_.data());
        return value;
    }

    void need(std::size_t bytes) const {
        if (position_ > content_.size() || content_.size() - position_ < bytes) fail("the file ends inside its data");
    }

    std::uint8_t byte(std::size_t at) const { return static_cast<std::uint8_t>(content_[position_ + at]); }

    void put(Bitmap& image, std::size_t at, float value) const {
        if (channels_ == 3) image.rgb[at] = value;
        else for (std::size_t k = 0; k < 3; ++k) image.rgb[3 * at + k] = value;
    }

    void read_integers(Bitmap& image, float largest) {
        const bool text = kind_ == '2' || kind_ == '3';
        const std::size_t size = largest > 255.0F ? 2 : 1, count = image.rgb.size() / 3 * channels_;
        if (!text) need(count * size);
        if (text) --position_;
        for (std::size_t i = 0; i < count; ++i) {
            const auto stored = text ? static_cast<float>(number<std::uint16_t>())
                                     : static_cast<float>(size == 2 ? byte(2 * i) * 256 + byte(2 * i + 1) : byte(i));
            put(image, i, linear_value(std::min(stored / largest, 1.0F), transfer_));
        }
    }

    void read_floats(Bitmap& image, bool little) const {
        const std::size_t row = static_cast<std::size_t>(image.width) * channels_, rows = static_cast<std::size_t>(image.height);
        need(row * rows * sizeof(float));
        for (std::size_t i = 0; i < row * rows; ++i) {
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 4; ++k) bits |= std::uint32_t{byte(4 * i + k)} << (8 * (little ? k : 3 - k));
            put(image, (rows - 1 - i / row) * row + i % row, std::bit_cast<float>(bits));
        }
    }

    const std::string& path_;
    const std::string& content_;
    Transfer transfer_;
    char kind_;
    std::size_t channels_ = 3;
    std::size_t position_ = 2;
};

}  // namespace

Bitmap decode_netpbm(const std::string& path, const std::string& content, Transfer transfer) {
    return NetpbmReader(path, content, transfer).read();
}

}  // namespace wavelobe
