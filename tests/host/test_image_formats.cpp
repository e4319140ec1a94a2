// The less usual forms of image files: axis orders and old runs of Radiance HDR, CMYK and progressive JPEG, small PNGs, layers and
// luminance of OpenEXR, PFM, PPM, BMP, TGA.
#include <gtest/gtest.h>

#include <ImfRgbaFile.h>
#include <jpeglib.h>

#include <cstdio>

#include "host/scene_files.h"
#include "scene/image.h"

namespace wavelobe::test {
namespace {

std::vector<float> colours_of(const std::string& name, const std::string& content, Transfer transfer = Transfer::linear) {
    return decode_image(name, content, transfer).rgb;
}

std::string corpus(const std::string& name) {
    std::ifstream stream(std::string(WAVELOBE_SOURCE_DIR) + "/tests/fuzz/corpus/image/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string fault_of(const std::string& content) {
    try {
        decode_image("input", content, Transfer::linear);
    } catch (const InputError& error) {
        return error.faults().at(0).message;
    }
    return "";
}

// Two rows of three pixels, named by their red: 1 2 3 / 4 5 6.
std::string radiance(const std::string& axes, const std::string& reds, const std::string& format = "rgbe") {
    std::string out = "#?RADIANCE\nFORMAT=32-bit_rle_" + format + "\n\n" + axes + "\n";
    for (const char red : reds) out += std::string{red, 0, 0, static_cast<char>(136)};
    return out;
}

TEST(ImageFormats, RadianceOfEveryOrder) {
    struct Order {
        const char* axes;
        const char* reds;
    };
    for (const Order& order : {Order{"-Y 2 +X 3", "\1\2\3\4\5\6"}, Order{"+Y 2 +X 3", "\4\5\6\1\2\3"},
                               Order{"-Y 2 -X 3", "\3\2\1\6\5\4"}, Order{"+Y 2 -X 3", "\6\5\4\3\2\1"},
                               Order{"+X 3 -Y 2", "\1\4\2\5\3\6"}, Order{"+X 3 +Y 2", "\4\1\5\2\6\3"},
                               Order{"-X 3 -Y 2", "\3\6\2\5\1\4"}, Order{"-X 3 +Y 2", "\6\3\5\2\4\1"}}) {
        const Bitmap image = decode_image("a.hdr", radiance(order.axes, order.reds), Transfer::of_format);
        ASSERT_EQ(image.width, 3) << order.axes;
        ASSERT_EQ(image.height, 2) << order.axes;
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(image.rgb[3 * i], static_cast<float>(i + 1)) << order.axes;
    }
    EXPECT_NE(fault_of(radiance("-Y 2 +Y 3", "\1\2\3\4\5\6")), "");
}

// Mantissas of 1, 1, 1 repeat the pixel before; a second one in a row counts 256 times as much.
TEST(ImageFormats, RadianceOldRuns) {
    const std::string run{1, 1, 1};
    const std::string content = radiance("-Y 1 +X 263", "\7") + run + '\5' + run + '\1' + std::string("\2\0\0\x88", 4);
    const std::vector<float> rgb = colours_of("a.hdr", content);
    ASSERT_EQ(rgb.size(), 3U * 263U);
    for (std::size_t i = 0; i < 262; ++i) ASSERT_EQ(rgb[3 * i], 7.0F) << i;
    EXPECT_EQ(rgb[3 * 262], 2.0F);
    EXPECT_NE(fault_of(radiance("-Y 1 +X 4", "\7") + run + '\5'), "");
}

TEST(ImageFormats, RadianceXyz) {
    const std::vector<float> rgb = colours_of("a.hdr", radiance("-Y 1 +X 1", "\4", "xyze"));
    EXPECT_NEAR(rgb[0], 4.0F * 3.240479F, 1e-4F);
    EXPECT_EQ(rgb[1], 0.0F);  // out of gamut
    EXPECT_NEAR(rgb[2], 4.0F * 0.055648F, 1e-4F);
}

// Ink of the four colours, the way programs of Adobe's (by their marker) and others store it.
std::string cmyk_jpeg(std::array<JSAMPLE, 4> inks, bool adobe, bool ycck) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = jpeg.image_height = 8;
    jpeg.input_components = 4;
    jpeg.in_color_space = JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, ycck ? JCS_YCCK : JCS_CMYK);
    jpeg.write_Adobe_marker = adobe ? TRUE : FALSE;
    jpeg_set_quality(&jpeg, 100, TRUE);
    jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> row;
    for (int x = 0; x < 8; ++x) row.insert(row.end(), inks.begin(), inks.end());
    JSAMPROW pointer = row.data();
    for (int y = 0; y < 8; ++y) jpeg_write_scanlines(&jpeg, &pointer, 1);
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string out(reinterpret_cast<const char*>(bytes), size);
    std::free(bytes);
    return out;
}

TEST(ImageFormats, CmykJpeg) {
    // Light let through: 200, 100 and 50 of 255, and 204 by black.
    const glm::vec3 expected = glm::vec3(200, 100, 50) / 255.0F * (204.0F / 255.0F);
    for (const bool ycck : {false, true}) {
        const std::vector<float> rgb = colours_of("a.jpg", cmyk_jpeg({200, 100, 50, 204}, true, ycck));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[static_cast<std::size_t>(c)], expected[c], 2.0F / 255.0F) << ycck;
    }
    const std::vector<float> rgb = colours_of("a.jpg", cmyk_jpeg({55, 155, 205, 51}, false, false));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[static_cast<std::size_t>(c)], expected[c], 2.0F / 255.0F);
}

