// glTF files that are not what the specification asks for, whether or not what is wrong is shown.
#include <gtest/gtest.h>

#include "film/png.h"
#include "support/gltf_files.h"

namespace wavelobe::test {
namespace {

// The faults of a sound file after one change: a triangle with coordinates, a material and a texture, bent by two joints.
template <class Change>
std::string after(Change change) {
    GltfFile file;
    Json& primitive = file.add_mesh(unit_triangle());
    primitive["material"] = 0;
    primitive["attributes"]["TEXCOORD_0"] = file.add_floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    primitive["attributes"]["JOINTS_0"] = file.add(std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", 5121, 4);
    primitive["attributes"]["WEIGHTS_0"] = file.add_floats({1, 0, 0, 0, 0.5F, 0.5F, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    file.json["materials"] = Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    file.json["textures"] = Json::array({{{"source", 0}}});
    file.json["images"] = Json::array({{{"uri", "data:image/png;base64," + base64(encode_png({1, 1, {1, 1, 1}}))}}});
    file.json["nodes"] = Json::array({{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, Json::object(), Json::object()});
    file.json["skins"] = Json::array({{{"joints", {1, 2}}, {"skeleton", 1}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    change(file);
    return texts(file.faults());
}

Json& attributes_of(GltfFile& f) { return f.json["meshes"][0]["primitives"][0]["attributes"]; }

TEST(GltfValidity, SoundFileHasNone) { EXPECT_EQ(after([](GltfFile&) {}), ""); }

TEST(GltfValidity, Extensions) {
    EXPECT_FAULT(after([](GltfFile& f) { f.json["extensionsUsed"] = {"VND_one", "VND_one"}; }), "`extensionsUsed` names VND_one twice");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["extensions"] = {{"VND_one", 42}}; }), "/extensions/VND_one: is 42; expected an object");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["nodes"][3]["extensions"] = Json::array(); }), "/nodes/3/extensions: is an array of 0; expected an object");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["materials"][0]["pbrMetallicRoughness"]["extensions"]["KHR_materials_clearcoat"] = Json::object(); }),
                 "/materials/0/pbrMetallicRoughness/extensions/KHR_materials_clearcoat: stands where the extension has no meaning");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["textures"][0]["extensions"]["KHR_texture_transform"] = Json::object(); }), "expected at ...Texture");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["extensions"]["KHR_lights_punctual"] = Json::object(); }), "has no `lights`");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array(); }), "lights: is an empty array");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 4; }), "source: is 4; the file has 1 images");
    // What stands where it may, and what no one knows, is read.
    EXPECT_EQ(after([](GltfFile& f) {
        f.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {{"scale", {2, 2}}};
        f.json["materials"][0]["extensions"]["VND_one"]["oddTexture"] = {{"index", 0}, {"texCoord", 7}};
        f.json["materials"][0]["extensions"]["VND_one"]["map"]["extensions"]["KHR_texture_transform"] = {{"scale", {2, 2}}};
        f.json["extras"] = {{"extensions", 3}};
    }), "");
}

TEST(GltfValidity, Attributes) {
    EXPECT_FAULT(after([](GltfFile& f) { attributes_of(f)["UNKNOWN"] = 1; }), "`UNKNOWN` is no attribute");
    EXPECT_FAULT(after([](GltfFile& f) { attributes_of(f)["TEXCOORD_01"] = 1; }), "`TEXCOORD_01` is no attribute");
    EXPECT_EQ(after([](GltfFile& f) { attributes_of(f)["_MINE"] = 1; }), "");
    EXPECT_FAULT(after([](GltfFile& f) { attributes_of(f)["_MINE"] = f.add(std::vector<std::uint32_t>{0, 1, 2}, "SCALAR", 5125, 1); }),
                 "_MINE is accessor 4 of component type 5125");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["accessors"][0].erase("min"); }), "POSITION is accessor 0 without `min` and `max`");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", f.add_floats(unit_triangle(), "VEC3", 3)}}}; }),
                 "targets/0: POSITION is accessor 4 without `min` and `max`");
    EXPECT_FAULT(after([](GltfFile& f) { attributes_of(f)["COLOR_0"] = f.add_floats({1, 1, 1, 1, 1.5F, 1, 1, 1, 1}, "VEC3", 3); }), "COLOR_0: vertex 1 has 1.5");
    EXPECT_FAULT(after([](GltfFile& f) { attributes_of(f)["COLOR_0"] = f.add_floats({1, 1, 1, 1, -0.5F, 1, 1, 1, 1}, "VEC3", 3); }), "COLOR_0: vertex 1 has -0.5");
    const auto handed = [](float w) {
        return after([&](GltfFile& f) { attributes_of(f)["TANGENT"] = f.add_floats({1, 0, 0, 1, 1, 0, 0, -1, 1, 0, 0, w}, "VEC4", 4); });
    };
    EXPECT_EQ(handed(1), "");
    EXPECT_FAULT(handed(0), "TANGENT: vertex 2 has a handedness of 0");
}

