// A rich glTF file damaged at each of its values in turn: what comes of it is a list of faults, or a scene where the damage
// changes nothing that is shown.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "film/png.h"
#include "support/gltf_files.h"

namespace wavelobe::test {
namespace {

void add_geometry(GltfFile& file) {
    Json& primitive = file.add_mesh(unit_triangle());
    file.json["accessors"][0]["min"] = {0, 0, 0};
    file.json["accessors"][0]["max"] = {1, 1, 0};
    primitive["indices"] = file.add(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123, 1);
    primitive["mode"] = 4;
    primitive["material"] = 0;
    Json& attributes = primitive["attributes"];
    attributes["NORMAL"] = file.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    attributes["TEXCOORD_0"] = file.add_floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    attributes["COLOR_0"] = file.add(std::vector<std::uint8_t>(12, 200), "VEC4", 5121, 4);
    file.json["accessors"].back()["normalized"] = true;
    attributes["JOINTS_0"] = file.add(std::vector<std::uint8_t>(12, 0), "VEC4", 5121, 4);
    attributes["WEIGHTS_0"] = file.add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    const int delta = file.add_bounded({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3", 3);
    primitive["targets"] = Json::array({{{"POSITION", delta}}});
    file.json["meshes"][0]["weights"] = {0.5};
    const int index_view = file.add_view(bytes_of(std::vector<std::uint16_t>{1}));
    const int value_view = file.add_view(bytes_of(std::vector<float>{0, 0, 1.5F}));
    file.json["accessors"][static_cast<std::size_t>(delta)]["sparse"] = {{"count", 1},
                                                                         {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
                                                                         {"values", {{"bufferView", value_view}}}};
}

void add_material(GltfFile& file) {
    file.json["materials"] = Json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.2, 0.9], "metallicFactor": 0.5, "roughnessFactor": 0.5,
          "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 1], "rotation": 0.1, "scale": [1, 2]}}}},
        "emissiveFactor": [0.1, 0, 0], "alphaMode": "MASK", "alphaCutoff": 0.4, "doubleSided": true,
        "extensions": {"KHR_materials_ior": {"ior": 1.4}, "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 1, 1]}}}])");
    file.json["textures"] = Json::parse(R"([{"source": 0, "sampler": 0}])");
    file.json["samplers"] = Json::parse(R"([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9729}])");
    const int view = file.add_view(encode_png({1, 1, {0.5F, 0.5F, 0.5F}}));
    file.json["images"] = Json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
}

void add_scene(GltfFile& file) {
    const int matrix = file.add_floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4", 16);
    const int times = file.add_bounded({0, 1}, "SCALAR", 1);
    const int values = file.add_floats({0, 0, 0, 1, 0, 0}, "VEC3", 3);
    file.json["skins"] = Json::array({{{"joints", {1}}, {"inverseBindMatrices", matrix}, {"skeleton", 1}}});
    file.json["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0, "children": [1, 2]},
        {"translation": [0, 0, 1], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
        {"camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}}])");
    file.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1, "zfar": 100, "aspectRatio": 1.5}}])");
    file.json["extensions"] = Json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 1, 1], "intensity": 5, "range": 10,
        "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}})");
    file.json["animations"] = Json::array({{{"samplers", Json::array({{{"input", times}, {"output", values}, {"interpolation", "LINEAR"}}})},
                                            {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}})}}});
    file.json["buffers"] = Json::array({{{"byteLength", file.buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(file.buffer)}}});
}

class Damage : public testing::Test {
protected:
    Damage() {
        add_geometry(file);
        add_material(file);
        add_scene(file);
        const std::function<void(const Json&, const std::string&)> walk = [&](const Json& value, const std::string& path) {
            if (!path.empty()) places.push_back(path);
            for (const auto& [key, child] : value.items())
                if (value.is_structured()) walk(child, path + "/" + key);
        };
        walk(file.json, "");
    }

    // Faults of the file with another value at a place, of any kind but a crash.
    std::string after(const std::string& place, const Json& value) {
        Json damaged = file.json;
        damaged[Json::json_pointer(place)] = value;
        return texts(file.faults_of("scene.gltf", damaged.dump()));
    }

    GltfFile file;
    std::vector<std::string> places;
};

// What no reader needs may be of any kind.
bool is_read(const std::string& place) { return !place.ends_with("/mimeType"); }

TEST_F(Damage, TheWholeFileIsSound) { EXPECT_EQ(texts(file.faults()), ""); }

