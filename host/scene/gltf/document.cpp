#include "scene/gltf/document.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/file.h"
#include "scene/gltf/json_place.h"

namespace wavelobe::gltf {

namespace {

constexpr int deepest_nesting = 200;
constexpr std::uint32_t magic_glb = 0x46546C67;   // glTF
constexpr std::uint32_t chunk_json = 0x4E4F534A;  // JSON
constexpr std::uint32_t chunk_binary = 0x004E4942;

std::uint32_t word_at(const std::string& content, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, content.data() + offset, sizeof word);
    return word;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percent_decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escape = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
        if (!escape) {
            out += uri[i];
            continue;
        }
        out += static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2]));
        i += 2;
    }
    return out;
}

// A type, parameters with values, and `base64` last, any of which may be absent (RFC 2397).
bool is_media_type(std::string_view text) {
    std::size_t at = text.find(';');
    while (at != std::string_view::npos) {
        const std::size_t next = text.find(';', at + 1);
        const std::string_view parameter = text.substr(at + 1, next == std::string_view::npos ? next : next - at - 1);
        const bool last = next == std::string_view::npos;
        if (parameter.find('=') == std::string_view::npos && !(last && parameter == "base64")) return false;
        at = next;
    }
    return true;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

}  // namespace

const std::vector<std::string>& supported_extensions() {
    static const std::vector<std::string> names{"EXT_mesh_gpu_instancing",   "KHR_draco_mesh_compression", "KHR_lights_punctual",        "KHR_materials_anisotropy", "KHR_materials_clearcoat",
                                                "KHR_materials_emissive_strength", "KHR_materials_ior",    "KHR_materials_sheen",        "KHR_materials_specular",
                                                "KHR_materials_transmission",    "KHR_materials_unlit",    "KHR_materials_volume",
                                                "KHR_mesh_quantization",         "KHR_texture_transform"};
    return names;
}

Document::Document(const std::string& path)
    : file(path), folder(std::filesystem::path(path).parent_path().string()), faults(path), content_(read_file(path)) {
    const std::string_view text = split_container(content_);
    parse_json(text);
    if (text.size() == content_.size()) faults.set_text(text);
    root = Element(&json_, "", &faults);
    check_version();
    check_extensions();
    accessors = root.objects("accessors");
    materials = root.objects("materials");
    textures = root.objects("textures");
    images = root.objects("images");
    samplers = root.objects("samplers");
    meshes = root.objects("meshes");
    nodes = root.objects("nodes");
    skins = root.objects("skins");
    cameras = root.objects("cameras");
    animations = root.objects("animations");
    scenes = root.objects("scenes");
    refuse_empty_lists();
    read_buffers();
    read_views();
}

void Document::warn(const std::string& text) {
    if (said_.insert(text).second) warnings.push_back(text);
}

// The JSON of a .gltf or .glb; remembers the binary chunk.
std::string_view Document::split_container(const std::string& content) {
    const auto refuse = [&](std::size_t offset, const std::string& message) {
        throw InputError(Fault{file, 0, 0, fmt::format("byte {}", offset), message, "the file may be cut short: fetch it again"});
    };
    if (content.size() < 4 || word_at(content, 0) != magic_glb) return content;
    is_binary_ = true;
    if (content.size() < 20) refuse(0, fmt::format("a binary glTF of {} bytes; its header alone takes 20", content.size()));
    const std::uint32_t version = word_at(content, 4);
    const std::size_t length = word_at(content, 8);
    if (version != 2) refuse(4, fmt::format("binary glTF of version {}; expected 2", version));
    if (length > content.size())
        refuse(8, fmt::format("the file claims {} bytes and has {}", length, content.size()));
    if (length < content.size()) warn(fmt::format("{}: {} bytes after the end of the binary glTF are passed over", file, content.size() - length));

    std::string_view text;
    std::size_t offset = 12;
    for (int chunk = 0; offset + 8 <= length; ++chunk) {
        const std::size_t size = word_at(content, offset);
        const std::uint32_t type = word_at(content, offset + 4);
        if (size > length - offset - 8)
            refuse(offset, fmt::format("a chunk of {} bytes where {} are left", size, length - offset - 8));
        const std::string_view bytes(content.data() + offset + 8, size);
        if (size % 4 != 0) refuse(offset, fmt::format("a chunk of {} bytes; expected a multiple of 4", size));
        if (chunk > 0 && (type == chunk_json || (chunk > 1 && type == chunk_binary)))
            refuse(offset + 4, fmt::format("a second {} chunk", type == chunk_json ? "JSON" : "binary"));
        if (chunk == 0) {
            if (type != chunk_json) refuse(offset + 4, fmt::format("the first chunk is of type 0x{:08x}; expected JSON", type));
            text = bytes;
        } else if (chunk == 1 && type == chunk_binary) {
            binary_chunk_ = bytes;
        }
        offset += 8 + size;
    }
    if (offset != length) refuse(offset, fmt::format("{} bytes where a chunk's header takes 8", length - offset));
    if (text.empty()) refuse(12, "no JSON chunk");
    return text;
}

