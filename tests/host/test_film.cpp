// Pictures on disk and how they are compared.
#include <gtest/gtest.h>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <png.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "film/compare.h"
#include "film/exr.h"
#include "film/png.h"
#include "film/replace_file.h"
#include "scene/fault.h"
#include "scene/file.h"
#include "scene/image.h"

namespace wavelobe {
namespace {

namespace fs = std::filesystem;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class PictureFiles : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("wavelobe_film_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t file_count() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_;
};

using Exr = PictureFiles;
using ReplaceFile = PictureFiles;

Image noise(int width, int height) {
    std::mt19937 engine(1);
    std::lognormal_distribution<float> radiance(0.0F, 3.0F);
    Image image{width, height, std::vector<float>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
    for (float& value : image.rgb) value = radiance(engine);
    return image;
}

std::string fault_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no fault";
}

// ---- EXR ------------------------------------------------------------------------------------------

TEST_F(Exr, KeepsEveryBitAndPlacesTheCropWindowInTheFilm) {
    const Film film{.width = 40, .height = 30, .crop_x = 5, .crop_y = 7, .crop_width = 17, .crop_height = 11, .filter = {}};
    Image image = noise(17, 11);
    image.rgb[4] = infinity;
    image.rgb[7] = -0.0F;
    replace_file(path("a.exr"), encode_exr(image, film, {}, {}));

    const Imf::InputFile file(path("a.exr").c_str());
    EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({5, 7}, {21, 17}));
    EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {39, 29}));
    const Bitmap back = load_image(path("a.exr"), Transfer::of_format);
    ASSERT_EQ(back.rgb.size(), image.rgb.size());
    EXPECT_EQ(std::memcmp(back.rgb.data(), image.rgb.data(), image.rgb.size() * sizeof(float)), 0);
}

TEST_F(Exr, StatesHowThePictureWasMade) {
    Camera camera;
    camera.to_world = glm::translate(glm::mat4(1.0F), {1.0F, 2.0F, 3.0F});
    const Film film{.width = 4, .height = 2, .crop_width = 4, .crop_height = 2, .filter = {}};
    replace_file(path("a.exr"), encode_exr(noise(4, 2), film, camera, {"hall", 64, 500, 4000000000U, 1.25}));
    const Imf::InputFile file(path("a.exr").c_str());
    const auto text = [&](const char* name) { return file.header().typedAttribute<Imf::StringAttribute>(name).value(); };
    EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(file.header().channels().findChannel("G")->type, Imf::FLOAT);
    EXPECT_EQ(text("software"), "Wavelobe " WAVELOBE_VERSION);
    EXPECT_EQ(text("wavelobe.scene"), "hall");
    EXPECT_EQ(text("wavelobe.seed"), "4000000000");
    EXPECT_FALSE(Imf::hasOwner(file.header()));
    EXPECT_EQ(file.header().typedAttribute<Imf::IntAttribute>("wavelobe.spp").value(), 64);
    EXPECT_EQ(file.header().typedAttribute<Imf::DoubleAttribute>("wavelobe.samples").value(), 500.0);
    EXPECT_EQ(file.header().typedAttribute<Imf::DoubleAttribute>("wavelobe.seconds").value(), 1.25);
    // As the OpenEXR library says: row vectors, x to the right. The camera looks along +z with +x to the left.
    const Imath::V3f seen = Imath::V3f(2.0F, 4.0F, 6.0F) * Imf::worldToCamera(file.header());
    EXPECT_EQ(seen, Imath::V3f(-1.0F, 2.0F, 3.0F));
    // A point on the optical axis is the middle of the film.
    const Imath::V3f middle = Imath::V3f(1.0F, 2.0F, 8.0F) * Imf::worldToNDC(file.header());
    EXPECT_NEAR(middle.x, 0.5F, 1e-6F);
    EXPECT_NEAR(middle.y, 0.5F, 1e-6F);
}

