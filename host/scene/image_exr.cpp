// OpenEXR images.
#include <array>
#include <exception>
#include <filesystem>
#include <map>

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>

#include "scene/image_formats.h"

namespace wavelobe {

namespace {

// Deflate at its best on one channel of two bytes; the other codes come near.
constexpr double most_pixels_a_byte = 1032.0;

// Names of the channels of a layer, by what comes behind the last dot.
struct Layer {
    std::string red, green, blue, grey;
    bool is_colour() const { return !red.empty() && !green.empty() && !blue.empty(); }
};

// The channels for red, green and blue, all the same for a grey image: of the layer without a name, or else of the first that has
// them.
std::array<std::string, 3> find_channels(const Imf::ChannelList& channels, const std::string& path) {
    std::map<std::string, Layer> layers;
    std::string all;
    bool xyz = false;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        all += (all.empty() ? "" : ", ") + name;
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) continue;
        const std::size_t dot = name.rfind('.');
        const std::string last = name.substr(dot == std::string::npos ? 0 : dot + 1);
        Layer& layer = layers[dot == std::string::npos ? "" : name.substr(0, dot)];
        if (last == "R" || last == "r") layer.red = name;
        if (last == "G" || last == "g") layer.green = name;
        if (last == "B" || last == "b") layer.blue = name;
        if (last == "Y" || last == "y" || last == "L") layer.grey = name;
        xyz = xyz || last == "X";
    }
    for (const auto& [name, layer] : layers)
        if (layer.is_colour()) return {layer.red, layer.green, layer.blue};
    for (const auto& [name, layer] : layers)
        if (!layer.grey.empty() && !xyz) return {layer.grey, layer.grey, layer.grey};
    refuse_image(path, "the image has the channels " + all + "; expected R, G and B, or Y, with a value a pixel");
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

// Y with the colour differences RY and BY, which are stored for every other pixel.
bool is_luminance_chroma(const Imf::ChannelList& channels) {
    return channels.findChannel("Y") != nullptr && channels.findChannel("RY") != nullptr && channels.findChannel("BY") != nullptr;
}

Bitmap decode_luminance_chroma(const std::string& path, Bitmap&& image) {
    Imf::RgbaInputFile file(path.c_str());
    const Imath::Box2i window = file.dataWindow();
    const auto width = static_cast<std::ptrdiff_t>(image.width);
    std::vector<Imf::Rgba> pixels(image.rgb.size() / 3);
    // OpenEXR addresses pixels by their position in the data window, which may be anywhere: the place of its (0, 0) is no pointer into anything.
    const std::int64_t before = std::int64_t{window.min.x} + width * std::int64_t{window.min.y};
    const std::uintptr_t origin = reinterpret_cast<std::uintptr_t>(pixels.data()) - static_cast<std::uintptr_t>(before) * sizeof(Imf::Rgba);
    file.setFrameBuffer(reinterpret_cast<Imf::Rgba*>(origin), 1, static_cast<std::size_t>(width));
    file.readPixels(window.min.y, window.max.y);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        image.rgb[3 * i] = pixels[i].r;
        image.rgb[3 * i + 1] = pixels[i].g;
        image.rgb[3 * i + 2] = pixels[i].b;
    }
    to_rec709(file.header(), image);
    return std::move(image);
}

Bitmap decode(const std::string& path) {
    const std::size_t file_size = std::filesystem::file_size(path);
    Imf::InputFile file(path.c_str());
    if (file.header().hasType() && Imf::isDeepData(file.header().type()))
        refuse_image(path, "the image is deep, with several samples a pixel; expected a flat one");
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    Bitmap image = make_image(path, width, std::int64_t{window.max.y} - window.min.y + 1, file_size, most_pixels_a_byte);
    if (is_luminance_chroma(file.header().channels())) return decode_luminance_chroma(path, std::move(image));
    const std::array<std::string, 3> names = find_channels(file.header().channels(), path);
    const bool grey = names[0] == names[1];
    const std::size_t pixel = 3 * sizeof(float);
    const std::size_t row = pixel * static_cast<std::size_t>(width);
    Imf::FrameBuffer buffer;
    for (std::size_t k = 0; k < (grey ? 1U : 3U); ++k)
        buffer.insert(names[k], Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + k, window, pixel, row));
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
