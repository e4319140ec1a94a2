// Damaged files of every format: cut short anywhere, or with a byte changed, each is read or refused, never worse.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "host/scene_files.h"
#include "scene/gltf_reader.h"
#include "scene/image.h"
#include "scene/mesh.h"

namespace wavelobe::test {
namespace {

struct Format {
    const char* folder;  // of tests/fuzz/corpus
    std::function<void(const std::string&)> read;
};

void PrintTo(const Format& format, std::ostream* out) { *out << format.folder; }

class Damaged : public testing::TestWithParam<Format> {};

std::string content_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_P(Damaged, IsReadOrRefused) {
    const SceneFolder folder;
    std::size_t files = 0, refused = 0;
    const std::filesystem::path corpus = std::filesystem::path(WAVELOBE_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().folder;
    const auto read = [&](const std::string& name, const std::string& content) {
        const std::string path = folder.write(name, content);
        try {
            GetParam().read(path);
        } catch (const InputError& error) {
            ASSERT_FALSE(error.faults().empty());
            ASSERT_FALSE(error.faults()[0].message.empty());
            ++refused;
        }
    };
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
        ++files;
        const std::string name = entry.path().filename().string(), whole = content_of(entry.path());
        const std::size_t step = std::max<std::size_t>(1, whole.size() / 50);
        for (std::size_t at = 0; at < whole.size(); at += step) {
            read(name, whole.substr(0, at));
            for (const char change : {'\x01', '\x80', '\xff'}) {
                std::string changed = whole;
                changed[at] = static_cast<char>(changed[at] ^ change);
                read(name, changed);
            }
        }
    }
    EXPECT_GT(files, 0U);
    EXPECT_GT(refused, files);
}

void read_image(const std::string& path) { load_image(path, Transfer::of_format); }

INSTANTIATE_TEST_SUITE_P(
    Formats, Damaged,
    testing::Values(Format{"ply", [](const std::string& path) { prepare_mesh(load_ply(path, false), {}); }},
                    Format{"obj", [](const std::string& path) { prepare_mesh(load_obj(path, true), {}); }},
                    Format{"serialized", [](const std::string& path) { prepare_mesh(load_serialized(path, 0), {}); }},
                    Format{"image", read_image}, Format{"exr", read_image},
                    Format{"mitsuba", [](const std::string& path) { read_mitsuba_scene(path); }},
                    Format{"gltf", [](const std::string& path) { read_gltf_scene(path); }}),
    [](const auto& format) { return format.param.folder; });

}  // namespace
}  // namespace wavelobe::test
