// The headers of OpenEXR files, looked through before the library allocates what they claim.
#include <algorithm>
#include <array>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

// Deflate at its best, with some room for the other codes.
constexpr double most_inflation = 4096.0;
// Chunks of scanlines are of 256 rows at the most, and whole in memory.
constexpr double chunk_rows = 256.0;
constexpr double small_chunk = 0x1p28;
constexpr std::size_t longest_name = 255;

// The library reads these whole, whatever size the header gives them.
struct FixedType {
    const char* name;
    std::uint32_t size;
};
constexpr std::array<FixedType, 26> fixed_types{{
    {"box2i", 16}, {"box2f", 16}, {"chromaticities", 32}, {"compression", 1}, {"deepImageState", 1}, {"double", 8}, {"envmap", 1},
    {"float", 4}, {"int", 4}, {"keycode", 28}, {"lineOrder", 1}, {"m33d", 72}, {"m33f", 36}, {"m44d", 128}, {"m44f", 64},
    {"rational", 8}, {"tiledesc", 9}, {"timecode", 8}, {"v2d", 16}, {"v2f", 8}, {"v2i", 8}, {"v3d", 24}, {"v3f", 12}, {"v3i", 12},
    {"v4f", 16}, {"v4d", 32},
}};

class HeaderCheck {
public:
    HeaderCheck(const std::string& path, const std::string& content) : path_(path), content_(content) {}

    void run() {
        const bool many_parts = (number(4) & 0x1000U) != 0;
        position_ = 8;
        do {
            check_part();
        } while (many_parts && position_ < content_.size() && content_[position_] != '\0');
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        refuse_image(path_, "damaged OpenEXR: " + message + " (at byte " + std::to_string(position_) + ")");
    }

    std::uint32_t number(std::size_t at) const {
        if (at > content_.size() || content_.size() - at < 4) fail("the file ends inside its header");
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value |= std::uint32_t{static_cast<std::uint8_t>(content_[at + k])} << (8 * k);
        return value;
    }

    std::string name() {
        const std::size_t end = content_.find('\0', position_);
        if (end == std::string::npos || end - position_ > longest_name) fail("a name in the header does not end");
        std::string out = content_.substr(position_, end - position_);
        position_ = end + 1;
        return out;
    }

    // Bytes that a pixel takes, from the list of channels: name, type, four bytes, two sampling rates.
    double pixel_bytes(std::size_t at, std::size_t end) const {
        double bytes = 0.0;
        while (at < end && content_[at] != '\0') {
            const std::size_t behind = content_.find('\0', at);
            if (behind == std::string::npos || behind + 17 > end) fail("the list of channels is cut short");
            bytes += number(behind + 1) == 1 ? 2.0 : 4.0;
            at = behind + 17;
        }
        if (at + 1 != end) fail("the list of channels has the wrong length");
        return bytes;
    }

    // Each string behind its length.
    void check_strings(std::size_t at, std::size_t end) const {
        while (at < end) {
            const std::uint32_t length = number(at);
            if (end - at < 4 || length > end - at - 4) fail("a list of strings is cut short");
            at += 4 + std::size_t{length};
        }
    }

    void check_preview(std::uint32_t size) const {
        const std::uint64_t pixels = size < 8 ? 0 : std::uint64_t{number(position_)} * number(position_ + 4);
        if (size < 8 || pixels > content_.size() || pixels * 4 + 8 != size) fail("the preview has the wrong size");
    }

    void check_part() {
        double width = 0.0, height = 0.0, bytes = 0.0, tile_pixels = 0.0;
        for (std::string key = name(); !key.empty(); key = name()) {
            const std::string type = name();
            const std::uint32_t size = number(position_);
            position_ += 4;
            if (size > content_.size() - position_) fail("`" + key + "` is longer than the file");
            for (const FixedType& fixed : fixed_types)
                if (type == fixed.name && size != fixed.size) fail("`" + key + "` has the wrong size");
            if (type == "floatvector" && size % 4 != 0) fail("`" + key + "` has the wrong size");
            if (type == "stringvector") check_strings(position_, position_ + size);
            if (type == "preview") check_preview(size);
            const auto signed_at = [&](std::size_t offset) { return static_cast<double>(static_cast<std::int32_t>(number(position_ + offset))); };
            if (key == "dataWindow" && size == 16) {
                width = signed_at(8) - signed_at(0) + 1.0;
                height = signed_at(12) - signed_at(4) + 1.0;
            }
            if (key == "tiles" && size == 9) tile_pixels = static_cast<double>(number(position_)) * static_cast<double>(number(position_ + 4));
            // The library reads such a list to its end, whatever its size and its name.
            if (type == "chlist") {
                const double listed = pixel_bytes(position_, position_ + size);
                if (key == "channels") bytes = listed;
            }
            if (key == "chunkCount" && size == 4 && number(position_) > content_.size() / 8) fail("it claims more chunks than it can hold");
            position_ += size;
        }
        check_size(width, height, bytes, tile_pixels);
    }

    void check_size(double width, double height, double bytes, double tile_pixels) const {
        const auto held = static_cast<double>(content_.size());
        if (width > 0x1p16 || height > 0x1p16 || width < 1.0 || height < 1.0)
            refuse_image(path_, "the image claims " + std::to_string(static_cast<std::int64_t>(width)) + " x " +
                                    std::to_string(static_cast<std::int64_t>(height)) + " pixels; expected at most 65536 a side");
        if (width * height * bytes > held * most_inflation) fail("the file is too short for the pixels it claims");
        if (width * chunk_rows * bytes > std::max(small_chunk, held * most_inflation)) fail("a chunk is too large");
        const double tiles = tile_pixels > 0.0 ? width * height / tile_pixels : 0.0;
        if (tile_pixels * bytes > small_chunk || 8.0 * tiles > held) fail("the tiles are too large, or too many");
    }

    const std::string& path_;
    const std::string& content_;
    std::size_t position_ = 0;
};

}  // namespace

void check_exr_header(const std::string& path, const std::string& content) { HeaderCheck(path, content).run(); }

}  // namespace wavelobe
