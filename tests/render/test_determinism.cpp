// The same picture, bit for bit, however the work is divided.
//
// Threads are fixed when a process first touches OpenCL: each picture is rendered in a child process, and the parent
// never opens a device.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "host/scene_files.h"
#include "render/render.h"
#include "support/many_features.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

// More tiles than one thread has blocks for, none of them whole at the right and lower edge; more samples than a block
// makes at once.
constexpr int width = 67;
constexpr int height = 45;
constexpr int samples = 20;

struct Division {
    int threads = 2;
    int block_slots = 0;
    int lanes = 16;
    std::uint32_t seed = 7;
    Driver driver = Driver::one_kernel;
    int samples_per_pixel = samples;
};

void write_picture(const Scene& scene, const Division& division, const std::string& path) {
    const Device device({.threads = division.threads, .name = {}});
    RenderSettings settings;
    settings.samples_per_pixel = division.samples_per_pixel;
    settings.seed = division.seed;
    settings.block_slots = division.block_slots;
    settings.lanes = division.lanes;
    settings.driver = division.driver;
    Renderer renderer(device, scene, settings);
    if (!renderer.render() || renderer.stats().nan_samples != 0) throw std::runtime_error("not all samples are there");
    const Image image = renderer.image();
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(image.rgb.data()),
               static_cast<std::streamsize>(image.rgb.size() * sizeof(float)));
}

std::vector<float> picture(const Scene& scene, const Division& division) {
    const SceneFolder folder;
    const std::string path = folder.path("picture");
    const pid_t child = fork();
    if (child == 0) {
        int code = 0;
        try {
            write_picture(scene, division, path);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "%s\n", error.what());
            code = 1;
        }
        _exit(code);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<float> rgb(static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0)) / sizeof(float));
    file.seekg(0);
    file.read(reinterpret_cast<char*>(rgb.data()), static_cast<std::streamsize>(rgb.size() * sizeof(float)));
    return rgb;
}

const std::vector<float>& reference() {
    static const std::vector<float> rgb = picture(many_features_scene(width, height), {});
    return rgb;
}

std::size_t differing_pixels(const std::vector<float>& a, const std::vector<float>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
        if (!std::equal(a.begin() + static_cast<std::ptrdiff_t>(i), a.begin() + static_cast<std::ptrdiff_t>(i + 3),
                        b.begin() + static_cast<std::ptrdiff_t>(i))) {
            ++count;
        }
    }
    return count;
}

void expect_same(const Division& division) {
    Claim claim("Determinism", test_of_claim() + " against two threads, blocks of 512 paths, 16 lanes, one kernel: pixels that differ in any bit", "pixels");
    const std::vector<float> rgb = picture(many_features_scene(width, height), division);
    ASSERT_EQ(rgb.size(), std::size_t{3} * width * height);
    ASSERT_EQ(rgb.size(), reference().size());
    claim.observe(static_cast<double>(differing_pixels(rgb, reference())));
    claim.count(std::uint64_t{width} * height * samples);
    claim.at_most(0.0);
}

TEST(Determinism, PictureIsNotBlack) {
    double sum = 0.0;
    for (const float value : reference()) sum += static_cast<double>(value);
    EXPECT_GT(sum / static_cast<double>(reference().size()), 0.05);
}

TEST(Determinism, OneThread) { expect_same({.threads = 1}); }
TEST(Determinism, SevenThreads) { expect_same({.threads = 7}); }
TEST(Determinism, ALaunchAStage) { expect_same({.driver = Driver::staged}); }
// Both at once: every combination is a program of its own to compile.
TEST(Determinism, EightLanesAndSmallestBlocks) { expect_same({.block_slots = 16, .lanes = 8}); }
TEST(Determinism, OneLaneAndLargeBlocks) { expect_same({.block_slots = 1024, .lanes = 1}); }

// A window of one pixel and one sample: each stage runs for one path.
TEST(Determinism, WavesOfOnePath) {
    Scene scene = many_features_scene(width, height);
    const Division one_sample = {.samples_per_pixel = 1};
    const std::vector<float> whole = picture(scene, one_sample);
    ASSERT_EQ(whole.size(), std::size_t{3} * width * height);
    Claim claim("Determinism", "Waves of one path against the same paths of the whole picture: pixels that differ in any bit", "pixels");
    std::size_t differing = 0;
    const int pixels = quick_or_full(8, 64);
    scene.film.crop_width = 1;
    scene.film.crop_height = 1;
    for (int i = 0; i < pixels; ++i) {
        const int pixel = (2 * i + 1) * width * height / (2 * pixels);
        scene.film.crop_x = pixel % width;
        scene.film.crop_y = pixel / width;
        const std::vector<float> alone = picture(scene, one_sample);
        ASSERT_EQ(alone.size(), 3U);
        const auto first = whole.begin() + 3 * pixel;
        differing += differing_pixels(alone, {first, first + 3});
    }
    claim.observe(static_cast<double>(differing));
    claim.count(static_cast<std::uint64_t>(pixels));
    claim.at_most(0.0);
}

// A crop window is a part of the whole picture.
TEST(Determinism, CropWindow) {
    Scene scene = many_features_scene(width, height);
    constexpr int x = 11;
    constexpr int y = 7;
    scene.film.crop_x = x;
    scene.film.crop_y = y;
    scene.film.crop_width = 37;
    scene.film.crop_height = 21;
    const std::vector<float> crop = picture(scene, {});
    ASSERT_EQ(crop.size(), std::size_t{3} * 37 * 21);
    std::vector<float> part;
    for (int row = 0; row < scene.film.crop_height; ++row) {
        const auto first = reference().begin() + 3 * ((y + row) * width + x);
        part.insert(part.end(), first, first + 3 * scene.film.crop_width);
    }
    Claim claim("Determinism", "A crop window against that part of the whole picture: pixels that differ in any bit", "pixels");
    claim.observe(static_cast<double>(differing_pixels(crop, part)));
    claim.count(std::uint64_t{37} * 21 * samples);
    claim.at_most(0.0);
}

TEST(Determinism, AnotherSeedIsAnotherPicture) {
    const std::vector<float> rgb = picture(many_features_scene(width, height), {.seed = 8});
    ASSERT_EQ(rgb.size(), reference().size());
    // A pixel that nothing random reaches may be the same; most are not.
    EXPECT_GT(differing_pixels(rgb, reference()), std::size_t{width} * height / 2);
}

}  // namespace
}  // namespace wavelobe::test
