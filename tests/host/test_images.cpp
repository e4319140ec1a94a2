// Image files: decoding, colour, and damage.
#include <gtest/gtest.h>

#include <ImfRgbaFile.h>
#include <jpeglib.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "host/scene_files.h"
#include "scene/image.h"

namespace wavelobe::test {
namespace {

const std::vector<std::uint8_t> colours{255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30, 128, 128, 128, 255, 255, 255};

void write_png(const std::string& path, png_uint_32 format, unsigned width, unsigned height, const void* pixels) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = format;
    ASSERT_NE(png_image_write_to_file(&image, path.c_str(), 0, pixels, 0, nullptr), 0);
}

void write_jpeg(const std::string& path, unsigned size, std::array<std::uint8_t, 3> colour) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    ASSERT_NE(file, nullptr);
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, file);
    jpeg.image_width = jpeg.image_height = size;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> row;
    for (unsigned x = 0; x < size; ++x) row.insert(row.end(), colour.begin(), colour.end());
    for (unsigned y = 0; y < size; ++y) {
        JSAMPROW pointer = row.data();
        jpeg_write_scanlines(&jpeg, &pointer, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::fclose(file);
}

std::string file_content(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string fault_of(const std::string& path) {
    try {
        load_image(path, Transfer::of_format);
    } catch (const InputError& error) {
        EXPECT_EQ(error.faults().at(0).file, path);
        return error.faults()[0].message;
    }
    return "";
}

TEST(Images, PngIsSrgbUnlessRaw) {
    const SceneFolder folder;
    const std::string path = folder.path("a.png");
    write_png(path, PNG_FORMAT_RGB, 3, 2, colours.data());
    const Bitmap image = load_image(path, Transfer::of_format);
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.rgb[0], 1.0F);
    EXPECT_EQ(image.rgb[1], 0.0F);
    EXPECT_NEAR(image.rgb[9], 0.00303527F, 1e-7F);
    EXPECT_NEAR(image.rgb[12], 0.21586F, 1e-5F);
    const Bitmap raw = load_image(path, Transfer::linear);
    EXPECT_NEAR(raw.rgb[12], 128.0F / 255.0F, 1e-7F);
}

TEST(Images, GreyPngFillsAllChannelsAndAlphaIsLeftOut) {
    const SceneFolder folder;
    const std::array<std::uint8_t, 4> grey_alpha{100, 255, 200, 0};
    write_png(folder.path("ga.png"), PNG_FORMAT_GA, 2, 1, grey_alpha.data());
    const Bitmap image = load_image(folder.path("ga.png"), Transfer::linear);
    ASSERT_EQ(image.rgb.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(image.rgb[i], (i < 3 ? 100.0F : 200.0F) / 255.0F, 1e-7F);
}

TEST(Images, JpegIsSrgb) {
    const SceneFolder folder;
    write_jpeg(folder.path("a.jpg"), 16, {128, 128, 128});
    const Bitmap image = load_image(folder.path("a.jpg"), Transfer::of_format);
    EXPECT_EQ(image.width, 16);
    EXPECT_NEAR(image.rgb[100], 0.21586F, 1e-5F);
}

TEST(Images, OpenExrIsLinear) {
    const SceneFolder folder;
    const std::vector<Imf::Rgba> pixels{{0.5F, 2.0F, 0.25F, 0.5F}, {1.0F, 8.0F, 0.0F, 1.0F}};
    {
        Imf::RgbaOutputFile file(folder.path("a.exr").c_str(), 2, 1, Imf::WRITE_RGBA);
        file.setFrameBuffer(pixels.data(), 1, 2);
        file.writePixels(1);
    }
    EXPECT_EQ(load_image(folder.path("a.exr"), Transfer::of_format).rgb,
              (std::vector<float>{0.5F, 2, 0.25F, 1, 8, 0}));
    {
        Imf::RgbaOutputFile file(folder.path("y.exr").c_str(), 2, 1, Imf::WRITE_Y);
        file.setFrameBuffer(pixels.data(), 1, 2);
        file.writePixels(1);
    }
    const Bitmap grey = load_image(folder.path("y.exr"), Transfer::of_format);
    EXPECT_EQ(grey.rgb[0], grey.rgb[2]);
    EXPECT_GT(grey.rgb[0], 0.0F);
}

TEST(Images, RadianceFlatAndPacked) {
    const SceneFolder folder;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X ";
    folder.write("flat.hdr", header + "2\n" + std::string("\x80\x40\x20\x81\x01\x02\x03\x00", 8));
    EXPECT_EQ(load_image(folder.path("flat.hdr"), Transfer::of_format).rgb,
              (std::vector<float>{1, 0.5F, 0.25F, 0, 0, 0}));
    // Eight pixels: red all alike, green one by one, blue and the exponent alike.
    const std::string packed("\x02\x02\x00\x08\x88\x80\x08\x00\x10\x20\x30\x40\x50\x60\x70\x88\x00\x88\x82", 19);
    folder.write("packed.hdr", header + "8\n" + packed);
    const Bitmap image = load_image(folder.path("packed.hdr"), Transfer::of_format);
    for (std::size_t x = 0; x < 8; ++x) {
        EXPECT_EQ(image.rgb[3 * x], 2.0F);
        EXPECT_EQ(image.rgb[3 * x + 1], static_cast<float>(x) * 0.25F);
        EXPECT_EQ(image.rgb[3 * x + 2], 0.0F);
    }
    for (std::size_t size = 0; size < packed.size(); ++size) {
        folder.write("cut.hdr", header + "8\n" + packed.substr(0, size));
        EXPECT_NE(fault_of(folder.path("cut.hdr")), "") << size;
    }
    folder.write("huge.hdr", header + "9999999999\n");
    EXPECT_NE(fault_of(folder.path("huge.hdr")).find("claims"), std::string::npos);
}

TEST(Images, DamageIsRefused) {
    const SceneFolder folder;
    write_png(folder.path("a.png"), PNG_FORMAT_RGB, 3, 2, colours.data());
    write_jpeg(folder.path("a.jpg"), 32, {200, 10, 60});
    {
        const std::vector<Imf::Rgba> pixels(64 * 64);
        Imf::RgbaOutputFile file(folder.path("a.exr").c_str(), 64, 64, Imf::WRITE_RGB);
        file.setFrameBuffer(pixels.data(), 1, 64);
        file.writePixels(64);
    }
    for (const char* name : {"a.png", "a.jpg", "a.exr"}) {
        const std::string whole = file_content(folder.path(name));
        for (std::size_t cut = 1; cut < whole.size(); cut += std::max<std::size_t>(1, whole.size() / 50)) {
            folder.write(std::string("cut-") + name, whole.substr(0, whole.size() - cut));
            EXPECT_NE(fault_of(folder.path(std::string("cut-") + name)), "") << name << " " << cut;
        }
    }
    // A size no picture has, with a checksum that fits it.
    std::string png = file_content(folder.path("a.png"));
    png.replace(16, 8, std::string("\x7f\xff\xff\xff\x7f\xff\xff\xff", 8));
    folder.write("huge.png", png);
    EXPECT_NE(fault_of(folder.path("huge.png")), "");
    folder.write("text.png", "not an image at all");
    EXPECT_NE(fault_of(folder.path("text.png")).find("supported format"), std::string::npos);
    EXPECT_NE(fault_of(folder.path("absent.png")).find("cannot"), std::string::npos);
}

TEST(Images, TexturesAreSharedAndScalarsAreLuminance) {
    const SceneFolder folder;
    write_png(folder.path("a.png"), PNG_FORMAT_RGB, 3, 2, colours.data());
    const std::string bitmap = R"(type="bitmap"><string name="filename" value="a.png"/>)";
    const Scene scene = folder.elements(
        "<bsdf type=\"diffuse\" id=\"one\"><texture name=\"reflectance\" " + bitmap + "</texture></bsdf>" +
        "<bsdf type=\"plastic\" id=\"two\"><texture name=\"diffuse_reflectance\" " + bitmap +
        "<string name=\"wrap_mode\" value=\"repeat\"/></texture></bsdf>" +
        "<bsdf type=\"roughconductor\" id=\"three\"><texture name=\"alpha\" " + bitmap +
        R"(<string name="filter_type" value="nearest"/><string name="wrap_mode" value="mirror"/><boolean name="raw" value="true"/>
           <transform name="to_uv"><scale x="2" y="3"/><translate x="0.5" y="0.25"/></transform></texture></bsdf>)" +
        R"(<shape type="cube"><ref id="one"/></shape><shape type="cube"><ref id="two"/></shape><shape type="cube"><ref id="three"/></shape>)");
    const auto first = std::get<Diffuse>(scene.materials.at(0).model).reflectance.texture;
    const auto second = std::get<Plastic>(scene.materials.at(1).model).diffuse_reflectance.texture;
    const auto rough = std::get<RoughConductor>(scene.materials.at(2).model).alpha_u.texture;
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(first, second);
    ASSERT_NE(rough, nullptr);
    const auto& alpha = std::get<Bitmap>(rough->source);
    EXPECT_EQ(alpha.filter, Filter::nearest);
    EXPECT_EQ(alpha.wrap, Wrap::mirror);
    EXPECT_NEAR(alpha.rgb[0], 0.212671F, 1e-6F);
    EXPECT_EQ(alpha.rgb[0], alpha.rgb[2]);
    EXPECT_EQ(rough->to_uv * glm::vec3(1, 1, 1), glm::vec3(2.5F, 3.25F, 1));
}

TEST(Images, EnvironmentMapsHaveTwoByThreeTexelsAtLeast) {
    const SceneFolder folder;
    write_png(folder.path("a.png"), PNG_FORMAT_RGB, 1, 2, colours.data());
    const Scene scene = folder.elements(
        R"(<emitter type="envmap"><string name="filename" value="a.png"/><float name="scale" value="2"/></emitter>)");
    const auto& map = std::get<EnvironmentMap>(scene.emitters.at(0));
    EXPECT_EQ(map.scale, 2.0F);
    EXPECT_EQ(map.image.width, 2);
    EXPECT_EQ(map.image.height, 3);
    EXPECT_EQ(map.image.rgb, (std::vector<float>{1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}));
}

}  // namespace
}  // namespace wavelobe::test
