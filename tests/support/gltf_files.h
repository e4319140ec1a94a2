// Small glTF files made by tests: JSON, and one buffer with the data of its accessors.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/scene_files.h"
#include "scene/gltf_reader.h"

namespace wavelobe::test {

using Json = nlohmann::json;

#define EXPECT_FAULT(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

inline std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = (bits << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[(bits >> (18 - 6 * k)) & 63U];
    }
    return out;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    std::string out(values.size() * sizeof(T), '\0');
    std::memcpy(out.data(), values.data(), out.size());
    return out;
}

// An asset with one node a mesh; tests change `json` as they like.
class GltfFile {
public:
    GltfFile() {
        json["asset"]["version"] = "2.0";
        json["scene"] = 0;
        json["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
        json["nodes"] = Json::array({{{"mesh", 0}}});
    }

    // Adds an accessor of tightly packed values; returns its index.
    template <class T>
    int add(const std::vector<T>& values, const char* type, int component_type, int components) {
        const int view = add_view(bytes_of(values));
        json["accessors"].push_back({{"bufferView", view},
                                     {"componentType", component_type},
                                     {"count", values.size() / static_cast<std::size_t>(components)},
                                     {"type", type}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    int add_floats(const std::vector<float>& values, const char* type, int components) {
        return add(values, type, 5126, components);
    }

    int add_view(const std::string& bytes) {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
        buffer += bytes;
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }

    // The same with the bounds of each component.
    int add_bounded(const std::vector<float>& values, const char* type, int components) {
        const int accessor = add_floats(values, type, components);
        std::vector<float> low(values.begin(), values.begin() + components), high = low;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t k = i % static_cast<std::size_t>(components);
            low[k] = std::min(low[k], values[i]), high[k] = std::max(high[k], values[i]);
        }
        json["accessors"].back()["min"] = low, json["accessors"].back()["max"] = high;
        return accessor;
    }

    // A primitive of these positions; returns it for more attributes.
    Json& add_mesh(const std::vector<float>& positions) {
        const int accessor = add_bounded(positions, "VEC3", 3);
        json["meshes"].push_back({{"primitives", Json::array({{{"attributes", {{"POSITION", accessor}}}}})}});
        return json["meshes"].back()["primitives"][0];
    }

    std::string text() const {
        Json whole = json;
        if (!whole.contains("buffers") && !buffer.empty()) {
            whole["buffers"] = Json::array({{{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}});
        }
        return whole.dump();
    }

    std::string binary() const {
        Json whole = json;
        whole["buffers"] = Json::array({{{"byteLength", buffer.size()}}});
        std::string document = whole.dump();
        document.resize((document.size() + 3) / 4 * 4, ' ');
        std::string data = buffer;
        data.resize((data.size() + 3) / 4 * 4);
        const auto word = [](std::size_t value) { return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)}); };
        return "glTF" + word(2) + word(28 + document.size() + data.size()) + word(document.size()) + "JSON" + document +
               word(data.size()) + std::string("BIN\0", 4) + data;
    }

    Scene read(const GltfOptions& options = {}) const { return read_gltf_scene(folder.write("scene.gltf", text()), options); }

    std::vector<Fault> faults() const { return faults_of("scene.gltf", text()); }

    std::vector<Fault> faults_of(const std::string& name, const std::string& content) const {
        try {
            read_gltf_scene(folder.write(name, content));
        } catch (const InputError& error) {
            return error.faults();
        }
        return {};
    }

    Json json;
    std::string buffer;
    SceneFolder folder;
};

inline const std::vector<float>& unit_triangle() {
    static const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
    return positions;
}

inline const TriangleMesh& mesh_of(const Scene& scene, std::size_t shape = 0) {
    return std::get<TriangleMesh>(scene.shapes.at(shape).geometry);
}

}  // namespace wavelobe::test
