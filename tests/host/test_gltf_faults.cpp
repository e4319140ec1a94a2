// Damaged glTF files: each ends in faults that name the place.
#include <gtest/gtest.h>

#include "support/gltf_files.h"

namespace wavelobe::test {
namespace {

// The faults of a sound file after one change.
template <class Change>
std::string after(Change change) {
    GltfFile file;
    Json& primitive = file.add_mesh(unit_triangle());
    primitive["indices"] = file.add(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123, 1);
    change(file);
    return texts(file.faults());
}

TEST(GltfFaults, SoundFileHasNone) { EXPECT_EQ(after([](GltfFile&) {}), ""); }

TEST(GltfFaults, References) {
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["mesh"] = 7; }), "/nodes/0/mesh: is 7; the file has 1 meshes");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["mesh"] = -1; }), "/nodes/0/mesh: is -1");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["mesh"] = "0"; }), "/nodes/0/mesh: is the text");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["scene"] = 3; }), "/scene: is 3");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["scenes"][0]["nodes"] = {0, 9}; }), "/scenes/0/nodes/1: is 9");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["material"] = 0; }),
                 "/meshes/0/primitives/0/material: is 0; the file has 0 materials");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99; }),
                 "/meshes/0/primitives/0/attributes/POSITION: is 99");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["bufferView"] = 1e30; }), "/accessors/0/bufferView");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["bufferViews"][0]["buffer"] = 5; }), "/bufferViews/0/buffer: is 5");
}

TEST(GltfFaults, Ranges) {
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["count"] = 4; }), "/accessors/0: 4 elements of 12 bytes");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["count"] = 4294967295U; }), "/accessors/0: 4294967295 elements");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["count"] = 0; }), "/accessors/0/count: is 0");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["byteOffset"] = 36; }), "/accessors/0: 3 elements");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["byteOffset"] = -4; }), "/accessors/0/byteOffset: is -4");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0].erase("bufferView"), f.json["accessors"][0]["count"] = 1 << 30; }),
                 "/accessors/0: 1073741824 elements without a buffer view");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["bufferViews"][0]["byteLength"] = 1 << 20; }), "/bufferViews/0: bytes 0 to 1048576");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["bufferViews"][0]["byteOffset"] = std::int64_t{1} << 49; }), "/bufferViews/0: bytes");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["bufferViews"][0]["byteStride"] = 300; }), "/bufferViews/0/byteStride: is 300");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["bufferViews"][0]["byteStride"] = 4; }), "whose stride is 4");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["componentType"] = 5124; }), "/accessors/0: component type 5124");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["type"] = "VEC9"; }), "/accessors/0: type `VEC9`");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0].update({{"type", "VEC2"}, {"min", {0, 0}}, {"max", {1, 1}}}); }), "POSITION is accessor 0 of type VEC2; expected VEC3");
}

TEST(GltfFaults, ListsWithoutItems) {
    for (const char* name : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes", "nodes", "samplers", "scenes",
                             "skins", "textures"})
        EXPECT_FAULT(after([&](GltfFile& f) { f.json[name] = Json::array(); }), std::string("/") + name + ": is an empty array");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["children"] = Json::array(); }), "/nodes/0/children: is an empty array");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["scenes"][0]["nodes"] = Json::array(); }), "/scenes/0/nodes: is an empty array");
}