TEST_F(Damage, ValuesOfAnotherKindAreRefused) {
    ASSERT_GT(places.size(), 200U);
    for (const std::string& place : places) {
        const Json& now = file.json[Json::json_pointer(place)];
        for (const Json& other : {Json("text"), Json(true), Json::array({Json::object()}), Json::object(), Json()}) {
            if (!is_read(place) || other.type() == now.type()) continue;
            const std::string faults = after(place, other);
            EXPECT_NE(faults, "") << place << " = " << other;
            // The fault is found where the damage is, or where what is missing would be used.
            EXPECT_NE(faults.find("scene.gltf:1:"), std::string::npos) << place << ": " << faults;
        }
    }
}

TEST_F(Damage, ReferencesAndSizesOutOfRangeAreRefused) {
    const std::set<std::string> references{"mesh", "skin", "camera", "light", "material", "indices", "bufferView", "buffer", "source", "sampler", "index", "scene",
                                           "node", "input", "output", "skeleton", "inverseBindMatrices", "count", "byteLength", "componentType", "POSITION",
                                           "NORMAL", "TEXCOORD_0", "COLOR_0", "JOINTS_0", "WEIGHTS_0", "wrapS", "wrapT", "magFilter", "minFilter", "mode"};
    std::size_t tried = 0;
    for (const std::string& place : places) {
        if (!references.contains(place.substr(place.rfind('/') + 1)) || !file.json[Json::json_pointer(place)].is_number()) continue;
        for (const Json& other : {Json(-1), Json(1 << 20), Json(4294967295U), Json(0.5), Json(1e300), Json(std::int64_t{1} << 62)}) {
            EXPECT_NE(after(place, other), "") << place << " = " << other;
            ++tried;
        }
    }
    EXPECT_GT(tried, 200U);
}

// Any number anywhere, and any member left out: faults or a scene, and no other end.
TEST_F(Damage, NumbersAndAbsencesNeverCrash) {
    for (const std::string& place : places) {
        const Json::json_pointer pointer(place);
        if (file.json[pointer].is_number())
            for (const Json& other : {Json(0), Json(-1), Json(1), Json(2), Json(255), Json(1e-30), Json(1e38), Json(-1e38), Json(1e300)}) after(place, other);
        Json damaged = file.json;
        Json& parent = damaged[pointer.parent_pointer()];
        if (parent.is_object()) parent.erase(pointer.back());
        else parent.erase(static_cast<std::size_t>(std::stoul(pointer.back())));
        file.faults_of("scene.gltf", damaged.dump());
    }
}

// Bytes of the buffer: positions outside their bounds, indices beyond the vertices, joints that are not there.
TEST_F(Damage, NumbersInBuffers) {
    const auto with = [&](int accessor, std::size_t byte, const std::string& bytes) {
        const std::size_t view = file.json["accessors"][static_cast<std::size_t>(accessor)]["bufferView"];
        std::string buffer = file.buffer;
        buffer.replace(static_cast<std::size_t>(file.json["bufferViews"][view]["byteOffset"]) + byte, bytes.size(), bytes);
        return after("/buffers/0/uri", "data:application/octet-stream;base64," + base64(buffer));
    };
    const auto number = [](float value) { return bytes_of(std::vector<float>{value}); };
    const Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    EXPECT_NE(with(attributes["POSITION"], 12, number(1e6F)).find("outside its `min`"), std::string::npos);
    for (const char* name : {"POSITION", "NORMAL", "TEXCOORD_0", "WEIGHTS_0"}) {
        EXPECT_NE(with(attributes[name], 4, number(NAN)).find("is not finite"), std::string::npos) << name;
        EXPECT_NE(with(attributes[name], 4, number(INFINITY)), "") << name;
    }
    EXPECT_NE(with(file.json["meshes"][0]["primitives"][0]["indices"], 2, "\x09").find("the primitive has 3 vertices"), std::string::npos);
    EXPECT_NE(with(attributes["JOINTS_0"], 0, "\x05").find("follows joint 5; the skin has 1"), std::string::npos);
    EXPECT_NE(with(file.json["skins"][0]["inverseBindMatrices"], 12, number(3)).find("expected 0 0 0 1"), std::string::npos);
    EXPECT_NE(with(file.json["animations"][0]["samplers"][0]["input"], 4, number(0)).find("times that do not ascend"), std::string::npos);
}

}  // namespace
}  // namespace wavelobe::test
