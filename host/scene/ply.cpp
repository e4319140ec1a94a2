// Stanford PLY meshes: ascii and both binary byte orders.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <sstream>

#include "scene/fault.h"
#include "scene/file.h"
#include "scene/mesh.h"

namespace wavelobe {

namespace {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::array<std::size_t, 8> type_sizes{1, 1, 2, 2, 4, 4, 4, 8};
std::size_t size_of(Type type) { return type_sizes[static_cast<std::size_t>(type)]; }

struct Property {
    std::string name;
    Type type = Type::float32;
    bool list = false;
    Type count_type = Type::uint8;
    int target = -1;  // for vertices: position, normal and texture coordinates, 0 to 7
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding : std::uint8_t { ascii, little, big };

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::size_t body = 0;  // offset of the first byte behind the header
};

[[noreturn]] void refuse(const std::string& path, int line, const std::string& message) {
    throw InputError(Fault{path, line, line > 0 ? 1 : 0, "", message, "export the mesh again"});
}

class HeaderReader {
public:
    HeaderReader(const std::string& path, const std::string& text) : path_(path), text_(text) {}

    Header read() {
        if (next_line() != "ply") fail("not a PLY file: the first line must be `ply`");
        bool has_format = false;
        for (std::string line = next_line(); line != "end_header"; line = next_line()) {
            std::istringstream words(line);
            std::string word;
            words >> word;
            if (word.empty() || word == "comment" || word == "obj_info") continue;
            if (word == "format") read_format(words), has_format = true;
            else if (word == "element") read_element(words);
            else if (word == "property") read_property(words);
            else fail("unknown header line `" + line.substr(0, 80) + "`; expected format, element, property or comment");
        }
        if (!has_format) fail("the header has no `format` line");
        header_.body = position_;
        return std::move(header_);
    }

private:
    [[noreturn]] void fail(const std::string& message) { refuse(path_, line_, message); }

    std::string next_line() {
        if (position_ >= text_.size()) fail("the file ends inside its header; expected `end_header`");
        const std::size_t end = std::min(text_.find('\n', position_), text_.size());
        std::string line = text_.substr(position_, end - position_);
        if (!line.empty() && line.back() == '\r') line.pop_back();
        position_ = end + 1;
        ++line_;
        return line;
    }

    void read_format(std::istringstream& words) {
        std::string encoding, version;
        words >> encoding >> version;
        constexpr std::array<const char*, 3> names{"ascii", "binary_little_endian", "binary_big_endian"};
        const auto* found = std::find(names.begin(), names.end(), encoding);
        if (found == names.end() || version != "1.0")
            fail("unknown format `" + encoding + " " + version + "`; expected ascii, binary_little_endian or binary_big_endian 1.0");
        header_.encoding = static_cast<Encoding>(found - names.begin());
    }

    void read_element(std::istringstream& words) {
        Element element;
        std::string count;
        words >> element.name >> count;
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (element.name.empty() || error != std::errc{} || end != count.data() + count.size())
            fail("an element line must read `element <name> <count>`");
        header_.elements.push_back(std::move(element));
    }