TEST(GltfFaults, RulesBetweenParts) {
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}}, f.json["scenes"][0]["nodes"] = {1}; }),
                 "/scenes/0: shows node 1, a child of node 0");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["skins"] = Json::array({{{"joints", {0}}}}), f.json["nodes"][0]["skin"] = 0; }), "no JOINTS_0");
    EXPECT_FAULT(after([](GltfFile& f) {
        f.json["meshes"][0]["primitives"][0]["targets"] = Json::array({{{"NORMAL", f.add_floats(unit_triangle(), "VEC3", 3)}}});
    }), "moves NORMAL, which the primitive does not have");
    EXPECT_FAULT(after([](GltfFile& f) {
        Json& list = f.json["meshes"][0]["primitives"];
        list.push_back(list[0]);
        list[1]["targets"] = Json::array({{{"POSITION", 0}}});
        list.push_back(list[0]);
    }), "/meshes/0/primitives/2: has 0 morph targets");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0]["normalized"] = true; }), "`normalized` numbers of component type 5126");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["bufferViews"][0]["byteStride"] = 40; }), "a `byteStride` of 40 in 36 bytes");
    for (const char* size : {"xmag", "ymag"})
        EXPECT_FAULT(after([&](GltfFile& f) {
            f.json["cameras"] = Json::array({{{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}});
            f.json["cameras"][0]["orthographic"][size] = 0;
        }), "shows a picture of no size");
}

// Damage is found in what no node shows, too.
TEST(GltfFaults, WhatNothingUses) {
    EXPECT_FAULT(after([](GltfFile& f) { f.add_floats({0, NAN, 0}, "VEC3", 3); }), "/accessors/2: element 0 is not finite");
    EXPECT_FAULT(after([](GltfFile& f) {
        f.json["accessors"][1]["min"] = {0};
        f.json["accessors"][1]["max"] = {1};
    }), "/accessors/1: element 2 has 2, outside its `min` 0 and `max` 1");
    EXPECT_FAULT(after([](GltfFile& f) {
        f.json["images"] = Json::array({{{"uri", "data:image/png;base64,iVBORw0KGgo="}}});
        f.json["textures"] = Json::array({{{"source", 0}}});
    }), "/images/0");
    GltfFile file;
    file.json["buffers"] = Json::array({{{"byteLength", 4}}});
    const std::string document = file.json.dump();
    const auto word = [](std::size_t value) { return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)}); };
    const std::string json = document + std::string((4 - document.size() % 4) % 4, ' ');
    EXPECT_FAULT(texts(file.faults_of("scene.glb", "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json)), "no binary chunk");
}

// Some seconds by the square of their number, and far less by it.
TEST(GltfFaults, MayBeMany) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    constexpr int count = 50'000;
    for (int i = 0; i + 1 < count; ++i) file.json["nodes"][static_cast<std::size_t>(i)] = {{"children", {i + 1}}};
    file.json["nodes"][count - 1] = {{"mesh", 0}, {"translation", {1, 0, 0}}};
    EXPECT_EQ(mesh_of(file.read()).positions.at(0).x, 1.0F);
    for (Json& node : file.json["nodes"]) node["mesh"] = 5;
    EXPECT_EQ(file.faults().size(), 101U);
}

TEST(GltfFaults, Contents) {
    EXPECT_FAULT(after([](GltfFile& f) { f.buffer[36] = 9; }), "index 0 of accessor 1 is 9; the primitive has 3 vertices");
    EXPECT_FAULT(after([](GltfFile& f) { f.buffer.replace(0, 4, bytes_of(std::vector<float>{NAN})); }), "/accessors/0: element 0 is not finite");
    EXPECT_FAULT(after([](GltfFile& f) {
        f.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = f.add_floats({0, 0, 1}, "VEC3", 3);
    }), "NORMAL has 1 elements, and POSITION 3");
    EXPECT_FAULT(after([](GltfFile& f) {
        const int view = f.add_view(bytes_of(std::vector<std::uint16_t>{2, 1}));
        f.json["accessors"][0]["sparse"] = {{"count", 2}, {"indices", {{"bufferView", view}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
    }), "/accessors/0/sparse/indices: index 1 is 1; expected ascending ones");
}

TEST(GltfFaults, Nodes) {
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["children"] = {0}; }), "/nodes/0: is among its own ancestors");
    EXPECT_FAULT(after([](GltfFile& f) {
        f.json["nodes"] = Json::array({{{"mesh", 0}, {"children", {2}}}, {{"children", {2}}}, Json::object()});
    }), "/nodes/1: node 2 is already a child of node 0");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["scale"] = {1, 1}; }), "/nodes/0/scale: has 2 numbers; expected 3");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["scale"] = {1, 1, 1e39}; }), "/nodes/0/scale/2: is 1e+39");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][0]["rotation"] = {0, 0, 0, 0}; }), "/nodes/0: a `rotation` of length 0");
}