void Document::parse_json(std::string_view text) {
    // Looked at before: a parser that asks at each level takes time by the square of a list's length.
    if (nests_deeper(text, deepest_nesting))
        throw InputError(Fault{file, 0, 0, "", fmt::format("JSON nested deeper than {} levels", deepest_nesting), "no glTF needs that"});
    try {
        json_ = Json::parse(text);
    } catch (const Json::parse_error& error) {
        const auto [line, column] = place_in_text(text, error.byte > 0 ? error.byte - 1 : 0);
        std::string what = error.what();
        const std::size_t start = what.find("syntax error");
        if (start != std::string::npos) what = what.substr(start);
        throw InputError(Fault{file, line, column, "", "not valid JSON: " + what, "expected a glTF 2.0 document"});
    } catch (const Json::exception& error) {
        throw InputError(Fault{file, 0, 0, "", std::string("not valid JSON: ") + error.what(), "expected a glTF 2.0 document"});
    }
    if (text.starts_with("\xef\xbb\xbf"))
        throw InputError(Fault{file, 0, 0, "", "starts with a byte order mark; glTF is UTF-8 without one", "save it again without"});
    if (!json_.is_object())
        throw InputError(Fault{file, 1, 1, "", "is " + describe(json_) + "; expected the object of a glTF 2.0 document", ""});
}

void Document::check_version() {
    const Element asset = root.object("asset");
    if (!asset.present()) {
        root.fault("has no `asset`, which states the glTF version", "expected \"asset\": {\"version\": \"2.0\"}");
        return;
    }
    asset.require("version");
    const std::string version = asset.text("version", "2.0");
    const std::string least = asset.text("minVersion", "2.0");
    if (!version.starts_with("2.")) asset.fault("glTF version " + version + "; expected 2.0", "export it as glTF 2.0");
    else if (least != "2.0") asset.fault("asks for glTF " + least + "; this reader knows 2.0", "export it as glTF 2.0");
}

// The schema allows no list without items: what would be in it may have been lost.
void Document::refuse_empty_lists() {
    for (const char* name : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes", "nodes", "samplers",
                             "scenes", "skins", "textures"})
        root.refuse_empty(name);
    for (const Element& node : nodes) node.refuse_empty("children"), node.refuse_empty("weights");
    for (const Element& scene : scenes) scene.refuse_empty("nodes");
    for (const Element& mesh : meshes) mesh.refuse_empty("primitives"), mesh.refuse_empty("weights");
    for (const Element& skin : skins) skin.refuse_empty("joints");
    for (const Element& animation : animations) animation.refuse_empty("channels"), animation.refuse_empty("samplers");
}

void Document::check_extensions() {
    const auto& known = supported_extensions();
    const auto is_known = [&](const std::string& name) { return std::find(known.begin(), known.end(), name) != known.end(); };
    for (const std::string& name : root.texts("extensionsRequired")) {
        if (is_known(name)) continue;
        faults.add("/extensionsRequired", "the extension " + name + " is required, and not supported",
                   fmt::format("export without it; supported are {}", fmt::join(known, ", ")));
    }
    std::vector<std::string> ignored;
    for (const std::string& name : root.texts("extensionsUsed"))
        if (!is_known(name)) ignored.push_back(name);
    if (!ignored.empty()) warn(fmt::format("{}: extensions passed over: {}", file, fmt::join(ignored, ", ")));
}

std::optional<std::string> Document::resolve(const std::string& uri, const std::string& path) {
    const std::string name = percent_decoded(uri);
    const std::size_t colon = name.find(':');
    const bool scheme = colon != std::string::npos && colon > 1 && name.find('/') > colon;
    if (scheme || name.starts_with("//")) {
        faults.add(path, "names `" + uri.substr(0, 200) + "`; nothing is fetched", "store the file beside the scene and name it by a relative path");
        return {};
    }
    if (name.empty() || name.find('\0') != std::string::npos || std::filesystem::path(name).is_absolute()) {
        faults.add(path, "names `" + uri.substr(0, 200) + "`; expected a relative path", "store the file beside the scene");
        return {};
    }
    return (std::filesystem::path(folder) / name).string();
}

std::string data_type(const std::string& uri) { return uri.substr(5, uri.find_first_of(";,") - 5); }