TEST(ImageFormats, SmallPng) {
    EXPECT_EQ(colours_of("a.png", corpus("grey1.png")), (std::vector<float>{1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 1}));
    const std::vector<float> palette = colours_of("a.png", corpus("palette4.png"));
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(palette[i], static_cast<float>(i) / 255.0F);
    EXPECT_EQ(colours_of("a.png", corpus("palette4.png"), Transfer::alpha)[0], 128.0F / 255.0F);
    EXPECT_EQ(colours_of("a.png", corpus("rgba16.png"))[1], 1.0F / 65535.0F);
    EXPECT_EQ(colours_of("a.png", corpus("interlaced.png"))[0], 0x99 / 255.0F);
}

TEST(ImageFormats, OpenExrOfLuminanceAndChroma) {
    const SceneFolder folder;
    const std::vector<Imf::Rgba> pixels(64, Imf::Rgba(0.5F, 0.25F, 0.75F, 1.0F));
    {
        Imf::RgbaOutputFile file(folder.path("yc.exr").c_str(), 8, 8, Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, 8);
        file.writePixels(8);
    }
    const Bitmap image = load_image(folder.path("yc.exr"), Transfer::of_format);
    ASSERT_EQ(image.width, 8);
    for (std::size_t i = 0; i < 64; ++i) {
        ASSERT_NEAR(image.rgb[3 * i], 0.5F, 0.005F);
        ASSERT_NEAR(image.rgb[3 * i + 1], 0.25F, 0.005F);
        ASSERT_NEAR(image.rgb[3 * i + 2], 0.75F, 0.005F);
    }
}

// Found by fuzzing: the library would take gigabytes.
TEST(ImageFormats, OpenExrHeadersThatClaimTooMuch) {
    for (const char* name : {"attribute_longer_than_file", "attribute_of_wrong_size", "attribute_of_wrong_size_2", "channels_under_another_name"}) {
        const std::string path = std::string(WAVELOBE_SOURCE_DIR) + "/tests/fuzz/corpus/exr/" + name + ".exr";
        try {
            load_image(path, Transfer::of_format);
            FAIL() << name;
        } catch (const InputError& error) {
            EXPECT_NE(error.faults().at(0).message.find("at byte"), std::string::npos) << error.faults()[0].message;
        }
    }
}

TEST(ImageFormats, PixmapsAndFloatMaps) {
    EXPECT_EQ(colours_of("a", "P3 2 1 # two\n255\n255 0 51 5 4 3\n"), (std::vector<float>{1, 0, 0.2F, 5 / 255.0F, 4 / 255.0F, 3 / 255.0F}));
    EXPECT_EQ(colours_of("a", "P2 1 1 4 2 "), (std::vector<float>{0.5F, 0.5F, 0.5F}));
    EXPECT_EQ(colours_of("a", std::string("P5 1 1 65535\n\x80\x00", 15)), std::vector<float>(3, 32768 / 65535.0F));
    EXPECT_EQ(colours_of("a", "P6 1 1 255\n3<\xff"), (std::vector<float>{51 / 255.0F, 60 / 255.0F, 1}));
    // Rows from the bottom, either byte order.
    EXPECT_EQ(colours_of("a", corpus("le.pfm"), Transfer::of_format), (std::vector<float>{3, 4, 5, 0, 1, 2}));
    EXPECT_EQ(colours_of("a", corpus("be.pfm"), Transfer::of_format), (std::vector<float>{2, 2, 2, 1, 1, 1}));
    EXPECT_NE(fault_of("P6 60000 60000 255\nabc"), "");
    EXPECT_NE(fault_of("P6 2 2 255\nabc"), "");
    EXPECT_NE(fault_of("PF 2 2 0\n"), "");
}

TEST(ImageFormats, BitmapsAndTarga) {
    const auto bytes = [](std::initializer_list<int> values) {
        std::vector<float> out;
        for (const int v : values) out.push_back(static_cast<float>(v) / 255.0F);
        return out;
    };
    EXPECT_EQ(colours_of("a.bmp", corpus("palette.bmp")), bytes({3, 2, 1, 6, 5, 4}));
    std::string rgb = corpus("rgb.bmp");
    rgb.replace(54, 6, "\1\2\3\4\5\6");
    EXPECT_EQ(colours_of("a.bmp", rgb), bytes({3, 2, 1, 6, 5, 4}));
    EXPECT_EQ(colours_of("a.tga", corpus("rle.tga")), bytes({'c', 'b', 'a', 'c', 'b', 'a', 'f', 'e', 'd'}));
    EXPECT_EQ(colours_of("a.tga", corpus("palette.tga")), bytes({'c', 'b', 'a', 'f', 'e', 'd'}));
    EXPECT_NE(fault_of(rgb.substr(0, 58)), "");
}

}  // namespace
}  // namespace wavelobe::test