TEST(GltfFaults, LongChainsOfNodesAreRead) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    file.json["nodes"] = Json::array();
    for (int i = 0; i < 100000; ++i) file.json["nodes"].push_back({{"children", {i + 1}}});
    file.json["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(file.read().shapes.size(), 1U);
}

TEST(GltfFaults, Buffers) {
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", 48}, {"uri", "absent.bin"}}}); }), "absent.bin");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", 48}}}); }), "/bufferViews/0: asks for buffer 0, which has no `uri`");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", 48}, {"uri", "data:application/gltf-buffer;base64,AAA*"}}}); }),
                 "/buffers/0/uri: character 39 of the data URI is not base64");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", 48}, {"uri", "data:application/octet-stream;base64,AAAA"}}}); }),
                 "/buffers/0: claims 48 bytes and has 3");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", 48}, {"uri", "https://example.com/a.bin"}}}); }),
                 "nothing is fetched");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", 48}, {"uri", "/etc/passwd"}}}); }), "expected a relative path");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", 48}, {"uri", ""}}}); }), "/buffers/0/uri");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["buffers"] = 3; }), "/buffers: is 3; expected an array");
}

TEST(GltfFaults, Documents) {
    const GltfFile file;
    const auto faults = [&](const std::string& content) { return texts(file.faults_of("scene.gltf", content)); };
    EXPECT_FAULT(faults(""), "not valid JSON");
    EXPECT_FAULT(faults("{\"asset\":\n {\"version\" \"2.0\"}}"), "scene.gltf:2:17: not valid JSON");
    EXPECT_FAULT(faults("[]"), "is an array of 0");
    EXPECT_FAULT(faults("{}"), "has no `asset`");
    EXPECT_FAULT(faults(R"({"asset": {"version": "1.0"}})"), "glTF version 1.0");
    EXPECT_FAULT(faults(R"({"asset": {"version": "2.0", "minVersion": "2.1"}})"), "asks for glTF 2.1");
    EXPECT_FAULT(faults("{\"asset\": " + std::string(1000000, '[')), "nested deeper");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["extensionsRequired"] = {"VND_one", "VND_two"}; }), "VND_one is required, and not supported");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["extensionsRequired"] = {"VND_one", "VND_two"}; }), "VND_two");
    const std::string both = after([](GltfFile& f) { f.json["nodes"][0]["mesh"] = 7, f.json["scene"] = 3; });
    EXPECT_FAULT(both, "/nodes/0/mesh");
    EXPECT_FAULT(both, "/scene");
}

// Cut anywhere, a binary file is refused.
TEST(GltfFaults, TruncatedBinaryFiles) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    const std::string whole = file.binary();
    ASSERT_TRUE(file.faults_of("scene.glb", whole).empty());
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(file.faults_of("scene.glb", whole.substr(0, length)).empty()) << length;
}

// Any byte may be wrong: what comes of it is a scene or a list of faults.
TEST(GltfFaults, DamagedBytesNeverCrash) {
    GltfFile file;
    file.add_mesh(unit_triangle())["indices"] = file.add(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123, 1);
    const std::string whole = file.binary();
    std::size_t refused = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const char value : {'\0', '\xff', '9', '"'}) {
            std::string damaged = whole;
            damaged[i] = value;
            refused += file.faults_of("scene.glb", damaged).empty() ? 0 : 1;
        }
    }
    EXPECT_GT(refused, whole.size());
}

}  // namespace
}  // namespace wavelobe::test
