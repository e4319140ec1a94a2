// A glTF file in memory: its JSON, the bytes of its buffers, and what of it the reader knows.
#pragma once

#include <memory>
#include <string>
#include <unordered_set>
#include <string_view>
#include <vector>

#include "scene/gltf/element.h"

namespace wavelobe::gltf {

struct BufferView {
    std::string_view bytes;
    std::size_t offset = 0;  // of its bytes in the buffer
    std::size_t stride = 0;  // 0: elements are tightly packed
    bool readable = false;   // false after a fault
};

class Document {
public:
    // Reads the file and everything it names but its images. Throws InputError when nothing of it can be understood; other
    // faults are in `faults`. `file` is a .gltf or .glb, told apart by content.
    explicit Document(const std::string& file);
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    std::string file;
    std::string folder;
    Faults faults;
    std::vector<std::string> warnings;

    Element root{nullptr, "", nullptr};
    std::vector<Element> accessors, materials, textures, images, samplers, meshes, nodes, skins, cameras, animations, scenes;
    std::vector<BufferView> views;

    // Adds a warning once.
    void warn(const std::string& text);
    // The file behind a relative URI, percent-encoding resolved; nothing, after a fault at `path`, for any other URI.
    std::optional<std::string> resolve(const std::string& uri, const std::string& path);
    // The bytes of a `data:` URI; nothing, after a fault at `path`, when they are not base64.
    std::optional<std::string> decode_data_uri(const std::string& uri, const std::string& path);

private:
    std::string_view split_container(const std::string& content);
    void parse_json(std::string_view text);
    void check_version();
    void check_extensions();
    void refuse_empty_lists();
    void read_buffers();
    std::string read_buffer(const Element& buffer, std::size_t index);
    void read_views();

    Json json_;
    std::string content_;
    bool is_binary_ = false;
    std::optional<std::string_view> binary_chunk_;
    std::vector<std::string> owned_;
    std::vector<std::string_view> buffers_;
    std::vector<bool> readable_;
    std::unordered_set<std::string> said_;  // warnings
    std::vector<std::size_t> empty_;  // buffers without bytes
};

// The media type that a data URI states.
std::string data_type(const std::string& uri);
inline bool is_data_uri(const std::string& uri) { return uri.starts_with("data:"); }

// For messages: the extensions of which something is read.
const std::vector<std::string>& supported_extensions();

}  // namespace wavelobe::gltf
