#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include "film/exr.h"

namespace wavelobe {
namespace {

// A growing file in memory: the library's own file stream loses a full disk when it closes.
class MemoryStream : public Imf::OStream {
public:
    MemoryStream() : Imf::OStream("memory") {}

    void write(const char bytes[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
        bytes_.replace(position_, size, bytes, size);
        position_ += size;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    std::size_t position_ = 0;
};

// Imath multiplies row vectors from the left: element [i][j] there is column i, row j here.
Imath::M44f imath(const glm::dmat4& matrix) {
    Imath::M44f out;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) out[i][j] = static_cast<float>(matrix[i][j]);
    }
    return out;
}

}  // namespace

std::string encode_exr(const Image& image, const Film& film, const Camera& camera, const PictureNotes& notes) {
    const Imath::Box2i display({0, 0}, {film.width - 1, film.height - 1});
    const Imath::Box2i data({film.crop_x, film.crop_y}, {film.crop_x + image.width - 1, film.crop_y + image.height - 1});
    Imf::Header header(display, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.insert("software", Imf::StringAttribute("Wavelobe " WAVELOBE_VERSION));
    header.insert("wavelobe.scene", Imf::StringAttribute(notes.scene));
    header.insert("wavelobe.spp", Imf::IntAttribute(notes.samples_per_pixel));
    header.insert("wavelobe.samples", Imf::DoubleAttribute(static_cast<double>(notes.samples)));
    header.insert("wavelobe.seed", Imf::StringAttribute(std::to_string(notes.seed)));  // no unsigned attribute exists
    header.insert("wavelobe.seconds", Imf::DoubleAttribute(notes.seconds));
    Imf::addWorldToCamera(header, imath(world_to_camera(camera)));
    Imf::addWorldToNDC(header, imath(world_to_ndc(camera, film)));

    const char* const names[] = {"R", "G", "B"};
    const std::size_t pixel_bytes = 3 * sizeof(float);
    const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(image.width);
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < 3; ++i) {
        header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
        // The library only reads through this pointer.
        frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + i, data, pixel_bytes, row_bytes));
    }
    for (const ImageChannel& channel : image.channels) {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
        frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), data, sizeof(float),
                                                    sizeof(float) * static_cast<std::size_t>(image.width)));
    }
    MemoryStream stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    }
    return stream.take();
}

}  // namespace wavelobe