TEST_F(Exr, WorldToNdcPutsTheCornersOfTheViewAtTheCornersOfTheFilm) {
    Camera camera;
    camera.fov_x_degrees = 60.0F;
    camera.principal_point_offset = {0.1F, -0.05F};
    camera.to_world = glm::rotate(glm::translate(glm::mat4(1.0F), {3.0F, -2.0F, 5.0F}), 0.7F,
                                  glm::normalize(glm::vec3(1.0F, 2.0F, 3.0F)));
    const Film film{.width = 400, .height = 200, .crop_x = 30, .crop_y = 10, .crop_width = 50, .crop_height = 60, .filter = {}};
    const double half_width = std::tan(std::numbers::pi / 6.0);
    const double half_height = half_width / 2.0;
    // In the camera's own space +x is to the left of the picture, +y up.
    const auto ndc = [&](double left, double up, double depth) {
        const glm::dvec4 world = glm::dmat4(camera.to_world) * glm::dvec4(left * depth, up * depth, depth, 1.0);
        const glm::dvec4 out = world_to_ndc(camera, film) * world;
        return glm::dvec3(out) / out.w;
    };
    const double rounding = 1e-6;  // of the float matrix
    for (const double depth : {0.5, 2.0, 30.0}) {
        EXPECT_NEAR(ndc(half_width, half_height, depth).x, 0.0 - 0.1, rounding);
        EXPECT_NEAR(ndc(half_width, half_height, depth).y, 0.0 + 0.05, rounding);
        EXPECT_NEAR(ndc(-half_width, -half_height, depth).x, 1.0 - 0.1, rounding);
        EXPECT_NEAR(ndc(-half_width, -half_height, depth).y, 1.0 + 0.05, rounding);
    }
}

// ---- PNG ------------------------------------------------------------------------------------------

TEST(Png, EncodesTheSrgbCurve) {
    EXPECT_EQ(srgb_byte(0.0F), 0);
    EXPECT_EQ(srgb_byte(-1.0F), 0);
    EXPECT_EQ(srgb_byte(nan), 0);
    EXPECT_EQ(srgb_byte(1.0F), 255);
    EXPECT_EQ(srgb_byte(infinity), 255);
    EXPECT_EQ(srgb_byte(0.5F), 188);
    EXPECT_EQ(srgb_byte(0.002F), 7);  // 255 * 12.92 * 0.002 = 6.6, on the straight part
    for (int byte = 0; byte < 256; ++byte) {
        const double encoded = byte / 255.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        EXPECT_EQ(srgb_byte(static_cast<float>(linear)), byte);
    }
}

TEST(Png, HoldsTheBytesRowByRow) {
    const Image image{2, 2, {0.0F, 0.5F, 1.0F, 1.0F, 0.0F, 0.5F, nan, -2.0F, 9.0F, 0.5F, 0.5F, 0.5F}};
    const std::string file = encode_png(image);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&header, file.data(), file.size()), 0);
    EXPECT_EQ(header.width, 2U);
    EXPECT_EQ(header.height, 2U);
    EXPECT_EQ(header.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
    std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(header));
    ASSERT_NE(png_image_finish_read(&header, nullptr, bytes.data(), 0, nullptr), 0);
    EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0, 188, 255, 255, 0, 188, 0, 0, 255, 188, 188, 188}));
}

// ---- comparison -----------------------------------------------------------------------------------

Image constant(int width, int height, float value) {
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {width, height, std::vector<float>(3 * pixels, value)};
}

TEST(Compare, EqualPicturesHaveNoError) {
    const Image image = noise(31, 17);
    const Comparison result = compare_images(image, image);
    EXPECT_EQ(result.rel_mse, 0.0);
    EXPECT_EQ(result.rel_mse_trimmed, 0.0);
    EXPECT_EQ(result.rmse, 0.0);
    EXPECT_EQ(result.mae, 0.0);
    EXPECT_EQ(result.max_difference, 0.0);
    EXPECT_EQ(result.mean, result.reference_mean);
}

TEST(Compare, ConstantPicturesHaveClosedForms) {
    const Comparison result = compare_images(constant(8, 4, 0.75F), constant(8, 4, 0.5F));
    const double rounding = 1e-15;
    EXPECT_NEAR(result.rel_mse, 0.0625 / 0.26, rounding);
    EXPECT_NEAR(result.rel_mse_trimmed, 0.0625 / 0.26, rounding);
    EXPECT_NEAR(result.rmse, 0.25, rounding);
    EXPECT_NEAR(result.mae, 0.25, rounding);
    EXPECT_EQ(result.max_difference, 0.25);
    EXPECT_NEAR(result.mean[1], 0.75, rounding);
    EXPECT_NEAR(result.reference_mean[2], 0.5, rounding);
}

TEST(Compare, SetsTheWorstThousandthApartAndSaysWhereItIs) {
    // 2000 pixels: the worst two are fireflies.
    const Image reference = constant(50, 40, 1.0F);
    Image image = constant(50, 40, 1.1F);
    image.rgb[3 * (7 * 50 + 12) + 1] = 1000.0F;
    image.rgb[3 * (9 * 50 + 3) + 0] = 500.0F;
    const Comparison result = compare_images(image, reference);
    EXPECT_NEAR(result.rel_mse_trimmed, 0.01 / 1.01, 1e-8);  // 1.1F is off by 2e-8
    EXPECT_GT(result.rel_mse, 100.0);
    EXPECT_EQ(result.max_difference, 999.0);
    EXPECT_EQ(result.max_x, 12);
    EXPECT_EQ(result.max_y, 7);
}

