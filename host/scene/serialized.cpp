// Mitsuba's serialized meshes: streams compressed by zlib, one a mesh, and a table of their offsets at the end.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include <zlib.h>

#include "scene/fault.h"
#include "scene/file.h"
#include "scene/mesh.h"

namespace wavelobe {

namespace {

constexpr std::uint16_t format_mark = 0x041C;
// A flag for face normals exists too; Mitsuba 3 does not heed it.
enum Flags : std::uint32_t {
    has_normals = 0x1,
    has_uvs = 0x2,
    has_colors = 0x8,
    is_double = 0x2000,
};
constexpr std::size_t longest_name = 4096;
// Deflate stores at least a bit for each 129 bytes.
constexpr std::uint64_t most_inflation = 1032;

[[noreturn]] void refuse(const std::string& path, std::size_t offset, const std::string& message) {
    throw InputError(Fault{path, 0, 0, "", message + " (at byte " + std::to_string(offset) + ")", "export the mesh again"});
}

// Little-endian numbers of a file at fixed places.
template <typename T>
T number_at(const std::string& path, const std::string& content, std::size_t offset) {
    if (offset > content.size() || content.size() - offset < sizeof(T)) refuse(path, offset, "the file ends inside its data");
    T value;
    std::memcpy(&value, content.data() + offset, sizeof(T));
    return value;
}
static_assert(std::endian::native == std::endian::little);

// The bytes of one compressed stream, in order.
class Inflater {
public:
    Inflater(const std::string& path, const std::string& content, std::size_t offset) : path_(path), content_(content) {
        state_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data() + offset));
        left_ = content.size() - offset;
        if (inflateInit(&state_) != Z_OK) refuse(path, offset, "cannot start to decompress");
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&state_); }

    void read(void* out, std::size_t size) {
        auto* to = static_cast<Bytef*>(out);
        while (size > 0) {
            const auto step = static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max()));
            if (state_.avail_in == 0) {
                state_.avail_in = static_cast<uInt>(std::min<std::size_t>(left_, std::numeric_limits<uInt>::max()));
                left_ -= state_.avail_in;
            }
            state_.next_out = to;
            state_.avail_out = step;
            const int result = inflate(&state_, Z_NO_FLUSH);
            const std::size_t made = step - state_.avail_out;
            to += made;
            size -= made;
            const bool ended = result == Z_STREAM_END || (made == 0 && state_.avail_in == 0 && left_ == 0);
            if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) refuse(path_, offset(), "the compressed data is damaged");
            if (size > 0 && ended) refuse(path_, offset(), "the compressed data ends inside the mesh");
        }
    }

    template <typename T>
    T next() {
        T value;
        read(&value, sizeof(T));
        return value;
    }

    // What could still follow, at the best compression there is.
    std::uint64_t most_bytes_left() const { return (std::uint64_t{state_.avail_in} + left_ + 1) * most_inflation; }

    std::size_t offset() const {
        return static_cast<std::size_t>(reinterpret_cast<const char*>(state_.next_in) - content_.data());
    }

private:
    const std::string& path_;
    const std::string& content_;
    z_stream state_{};
    std::size_t left_ = 0;  // not yet handed to zlib
};

class MeshStream {
public:
    MeshStream(const std::string& path, const std::string& content, std::size_t offset, bool named)
        : path_(path), data_(path, content, offset), flags_(data_.next<std::uint32_t>()) {
        for (std::size_t i = 0; named && data_.next<char>() != '\0'; ++i)
            if (i > longest_name) refuse(path, data_.offset(), "the name of the mesh does not end");
        vertex_count_ = data_.next<std::uint64_t>();
        triangle_count_ = data_.next<std::uint64_t>();
        check_size();
    }

    MeshSource read() {
        MeshSource mesh;
        mesh.positions = vectors<glm::vec3>();
        if (has(has_normals)) mesh.normals = vectors<glm::vec3>();
        if (has(has_uvs)) mesh.uvs = vectors<glm::vec2>();
        if (has(has_colors)) vectors<glm::vec3>();
        mesh.triangles.resize(triangle_count_);
        data_.read(mesh.triangles.data(), triangle_count_ * sizeof(glm::uvec3));
        for (const glm::uvec3& t : mesh.triangles)
            if (std::max({t.x, t.y, t.z}) >= vertex_count_)
                refuse(path_, data_.offset(), "a triangle names a vertex that is not among the " + std::to_string(vertex_count_));
        return mesh;
    }

private:
    bool has(std::uint32_t flag) const { return (flags_ & flag) != 0; }
    std::uint64_t number_size() const { return has(is_double) ? 8 : 4; }

    void check_size() const {
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
        const std::uint64_t numbers = 3 + (has(has_normals) ? 3 : 0) + (has(has_uvs) ? 2 : 0) + (has(has_colors) ? 3 : 0);
        const bool counted = vertex_count_ <= most && triangle_count_ <= most;
        const std::uint64_t bytes = counted ? vertex_count_ * numbers * number_size() + triangle_count_ * sizeof(glm::uvec3) : 0;
        if (counted && bytes <= data_.most_bytes_left()) return;
        refuse(path_, data_.offset(), "the file is too short for the " + std::to_string(vertex_count_) + " vertices and " +
                                          std::to_string(triangle_count_) + " triangles that it claims");
    }

    template <typename Vector>
    std::vector<Vector> vectors() {
        std::vector<Vector> out(vertex_count_);
        if (!has(is_double)) {
            data_.read(out.data(), vertex_count_ * sizeof(Vector));
            return out;
        }
        for (Vector& v : out)
            for (glm::length_t k = 0; k < Vector::length(); ++k) v[k] = static_cast<float>(data_.next<double>());
        return out;
    }

    const std::string& path_;
    Inflater data_;
    std::uint32_t flags_ = 0;
    std::uint64_t vertex_count_ = 0, triangle_count_ = 0;
};

// Where mesh `index` starts, by the table at the end.
std::size_t mesh_offset(const std::string& path, const std::string& content, int version, std::uint32_t index) {
    if (index == 0) return 0;
    const auto behind = [&](std::size_t bytes) { return content.size() - std::min(bytes, content.size()); };
    const auto count = number_at<std::uint32_t>(path, content, behind(4));
    const std::size_t entry = version == 3 ? 4 : 8;
    if (index >= count || std::uint64_t{count} * entry + 4 > content.size())
        refuse(path, behind(4), "the file holds " + std::to_string(count) + " meshes; there is no `shape_index` " + std::to_string(index));
    const std::size_t at = behind(4 + entry * (count - index));
    return version == 3 ? number_at<std::uint32_t>(path, content, at) : static_cast<std::size_t>(number_at<std::uint64_t>(path, content, at));
}

}  // namespace

MeshSource load_serialized(const std::string& path, std::uint32_t index) {
    const std::string content = read_file(path);
    if (number_at<std::uint16_t>(path, content, 0) != format_mark) refuse(path, 0, "not a serialized mesh of Mitsuba");
    const int version = number_at<std::uint16_t>(path, content, 2);
    if (version != 3 && version != 4) refuse(path, 2, "version " + std::to_string(version) + " is not supported; expected 3 or 4");
    const std::size_t offset = mesh_offset(path, content, version, index);
    if (number_at<std::uint16_t>(path, content, offset) != format_mark) refuse(path, offset, "no mesh starts where the table of meshes says");
    number_at<std::uint16_t>(path, content, offset + 2);
    return MeshStream(path, content, offset + 4, version == 4).read();
}

}  // namespace wavelobe
