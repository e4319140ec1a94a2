// Wavefront OBJ meshes, by way of tinyobjloader. All groups of a file make one mesh, its materials do
// not count. Polygons are cut into fans around their first corner.
#include <algorithm>
#include <istream>
#include <streambuf>

#include <tiny_obj_loader.h>

#include "scene/fault.h"
#include "scene/file.h"
#include "scene/mesh.h"

namespace wavelobe {

namespace {

constexpr std::size_t max_faults = 10;
constexpr std::uint32_t none = 0xFFFFFFFFU;

// A stream over text in memory that knows which line has just been read.
class TextBuffer : public std::streambuf {
public:
    explicit TextBuffer(std::string& text) {
        join_lines(text);
        setg(text.data(), text.data(), text.data() + text.size());
    }

    std::string_view line() const {
        const char* end = gptr();
        if (end > eback() && end[-1] == '\n') --end;
        const char* begin = end;
        while (begin > eback() && begin[-1] != '\n') --begin;
        return {begin, static_cast<std::size_t>(end - begin)};
    }

    int line_number() const {
        const char* begin = line().data();
        const auto joined = std::lower_bound(joined_.begin(), joined_.end(), static_cast<std::size_t>(begin - eback()));
        return 1 + static_cast<int>(std::count(static_cast<const char*>(eback()), begin, '\n') + (joined - joined_.begin()));
    }

private:
    // A backslash at the end of a line joins it with the next.
    void join_lines(std::string& text) {
        for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
            std::size_t end = at + 1;
            if (end < text.size() && text[end] == '\r') ++end;
            if (end >= text.size() || text[end] != '\n') continue;
            std::fill(text.begin() + static_cast<std::ptrdiff_t>(at), text.begin() + static_cast<std::ptrdiff_t>(end) + 1, ' ');
            joined_.push_back(at);
        }
    }

    std::vector<std::size_t> joined_;  // where, in order
};

// A vertex of the mesh: one combination of position, texture coordinates and normal.
struct Corner {
    std::uint32_t uv = none;
    std::uint32_t normal = none;
    std::uint32_t next = none;  // the next vertex at the same position
};

class ObjReader {
public:
    ObjReader(const std::string& path, bool flip_tex_coords) : path_(path), flip_tex_coords_(flip_tex_coords) {}

    MeshSource read() {
        std::string text = read_file(path_);
        TextBuffer buffer(text);
        buffer_ = &buffer;
        std::istream stream(&buffer);
        tinyobj::callback_t callbacks;
        callbacks.vertex_cb = [](void* self, float x, float y, float z, float) {
            cast(self).add_position({x, y, z});
        };
        callbacks.normal_cb = [](void* self, float x, float y, float z) { cast(self).add_normal({x, y, z}); };
        callbacks.texcoord_cb = [](void* self, float u, float v, float) { cast(self).add_uv({u, v}); };
        callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
            cast(self).add_face(corners, count);
        };
        tinyobj::LoadObjWithCallback(stream, callbacks, this);
        if (!faults_.empty()) throw InputError(std::move(faults_));
        if (!has_uvs_) mesh_.uvs.clear();
        if (!has_normals_) mesh_.normals.clear();
        return std::move(mesh_);
    }

private:
    static ObjReader& cast(void* self) { return *static_cast<ObjReader*>(self); }

    void fault(const std::string& message) {
        faults_.push_back(
            {path_, buffer_->line_number(), 1, "", message, "correct the line or export the mesh again"});
        if (faults_.size() >= max_faults) throw InputError(std::move(faults_));
    }

    // The loader takes what it cannot read for zero, so the line itself is looked at.
    void check_numbers(std::size_t least) {
        const std::string_view line = buffer_->line();
        constexpr std::string_view blanks = " \t\r";
        std::size_t count = 0;
        std::size_t begin = line.find_first_of(blanks, line.find('v'));
        while ((begin = line.find_first_not_of(blanks, begin)) != std::string_view::npos && line[begin] != '#') {
            const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
            const std::string_view token = line.substr(begin, end - begin);
            const bool readable = token.find_first_not_of("0123456789+-.eE") == std::string_view::npos &&
                                  token.find_first_of("0123456789") != std::string_view::npos;
            if (!readable && token != "nan" && token != "inf" && token != "-nan" && token != "-inf") break;
            ++count;
            begin = end;
        }
        if (count < least)
            fault("cannot read `" + std::string(line.substr(0, 80)) + "`; expected " + std::to_string(least) +
                  " numbers");
    }

    void add_position(const glm::vec3& position) {
        check_numbers(3);
        positions_.push_back(position);
        first_vertex_.push_back(none);
    }

    void add_normal(const glm::vec3& normal) {
        check_numbers(3);
        normals_.push_back(normal);
    }

    void add_uv(glm::vec2 uv) {
        check_numbers(2);
        if (flip_tex_coords_) uv.y = 1.0F - uv.y;
        uvs_.push_back(uv);
    }

    // OBJ counts from one, negative numbers from the end; zero stands for a part that is left out.
    std::uint32_t index(int number, std::size_t count, const char* what, bool optional) {
        if (number == 0 && optional) return none;
        const long long at = number > 0 ? number - 1LL : static_cast<long long>(count) + number;
        if (number != 0 && at >= 0 && at < static_cast<long long>(count)) return static_cast<std::uint32_t>(at);
        fault(std::string("the face names ") + what + " " + std::to_string(number) + " of " +
              std::to_string(count));
        return none;
    }

    void add_face(const tinyobj::index_t* corners, int count) {
        face_.clear();
        for (int i = 0; i < count; ++i) {
            const std::uint32_t position = index(corners[i].vertex_index, positions_.size(), "position", false);
            const std::uint32_t uv = index(corners[i].texcoord_index, uvs_.size(), "texture coordinates", true);
            const std::uint32_t normal = index(corners[i].normal_index, normals_.size(), "normal", true);
            if (position == none) return;
            face_.push_back(vertex(position, uv, normal));
        }
        for (std::size_t i = 2; i < face_.size(); ++i)
            mesh_.triangles.emplace_back(face_[0], face_[i - 1], face_[i]);
    }

    std::uint32_t vertex(std::uint32_t position, std::uint32_t uv, std::uint32_t normal) {
        for (std::uint32_t v = first_vertex_[position]; v != none; v = corners_[v].next)
            if (corners_[v].uv == uv && corners_[v].normal == normal) return v;
        const auto fresh = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back({uv, normal, first_vertex_[position]});
        first_vertex_[position] = fresh;
        mesh_.positions.push_back(positions_[position]);
        mesh_.uvs.push_back(uv == none ? glm::vec2(0.0F) : uvs_[uv]);
        mesh_.normals.push_back(normal == none ? glm::vec3(0.0F) : normals_[normal]);
        has_uvs_ = has_uvs_ || uv != none;
        has_normals_ = has_normals_ || normal != none;
        return fresh;
    }

    const std::string& path_;
    bool flip_tex_coords_;
    const TextBuffer* buffer_ = nullptr;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec2> uvs_;
    std::vector<std::uint32_t> first_vertex_;  // by position
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> face_;
    bool has_uvs_ = false, has_normals_ = false;
    MeshSource mesh_;
    std::vector<Fault> faults_;
};

}  // namespace

MeshSource load_obj(const std::string& path, bool flip_tex_coords) {
    return ObjReader(path, flip_tex_coords).read();
}

}  // namespace wavelobe