// Of meshes that no node shows, too.
TEST(GltfValidity, CoordinatesThatMaterialsLookUp) {
    const auto hidden = [](const std::string& set) {
        return after([&](GltfFile& f) {
            f.json["meshes"].push_back(f.json["meshes"][0]);
            f.json["meshes"][1]["primitives"][0]["attributes"].erase(set);
        });
    };
    EXPECT_FAULT(hidden("TEXCOORD_0"), "/meshes/1/primitives/0: its material looks up TEXCOORD_0, which it does not have");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["materials"][0]["occlusionTexture"] = {{"index", 0}, {"texCoord", 1}}; }), "looks up TEXCOORD_1");
    EXPECT_FAULT(after([](GltfFile& f) {
        f.json["materials"][0]["emissiveTexture"] = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 2}}}}}};
    }), "looks up TEXCOORD_2");
}

TEST(GltfValidity, Skins) {
    EXPECT_FAULT(after([](GltfFile& f) { f.json["skins"][0]["joints"] = {1, 3}; }), "/skins/0: joints 1 and 3 are below no common node");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["skins"][0]["skeleton"] = 3; }), "/skins/0: `skeleton` is node 3, and joint 1 is not below it");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["skins"][0]["skeleton"] = 2; }), "`skeleton` is node 2, and joint 1 is not below it");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["scenes"][0]["nodes"] = {0}; }), "/nodes/0: is shown by scene 0, and the joints of its skin are not");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["skins"][0] = {{"joints", {1}}}; }), "JOINTS_0: vertex 1 follows joint 1; the skin has 1");
    EXPECT_FAULT(after([](GltfFile& f) { attributes_of(f)["WEIGHTS_0"] = f.add_floats({1, 0, 0, 0, 1, 0.5F, 0, 0, 1, 0, 0, 0}, "VEC4", 4); }),
                 "the weights of vertex 1 sum to 1.5; expected 1");
    EXPECT_EQ(after([](GltfFile& f) { attributes_of(f)["WEIGHTS_0"] = f.add_floats({1, 0, 0, 0, 0.5F, 0.49F, 0, 0, 0, 0, 0, 0}, "VEC4", 4); }), "");
}

TEST(GltfValidity, Animations) {
    const auto animated = [](const char* path, const std::vector<float>& values, const char* type, int components, bool bounded) {
        return after([&](GltfFile& f) {
            const int times = bounded ? f.add_bounded({0, 1}, "SCALAR", 1) : f.add_floats({0, 1}, "SCALAR", 1);
            const int keys = f.add_floats(values, type, components);
            f.json["animations"] = Json::array({{{"samplers", Json::array({{{"input", times}, {"output", keys}}})},
                                                 {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 3}, {"path", path}}}}})}}});
        });
    };
    EXPECT_EQ(animated("translation", {0, 0, 0, 1, 0, 0}, "VEC3", 3, true), "");
    EXPECT_FAULT(animated("translation", {0, 0, 0, 1, 0, 0}, "VEC3", 3, false), "/animations/0/samplers/0: `input` is accessor 4 without `min` and `max`");
    EXPECT_EQ(animated("rotation", {0, 0, 0, 1, 1, 0, 0, 0}, "VEC4", 4, true), "");
    EXPECT_FAULT(animated("rotation", {0, 0, 0, 1, 0.5F, 0, 0, 0}, "VEC4", 4, true), "key 1 is a `rotation` of length 0.5");
}

