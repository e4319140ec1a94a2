// Radiance HDR images (.hdr, .rgbe): run-length encoded or flat.
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

using Pixel = std::array<std::uint8_t, 4>;  // three mantissas and the exponent they share

class RadianceReader {
public:
    RadianceReader(const std::string& path, const std::string& content) : path_(path), content_(content) {}

    Bitmap read() {
        Bitmap image = read_header();
        const auto width = static_cast<std::size_t>(image.width);
        // Every scanline takes at least a run for each 127 pixels of each channel.
        std::vector<Pixel> row(width);
        for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
            read_row(row);
            for (std::size_t x = 0; x < width; ++x) {
                const Pixel& pixel = row[x];
                const float scale = pixel[3] == 0 ? 0.0F : std::ldexp(1.0F, pixel[3] - (128 + 8));
                for (std::size_t k = 0; k < 3; ++k)
                    image.rgb[(y * width + x) * 3 + k] = static_cast<float>(pixel[k]) * scale;
            }
        }
        return image;
    }

private:
    std::string next_line() {
        const std::size_t end = content_.find('\n', position_);
        if (end == std::string::npos) refuse_image(path_, "damaged Radiance HDR: the header does not end");
        std::string line = content_.substr(position_, end - position_);
        if (!line.empty() && line.back() == '\r') line.pop_back();
        position_ = end + 1;
        return line;
    }

    Bitmap read_header() {
        bool rgbe = false;
        for (std::string line = next_line(); !line.empty(); line = next_line()) {
            rgbe = rgbe || line.starts_with("FORMAT=32-bit_rle_rgbe");
            if (line.starts_with("FORMAT=32-bit_rle_xyze"))
                refuse_image(path_, "the image holds XYZ colours; expected the format 32-bit_rle_rgbe");
        }
        if (!rgbe) refuse_image(path_, "the header does not name the format 32-bit_rle_rgbe");
        std::istringstream resolution(next_line());
        std::string y_axis, x_axis;
        std::int64_t height = 0, width = 0;
        resolution >> y_axis >> height >> x_axis >> width;
        if (!resolution || y_axis != "-Y" || x_axis != "+X")
            refuse_image(path_, "cannot read the resolution; expected `-Y <height> +X <width>`");
        return make_image(path_, width, height);
    }

    std::uint8_t next() {
        if (position_ >= content_.size())
            refuse_image(path_, "damaged Radiance HDR: the file ends inside its data");
        return static_cast<std::uint8_t>(content_[position_++]);
    }

    void read_row(std::vector<Pixel>& row) {
        const bool may_be_packed = row.size() >= 8 && row.size() <= 0x7fff && position_ + 4 <= content_.size();
        const std::string start = may_be_packed ? content_.substr(position_, 4) : "";
        if (!may_be_packed || start[0] != 2 || start[1] != 2 ||
            (static_cast<std::uint8_t>(start[2]) & 0x80U) != 0) {
            for (Pixel& pixel : row)
                for (std::uint8_t& byte : pixel) byte = next();
            return;
        }
        const std::size_t width = static_cast<std::uint8_t>(start[2]) * 256U + static_cast<std::uint8_t>(start[3]);
        if (width != row.size()) refuse_image(path_, "damaged Radiance HDR: a scanline has the wrong width");
        position_ += 4;
        for (std::size_t channel = 0; channel < 4; ++channel) read_channel(row, channel);
    }

    // Runs of one value (length above 128) and of different ones.
    void read_channel(std::vector<Pixel>& row, std::size_t channel) {
        for (std::size_t x = 0; x < row.size();) {
            const std::size_t code = next();
            const bool repeated = code > 128;
            const std::size_t length = repeated ? code - 128 : code;
            if (length == 0 || length > row.size() - x)
                refuse_image(path_, "damaged Radiance HDR: a run is too long");
            std::uint8_t value = repeated ? next() : std::uint8_t{0};
            for (std::size_t k = 0; k < length; ++k) {
                if (!repeated) value = next();
                row[x++][channel] = value;
            }
        }
    }

    const std::string& path_;
    const std::string& content_;
    std::size_t position_ = 0;
};

}  // namespace

Bitmap decode_radiance(const std::string& path, const std::string& content) {
    return RadianceReader(path, content).read();
}

}  // namespace wavelobe
