// Radiance HDR images (.hdr, .rgbe): run-length encoded or flat.
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

// Runs of the old kind are the shortest: four bytes for 255 pixels, later ones for 256 times as many.
constexpr double most_pixels_a_byte = 65536.0 / 8.0;

using Pixel = std::array<std::uint8_t, 4>;  // three mantissas and the exponent they share

class RadianceReader {
public:
    RadianceReader(const std::string& path, const std::string& content) : path_(path), content_(content) {}

    Bitmap read() {
        Bitmap image = read_header();
        std::vector<Pixel> line(static_cast<std::size_t>(columns_first_ ? image.height : image.width));
        const int lines = columns_first_ ? image.width : image.height;
        for (int i = 0; i < lines; ++i) {
            read_row(line);
            for (int k = 0; k < static_cast<int>(line.size()); ++k) {
                const int x = columns_first_ ? i : k, y = columns_first_ ? k : i;
                store(image, right_to_left_ ? image.width - 1 - x : x, bottom_up_ ? image.height - 1 - y : y,
                      line[static_cast<std::size_t>(k)]);
            }
        }
        return image;
    }

private:
    void store(Bitmap& image, int x, int y, const Pixel& pixel) const {
        const float scale = pixel[3] == 0 ? 0.0F : std::ldexp(1.0F, pixel[3] - (128 + 8));
        glm::vec3 colour = scale * glm::vec3(pixel[0], pixel[1], pixel[2]);
        if (xyz_) colour = rec709_of_xyz(colour);
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
        for (int k = 0; k < 3; ++k) image.rgb[at + static_cast<std::size_t>(k)] = colour[k];
    }

    // Rows of the inverse of the primaries' matrix, white at D65.
    static glm::vec3 rec709_of_xyz(const glm::vec3& c) {
        return glm::max(glm::vec3(3.240479F * c.x - 1.537150F * c.y - 0.498535F * c.z,
                                  -0.969256F * c.x + 1.875991F * c.y + 0.041556F * c.z,
                                  0.055648F * c.x - 0.204043F * c.y + 1.057311F * c.z),
                        glm::vec3(0.0F));
    }

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
            xyz_ = xyz_ || line.starts_with("FORMAT=32-bit_rle_xyze");
        }
        if (!rgbe && !xyz_) refuse_image(path_, "the header names neither of the formats 32-bit_rle_rgbe and 32-bit_rle_xyze");
        std::istringstream resolution(next_line());
        std::string first, second;
        std::int64_t lines = 0, length = 0;
        resolution >> first >> lines >> second >> length;
        const auto is_axis = [](const std::string& axis, char name) { return axis == std::string("+") + name || axis == std::string("-") + name; };
        columns_first_ = is_axis(first, 'X') && is_axis(second, 'Y');
        if (!resolution || !(columns_first_ || (is_axis(first, 'Y') && is_axis(second, 'X'))))
            refuse_image(path_, "cannot read the resolution; expected two axes with their lengths, such as `-Y <height> +X <width>`");
        bottom_up_ = first == "+Y" || second == "+Y";
        right_to_left_ = first == "-X" || second == "-X";
        return make_image(path_, columns_first_ ? lines : length, columns_first_ ? length : lines, content_.size(), most_pixels_a_byte);
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
            return read_plain_row(row);
        }
        const std::size_t width = static_cast<std::uint8_t>(start[2]) * 256U + static_cast<std::uint8_t>(start[3]);
        if (width != row.size()) refuse_image(path_, "damaged Radiance HDR: a scanline has the wrong width");
        position_ += 4;
        for (std::size_t channel = 0; channel < 4; ++channel) read_channel(row, channel);
    }

    // Pixel by pixel; mantissas of 1, 1, 1 repeat the one before as often as the exponent says, several of them in a row with
    // its digits in base 256, the lowest first.
    void read_plain_row(std::vector<Pixel>& row) {
        unsigned shift = 0;
        for (std::size_t x = 0; x < row.size();) {
            Pixel pixel;
            for (std::uint8_t& byte : pixel) byte = next();
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                row[x++] = last_ = pixel;
                shift = 0;
                continue;
            }
            const std::size_t count = shift < 32 ? std::size_t{pixel[3]} << shift : row.size() + 1;
            if (count > row.size() - x) refuse_image(path_, "damaged Radiance HDR: a run is too long");
            for (std::size_t k = 0; k < count; ++k) row[x++] = last_;
            shift += 8;
        }
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
    bool xyz_ = false, columns_first_ = false, bottom_up_ = false, right_to_left_ = false;
    Pixel last_{};
};

}  // namespace

Bitmap decode_radiance(const std::string& path, const std::string& content) {
    return RadianceReader(path, content).read();
}

}  // namespace wavelobe