// Vertices alone may be apart from each other.
TEST(GltfValidity, StridesAndMatrices) {
    const auto stride_of = [](GltfFile& f, int accessor) {
        f.json["bufferViews"][f.json["accessors"][static_cast<std::size_t>(accessor)]["bufferView"].get<std::size_t>()]["byteStride"] = 4;
    };
    EXPECT_FAULT(after([&](GltfFile& f) {
        const int order = f.add(std::vector<std::uint32_t>{0, 1, 2}, "SCALAR", 5125, 1);
        f.json["meshes"][0]["primitives"][0]["indices"] = order;
        stride_of(f, order);
    }), "`indices` is accessor 4 in buffer view 4, which has a `byteStride`");
    const std::vector<float> matrices{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto bound = [&](int stride) {
        return after([&](GltfFile& f) {
            f.json["skins"][0]["inverseBindMatrices"] = f.add_floats(matrices, "MAT4", 16);
            if (stride > 0) f.json["bufferViews"].back()["byteStride"] = stride;
        });
    };
    EXPECT_EQ(bound(0), "");
    EXPECT_FAULT(bound(64), "/skins/0: `inverseBindMatrices` is accessor 4 in buffer view 4");
    EXPECT_FAULT(after([&](GltfFile& f) {
        f.add(std::vector<std::uint8_t>(20, 1), "MAT2", 5121, 10);
        f.json["accessors"].back().update({{"byteOffset", 1}, {"count", 1}});
    }), "/accessors/4: starts at byte 1 of its buffer view; expected a multiple of 4");
}

TEST(GltfValidity, AddressesOfData) {
    const auto buffer = [](const std::string& start) {
        return after([&](GltfFile& f) { f.json["buffers"] = Json::array({{{"byteLength", f.buffer.size()}, {"uri", start + base64(f.buffer)}}}); });
    };
    EXPECT_EQ(buffer("data:application/gltf-buffer;base64,"), "");
    EXPECT_EQ(buffer("data:application/octet-stream;charset=none;base64,"), "");
    EXPECT_FAULT(buffer("data:application/octet-stream;;base64,"), "is no data URI");
    EXPECT_FAULT(buffer("data:image/png;base64,"), "a data URI of type `image/png`");
    EXPECT_FAULT(after([](GltfFile& f) { f.json["bufferViews"][0].update({{"byteStride", 12}, {"target", 34963}}); }), "a `byteStride` of 12 in a view of indices");
    const GltfFile file;
    EXPECT_FAULT(texts(file.faults_of("scene.gltf", "\xef\xbb\xbf" + file.text())), "starts with a byte order mark");
}

// Images that no texture names are looked at as well.
TEST(GltfValidity, Images) {
    const std::string png = encode_png({1, 1, {1, 1, 1}});
    const auto image = [&](const std::string& type, const std::string& bytes, const Json& more = Json::object()) {
        return after([&](GltfFile& f) {
            f.json["images"].push_back({{"uri", "data:" + type + ";base64," + bytes}});
            f.json["images"].back().update(more);
        });
    };
    EXPECT_EQ(image("image/png", base64(png)), "");
    EXPECT_FAULT(image("image/gif", base64(png)), "/images/1: is stated to be image/gif, and its bytes are image/png");
    EXPECT_FAULT(image("image/png", base64(png), {{"mimeType", "image/jpeg"}}), "is stated to be image/jpeg");
    EXPECT_FAULT(image("image/png", base64(png.substr(0, png.size() / 2))), "used at");
    EXPECT_FAULT(image("image/png", "`"), "is not base64");
    EXPECT_FAULT(after([&](GltfFile& f) { f.json["images"].push_back({{"bufferView", f.add_view(png)}}); }), "/images/1: has no `mimeType`");
    const std::string webp = base64(std::string("RIFF\x04\0\0\0WEBP", 12));
    EXPECT_FAULT(image("image/webp", webp), "/images/1: is WebP, which `extensionsUsed` does not allow");
}

}  // namespace
}  // namespace wavelobe::test
