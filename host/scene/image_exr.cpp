// OpenEXR images.
#include <array>
#include <exception>

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

// The channels for red, green and blue, all the same for a grey image. A layer's name may come first.
std::array<std::string, 3> find_channels(const Imf::ChannelList& channels, const std::string& path) {
    std::array<std::string, 3> rgb;
    std::string grey;
    std::string all;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        const std::string last = name.substr(name.rfind('.') + 1);
        all += (all.empty() ? "" : ", ") + name;
        const bool full_size = channel.channel().xSampling == 1 && channel.channel().ySampling == 1;
        const auto take = [&](std::string& place) {
            if (!place.empty())
                refuse_image(path, "the image has more than one `" + last + "` channel; expected a single layer");
            if (!full_size)
                refuse_image(path, "the channel `" + name + "` is subsampled; expected one value a pixel");
            place = name;
        };
        if (last == "R" || last == "r") take(rgb[0]);
        if (last == "G" || last == "g") take(rgb[1]);
        if (last == "B" || last == "b") take(rgb[2]);
        if (last == "Y" || last == "y") take(grey);
    }
    if (!rgb[0].empty() && !rgb[1].empty() && !rgb[2].empty()) return rgb;
    const bool other_colours = all.find('X') != std::string::npos || all.find("RY") != std::string::npos;
    if (grey.empty() || other_colours)
        refuse_image(path, "the image has the channels " + all + "; expected R, G and B, or Y");
    return {grey, grey, grey};
}

// Files with other primaries are brought to those of Rec. 709.
void to_rec709(const Imf::Header& header, Bitmap& image) {
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities file = Imf::chromaticities(header);
    const Imf::Chromaticities rec709;
    const auto differ = [](const Imath::V2f& a, const Imath::V2f& b) { return (a - b).length2(); };
    if (differ(file.red, rec709.red) + differ(file.green, rec709.green) + differ(file.blue, rec709.blue) +
            differ(file.white, rec709.white) <
        1e-6F)
        return;
    const Imath::M44f matrix = Imf::RGBtoXYZ(file, 1.0F) * Imf::XYZtoRGB(rec709, 1.0F);
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        const Imath::V3f rgb = Imath::V3f(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]) * matrix;
        for (unsigned k = 0; k < 3; ++k) image.rgb[i + k] = rgb[static_cast<int>(k)];
    }
}

Bitmap decode(const std::string& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    Bitmap image = make_image(path, width, std::int64_t{window.max.y} - window.min.y + 1);
    const std::array<std::string, 3> names = find_channels(file.header().channels(), path);
    const bool grey = names[0] == names[1];
    const std::size_t pixel = 3 * sizeof(float);
    const std::size_t row = pixel * static_cast<std::size_t>(width);
    // OpenEXR addresses pixels by their position in the data window.
    char* origin = reinterpret_cast<char*>(image.rgb.data()) - static_cast<std::ptrdiff_t>(pixel) * window.min.x -
                   static_cast<std::ptrdiff_t>(row) * window.min.y;
    Imf::FrameBuffer buffer;
    for (std::size_t k = 0; k < (grey ? 1U : 3U); ++k)
        buffer.insert(names[k], Imf::Slice(Imf::FLOAT, origin + k * sizeof(float), pixel, row));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (grey)
        for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
            image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
    else to_rec709(file.header(), image);
    return image;
}

}  // namespace

Bitmap decode_exr(const std::string& path) {
    try {
        return decode(path);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        refuse_image(path, std::string("damaged OpenEXR: ") + error.what());
    }
}

}  // namespace wavelobe
