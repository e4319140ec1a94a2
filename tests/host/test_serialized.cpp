// Mitsuba's serialized meshes: versions, precisions, what they hold, and damage.
#include <gtest/gtest.h>

#include <zlib.h>

#include <cstring>

#include "host/scene_files.h"
#include "scene/mesh.h"

namespace wavelobe::test {
namespace {

template <typename T>
void append(std::string& out, T value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

struct Layout {
    int version = 4;
    bool normals = false, uvs = false, colors = false, doubles = false;
    float size = 1.0F;
    std::uint32_t last = 2;  // last index of the triangle
    std::uint64_t vertices = 3;
};

std::string payload(const Layout& layout) {
    std::string out;
    append<std::uint32_t>(out, (layout.normals ? 1U : 0U) | (layout.uvs ? 2U : 0U) | (layout.colors ? 8U : 0U) | (layout.doubles ? 0x2000U : 0x1000U));
    if (layout.version == 4) out += std::string("a name\0", 7);
    append<std::uint64_t>(out, layout.vertices);
    append<std::uint64_t>(out, 1);
    const auto numbers = [&](std::initializer_list<float> values) {
        for (const float v : values) layout.doubles ? append<double>(out, static_cast<double>(v)) : append<float>(out, v);
    };
    numbers({0, 0, 0, layout.size, 0, 0, 0, layout.size, 0});
    if (layout.normals) numbers({1, 0, 0, 0, 1, 0, 0, 0, 1});
    if (layout.uvs) numbers({0.25F, 0.5F, 1, 0, 0, 1});
    if (layout.colors) numbers({1, 0, 0, 0, 1, 0, 0, 0, 1});
    for (const std::uint32_t i : {0U, 1U, layout.last}) append(out, i);
    return out;
}

std::string file_of(const std::vector<Layout>& meshes) {
    std::string out;
    std::vector<std::size_t> offsets;
    const int version = meshes.front().version;
    for (const Layout& layout : meshes) {
        offsets.push_back(out.size());
        append<std::uint16_t>(out, 0x041C);
        append<std::uint16_t>(out, static_cast<std::uint16_t>(version));
        const std::string data = payload(layout);
        std::vector<Bytef> packed(compressBound(data.size()));
        uLongf size = packed.size();
        compress(packed.data(), &size, reinterpret_cast<const Bytef*>(data.data()), data.size());
        out.append(reinterpret_cast<const char*>(packed.data()), size);
    }
    for (const std::size_t offset : offsets) {
        if (version == 4) append<std::uint64_t>(out, offset);
        else append<std::uint32_t>(out, static_cast<std::uint32_t>(offset));
    }
    append<std::uint32_t>(out, static_cast<std::uint32_t>(offsets.size()));
    return out;
}

std::string fault_of(const std::string& path, std::uint32_t index) {
    try {
        load_serialized(path, index);
    } catch (const InputError& error) {
        EXPECT_EQ(error.faults().at(0).file, path);
        return error.faults()[0].message;
    }
    return "";
}

TEST(Serialized, WhatItHolds) {
    const SceneFolder folder;
    for (const bool doubles : {false, true}) {
        for (const int version : {3, 4}) {
            const Layout full{.version = version, .normals = true, .uvs = true, .colors = true, .doubles = doubles, .size = 2.0F};
            const std::string path = folder.write("a.serialized", file_of({full}));
            const MeshSource mesh = load_serialized(path, 0);
            EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}));
            EXPECT_EQ(mesh.normals, (std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
            EXPECT_EQ(mesh.uvs, (std::vector<glm::vec2>{{0.25F, 0.5F}, {1, 0}, {0, 1}}));
            EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
        }
    }
    const MeshSource bare = load_serialized(folder.write("b.serialized", file_of({Layout{}})), 0);
    EXPECT_TRUE(bare.normals.empty());
    EXPECT_TRUE(bare.uvs.empty());
}

TEST(Serialized, OneOfSeveral) {
    const SceneFolder folder;
    for (const int version : {3, 4}) {
        const auto sized = [&](float size) { return Layout{.version = version, .size = size}; };
        const std::string path = folder.write("a.serialized", file_of({sized(1), sized(2), sized(3)}));
        for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(load_serialized(path, i).positions[1].x, static_cast<float>(i + 1)) << version;
        EXPECT_NE(fault_of(path, 3).find("3 meshes"), std::string::npos);
    }
    const Scene scene = read_mitsuba_scene(folder.write("scene.xml", SceneFolder::wrap(
        R"(<shape type="serialized"><string name="filename" value="a.serialized"/><integer name="shape_index" value="1"/></shape>)")));
    EXPECT_EQ(std::get<TriangleMesh>(scene.shapes.at(0).geometry).positions[1].x, 2.0F);
}

TEST(Serialized, DamageIsRefused) {
    const SceneFolder folder;
    const std::string whole = file_of({Layout{.normals = true}});
    // Without its table the first mesh is still whole, and all of it is there before the stream's last block ends.
    constexpr std::size_t behind_data = 12 + 4 + 4;  // table, checksum, the end of the block
    for (std::size_t size = 0; size + behind_data < whole.size(); ++size)
        EXPECT_NE(fault_of(folder.write("cut.serialized", whole.substr(0, size)), 0), "") << size;
    const auto fault = [&](const Layout& layout) { return fault_of(folder.write("bad.serialized", file_of({layout})), 0); };
    EXPECT_NE(fault({.last = 3}).find("vertex"), std::string::npos);
    EXPECT_NE(fault({.vertices = 4000000000U}).find("too short"), std::string::npos);
    EXPECT_NE(fault({.vertices = 1ULL << 62}).find("too short"), std::string::npos);
    EXPECT_NE(fault({.version = 5}).find("version 5"), std::string::npos);
    std::string table = file_of({Layout{}, Layout{}});
    table.replace(table.size() - 12, 8, 8, '\xff');
    EXPECT_NE(fault_of(folder.write("table.serialized", table), 1), "");
}

}  // namespace
}  // namespace wavelobe::test