    Type read_type(const std::string& word) {
        constexpr std::array<const char*, 8> names{"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
        constexpr std::array<const char*, 8> sized{"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
        for (std::size_t i = 0; i < names.size(); ++i)
            if (word == names[i] || word == sized[i]) return static_cast<Type>(i);
        fail("unknown scalar type `" + word + "`");
    }

    void read_property(std::istringstream& words) {
        if (header_.elements.empty()) fail("a property before the first element");
        Property property;
        std::string type;
        words >> type;
        if (type == "list") {
            property.list = true;
            words >> type;
            property.count_type = read_type(type);
            if (property.count_type >= Type::float32) fail("the count of a list must be a whole number");
            words >> type;
        }
        property.type = read_type(type);
        if (!(words >> property.name)) fail("a property without a name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    const std::string& path_;
    const std::string& text_;
    std::size_t position_ = 0;
    int line_ = 0;
    Header header_;
};

// Values one after another, from binary data or text.
class Cursor {
public:
    Cursor(const std::string& path, const std::string& text, const Header& header)
        : path_(path), text_(text), at_(text.data() + std::min(header.body, text.size())), end_(text.data() + text.size()),
          ascii_(header.encoding == Encoding::ascii),
          swap_((header.encoding == Encoding::big) != (std::endian::native == std::endian::big)) {}

    double next(Type type) {
        if (ascii_) return next_word();
        switch (type) {
            case Type::int8: return binary<std::int8_t>();
            case Type::uint8: return binary<std::uint8_t>();
            case Type::int16: return binary<std::int16_t>();
            case Type::uint16: return binary<std::uint16_t>();
            case Type::int32: return binary<std::int32_t>();
            case Type::uint32: return binary<std::uint32_t>();
            case Type::float32: return static_cast<double>(binary<float>());
            case Type::float64: return binary<double>();
        }
        return 0.0;
    }

    // Each value takes its size in binary files, a digit and a blank in text.
    void check_size(const Element& element) const {
        std::size_t least = 0;
        for (const Property& property : element.properties)
            least += ascii_ ? 2 : size_of(property.list ? property.count_type : property.type);
        const auto left = static_cast<std::size_t>(end_ - at_) + (ascii_ ? 1 : 0);
        if (least > 0 && element.count > left / least)
            fail("the file is too short for its " + std::to_string(element.count) + " `" + element.name + "` elements");
    }

    [[noreturn]] void fail(const std::string& message) const {
        if (ascii_) refuse(path_, 1 + static_cast<int>(std::count(text_.data(), at_, '\n')), message);
        refuse(path_, 0, message + " (at byte " + std::to_string(at_ - text_.data()) + ")");
    }

private:
    template <typename T>
    T binary() {
        if (static_cast<std::size_t>(end_ - at_) < sizeof(T)) fail("the file ends inside its data");
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), at_, sizeof(T));
        at_ += sizeof(T);
        if (swap_) std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<T>(bytes);
    }

    double next_word() {
        while (at_ < end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
        if (at_ < end_ && *at_ == '+') ++at_;
        double number = 0.0;
        const auto [behind, error] = std::from_chars(at_, end_, number);
        if (at_ == end_) fail("the file ends inside its data");
        if (error == std::errc::invalid_argument) fail("cannot read a number");
        at_ = behind;
        return number;
    }

    const std::string& path_;
    const std::string& text_;
    const char* at_;
    const char* end_;
    bool ascii_;
    bool swap_;
};

constexpr int position_target = 0, normal_target = 3, uv_target = 6;

// Which numbers of a vertex mean something here. Texture coordinates go by several names.
bool find_targets(Element& vertices, const std::vector<const char*>& names, int first) {
    std::vector<Property*> found;
    for (const char* name : names)
        for (Property& property : vertices.properties)
            if (property.name == name && !property.list) found.push_back(&property);
    if (found.size() != names.size()) return false;
    for (std::size_t i = 0; i < found.size(); ++i) found[i]->target = first + static_cast<int>(i);
    return true;
}

void read_vertices(Cursor& cursor, Element& element, bool flip_tex_coords, MeshSource& mesh) {
    if (!find_targets(element, {"x", "y", "z"}, position_target)) cursor.fail("the vertices have no `x`, `y` and `z`");
    const bool normals = find_targets(element, {"nx", "ny", "nz"}, normal_target);
    const bool uvs = find_targets(element, {"u", "v"}, uv_target) || find_targets(element, {"s", "t"}, uv_target) ||
                     find_targets(element, {"texture_u", "texture_v"}, uv_target) ||
                     find_targets(element, {"texture_s", "texture_t"}, uv_target);
    mesh.positions.resize(element.count);
    if (normals) mesh.normals.resize(element.count);
    if (uvs) mesh.uvs.resize(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
        std::array<float, 8> values{};
        for (const Property& property : element.properties) {
            const auto count = property.list ? static_cast<std::size_t>(std::max(0.0, cursor.next(property.count_type))) : 1;
            for (std::size_t k = 0; k < count; ++k) {
                const double value = cursor.next(property.type);
                if (property.target >= 0) values[static_cast<std::size_t>(property.target)] = static_cast<float>(value);
            }
        }
        mesh.positions[i] = {values[0], values[1], values[2]};
        if (normals) mesh.normals[i] = {values[3], values[4], values[5]};
        if (uvs) mesh.uvs[i] = {values[6], flip_tex_coords ? 1.0F - values[7] : values[7]};
    }
}

// Polygons are cut into fans around their first corner.
void read_faces(Cursor& cursor, const Element& element, std::size_t vertex_count, MeshSource& mesh) {
    const auto is_indices = [](const Property& property) {
        return property.list && (property.name == "vertex_index" || property.name == "vertex_indices");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_indices))
        cursor.fail("the faces have no list `vertex_index` or `vertex_indices`");
    mesh.triangles.reserve(element.count);
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) {
            const auto count = property.list ? static_cast<std::size_t>(std::max(0.0, cursor.next(property.count_type))) : 1;
            const bool indices = is_indices(property);
            corners.clear();
            for (std::size_t k = 0; k < count; ++k) {
                const double value = cursor.next(property.type);
                if (!indices) continue;
                if (!(value >= 0.0 && value < static_cast<double>(vertex_count)))
                    cursor.fail("face " + std::to_string(i) + " names a vertex that is not among the " + std::to_string(vertex_count));
                corners.push_back(static_cast<std::uint32_t>(value));
            }
            for (std::size_t k = 2; k < corners.size(); ++k) mesh.triangles.emplace_back(corners[0], corners[k - 1], corners[k]);
        }
}

void skip(Cursor& cursor, const Element& element) {
    if (element.properties.empty()) return;
    for (std::size_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) {
            const auto count = property.list ? static_cast<std::size_t>(std::max(0.0, cursor.next(property.count_type))) : 1;
            for (std::size_t k = 0; k < count; ++k) cursor.next(property.type);
        }
}

}  // namespace

MeshSource load_ply(const std::string& path, bool flip_tex_coords) {
    const std::string text = read_file(path);
    Header header = HeaderReader(path, text).read();
    Cursor cursor(path, text, header);
    const auto is_vertices = [](const Element& element) { return element.name == "vertex"; };
    const auto vertices = std::find_if(header.elements.begin(), header.elements.end(), is_vertices);
    if (std::count_if(header.elements.begin(), header.elements.end(), is_vertices) != 1)
        cursor.fail("expected one `vertex` element");
    MeshSource mesh;
    for (Element& element : header.elements) {
        cursor.check_size(element);
        if (element.name == "vertex") read_vertices(cursor, element, flip_tex_coords, mesh);
        else if (element.name == "face") read_faces(cursor, element, vertices->count, mesh);
        else skip(cursor, element);
    }
    return mesh;
}

}  // namespace wavelobe