std::optional<std::string> Document::decode_data_uri(const std::string& uri, const std::string& path) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) {
        faults.add(path, "a data URI without a comma before its data", "");
        return {};
    }
    if (!is_media_type(std::string_view(uri).substr(5, comma - 5))) {
        faults.add(path, fmt::format("`{:.200}` is no data URI", uri.substr(0, comma)), "expected data:TYPE;base64,DATA");
        return {};
    }
    if (uri.substr(0, comma).find(";base64") == std::string::npos) return percent_decoded(uri.substr(comma + 1));
    std::string out;
    out.reserve((uri.size() - comma) / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    std::size_t end = uri.size();
    while (end > comma + 1 && uri[end - 1] == '=') --end;
    for (std::size_t i = comma + 1; i < end; ++i) {
        const int digit = base64_digit(uri[i]);
        if (digit < 0) {
            faults.add(path, fmt::format("character {} of the data URI is not base64", i), "");
            return {};
        }
        bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        if (++count % 4 == 0) out.append({static_cast<char>(bits >> 16), static_cast<char>(bits >> 8), static_cast<char>(bits)});
    }
    if (count % 4 == 1) {
        faults.add(path, "the base64 of the data URI ends inside a byte", "the file may be cut short");
        return {};
    }
    if (count % 4 == 2) out += static_cast<char>(bits >> 4);
    if (count % 4 == 3) out.append({static_cast<char>(bits >> 10), static_cast<char>(bits >> 2)});
    return out;
}

std::string Document::read_buffer(const Element& buffer, std::size_t index) {
    const std::string uri = buffer.text("uri");
    const std::string path = buffer.path() + "/uri";
    if (is_data_uri(uri)) {
        const std::string type = data_type(uri);
        const auto bytes = decode_data_uri(uri, path);
        if (bytes && type != "application/octet-stream" && type != "application/gltf-buffer")
            faults.add(path, "a data URI of type `" + type.substr(0, 100) + "`", "expected application/octet-stream or application/gltf-buffer");
        return bytes.value_or("");
    }
    const auto name = resolve(uri, path);
    if (!name) return {};
    try {
        return read_file(*name);
    } catch (const InputError& error) {
        faults.add(error, fmt::format("/buffers/{}", index));
        return {};
    }
}

void Document::read_buffers() {
    const std::vector<Element> list = root.objects("buffers");
    owned_.reserve(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Element& buffer = list[i];
        buffer.require("byteLength");
        const std::size_t before = faults.size();
        const auto length = static_cast<std::size_t>(buffer.whole("byteLength", 0, 1, std::int64_t{1} << 50));
        std::string_view bytes;
        if (buffer.has("uri")) {
            bytes = owned_.emplace_back(read_buffer(buffer, i));
        } else if (i == 0 && binary_chunk_) {
            bytes = *binary_chunk_;
        } else if (buffer.present()) {
            // Its bytes come from elsewhere: a fault for those that ask for them.
            if (i == 0 && is_binary_ && !buffer.extension("EXT_meshopt_compression").present())
                buffer.fault("has no `uri`, and the file no binary chunk that would take its place", "the file may be cut short");
            readable_.push_back(false);
            buffers_.emplace_back();
            empty_.push_back(i);
            continue;
        }
        if (faults.size() == before && bytes.size() < length)
            buffer.fault(fmt::format("claims {} bytes and has {}", length, bytes.size()), "the file may be cut short");
        readable_.push_back(faults.size() == before);
        buffers_.push_back(readable_.back() ? bytes.substr(0, length) : std::string_view());
    }
}

void Document::read_views() {
    for (const Element& view : root.objects("bufferViews")) {
        view.require("buffer");
        view.require("byteLength");
        const std::size_t before = faults.size();
        const auto buffer = view.index("buffer", buffers_.size(), "buffers");
        const auto offset = static_cast<std::size_t>(view.whole("byteOffset", 0, 0, std::int64_t{1} << 50));
        const auto length = static_cast<std::size_t>(view.whole("byteLength", 0, 1, std::int64_t{1} << 50));
        const auto stride = static_cast<std::size_t>(view.whole("byteStride", 0, 4, 252));
        if (stride > length) view.fault(fmt::format("a `byteStride` of {} in {} bytes", stride, length));
        const std::int64_t target = view.whole("target", 34962, 0, 65535);
        if (stride > 0 && target == 34963) view.fault(fmt::format("a `byteStride` of {} in a view of indices, which have none", stride));
        if (stride % 4 != 0) view.fault(fmt::format("a `byteStride` of {}; expected a multiple of 4", stride));
        const bool empty = buffer && std::find(empty_.begin(), empty_.end(), *buffer) != empty_.end();
        if (empty && view.extension("EXT_meshopt_compression").present())
            view.fault("is compressed by EXT_meshopt_compression, which is not supported", "export without it");
        else if (empty)
            view.fault(fmt::format("asks for buffer {}, which has no `uri`, and the file no binary chunk that would take its place", *buffer));
        BufferView out;
        if (buffer && faults.size() == before && readable_[*buffer]) {
            const std::string_view bytes = buffers_[*buffer];
            if (offset > bytes.size() || length > bytes.size() - offset) {
                view.fault(fmt::format("bytes {} to {} of buffer {}, which has {}", offset, offset + length, *buffer, bytes.size()));
            } else {
                out = {bytes.substr(offset, length), offset, stride, true};
            }
        }
        views.push_back(out);
    }
}

}  // namespace wavelobe::gltf