TEST(Compare, LeavesOutAndCountsPixelsThatAreNotFinite) {
    Image image = constant(4, 1, 0.75F);
    Image reference = constant(4, 1, 0.5F);
    image.rgb[0] = nan;
    reference.rgb[5] = infinity;
    const Comparison result = compare_images(image, reference);
    EXPECT_EQ(result.non_finite_pixels, 2U);
    EXPECT_NEAR(result.rmse, 0.25, 1e-15);
    EXPECT_NEAR(result.mean[0], 0.75, 1e-15);
}

TEST(Compare, RefusesOtherSizes) {
    EXPECT_NE(fault_of([] { compare_images(noise(4, 2), noise(2, 4)); }).find("4 x 2 and 2 x 4"), std::string::npos);
    EXPECT_NE(fault_of([] { difference_image(noise(4, 2), noise(4, 3)); }).find("differ in size"), std::string::npos);
}

TEST(Compare, DifferenceIsRedWhereBrighterAndBlueWhereDarker) {
    const Image reference{3, 1, {1.0F, 1.0F, 1.0F, 1.0F, 1.0F, 1.0F, 0.3F, 0.3F, 0.3F}};
    const Image image{3, 1, {1.5F, 1.5F, 1.5F, 0.5F, 0.5F, 0.5F, 0.3F, 0.3F, 0.3F}};
    const Image difference = difference_image(image, reference);
    const float half = static_cast<float>(0.5 / std::sqrt(1.01));
    const std::vector<float> expected{half, 0.0F, 0.0F, 0.0F, 0.0F, half, 0.0F, 0.0F, 0.0F};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_FLOAT_EQ(difference.rgb[i], expected[i]) << i;
}

// ---- output files -----------------------------------------------------------------------------------

TEST_F(ReplaceFile, WritesAndReplaces) {
    replace_file(path("a"), "first");
    replace_file(path("a"), std::string_view("sec\0ond", 7));
    EXPECT_EQ(read_file(path("a")), std::string("sec\0ond", 7));
    EXPECT_EQ(file_count(), 1U);
}

TEST_F(ReplaceFile, FollowsALink) {
    replace_file(path("a"), "first");
    fs::create_symlink("a", path("link"));
    replace_file(path("link"), "second");
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_EQ(read_file(path("a")), "second");
}

TEST_F(ReplaceFile, LeavesTheOldFileWholeWhenTheDiskIsFull) {
    replace_file(path("a"), "precious");
    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, old.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);  // the kernel now refuses to let a file grow, as a full disk does
    EXPECT_THROW(replace_file(path("a"), std::string(5000, 'x')), std::runtime_error);
    setrlimit(RLIMIT_FSIZE, &old);
    signal(SIGXFSZ, handler);
    EXPECT_EQ(read_file(path("a")), "precious");
    EXPECT_EQ(file_count(), 1U);
}

TEST_F(ReplaceFile, LeavesNothingBehindWhenTheTargetIsAFolder) {
    fs::create_directory(path("folder"));
    EXPECT_THROW(replace_file(path("folder"), "x"), std::runtime_error);
    EXPECT_EQ(file_count(), 1U);
}

TEST_F(ReplaceFile, RefusesInAdvanceWhatCannotBeWritten) {
    const auto fault = [](const std::string& at) { return fault_of([&] { refuse_unwritable(at); }); };
    EXPECT_EQ(fault(path("new.exr")), "no fault");
    EXPECT_EQ(fault(""), "the output file has no name");
    EXPECT_NE(fault(path("none/a.exr")).find("there is no folder " + path("none")), std::string::npos);
    EXPECT_NE(fault(folder_.string()).find("is a folder"), std::string::npos);
    EXPECT_NE(fault(folder_.string() + "/").find("is a folder"), std::string::npos);
    EXPECT_NE(fault("/dev/null").find("not a regular file"), std::string::npos);
    EXPECT_NE(fault("/proc/wavelobe.exr").find("cannot be written"), std::string::npos);
    EXPECT_EQ(file_count(), 0U);  // the trial file is gone
    replace_file(path("a"), "old");
    EXPECT_EQ(fault(path("a")), "no fault");
    EXPECT_EQ(read_file(path("a")), "old");
}

TEST_F(ReplaceFile, RefusesInAdvanceAReadOnlyFile) {
    if (geteuid() == 0) GTEST_SKIP() << "permissions do not bind root";
    replace_file(path("a"), "old");
    fs::permissions(path("a"), fs::perms::owner_read);
    const std::string fault = fault_of([&] { refuse_unwritable(path("a")); });
    EXPECT_NE(fault.find("cannot be written"), std::string::npos) << fault;
}

}  // namespace
}  // namespace wavelobe
