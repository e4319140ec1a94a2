// Stanford PLY meshes: ascii and both binary byte orders.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <iterator>

#include "scene/file.h"
#include "scene/mesh.h"
#include "scene/ply_attributes.h"
#include "scene/ply_header.h"

namespace wavelobe {

namespace {

using namespace ply;

// Values one after another, from binary data or text.
class Cursor {
public:
    Cursor(const std::string& path, const std::string& text, const Header& header)
        : path_(path),
          text_(text),
          at_(text.data() + std::min(header.body, text.size())),
          end_(text.data() + text.size()),
          ascii_(header.encoding == Encoding::ascii),
          swap_((header.encoding == Encoding::big) != (std::endian::native == std::endian::big)) {}

    double next(Type type) {
        if (ascii_) return next_word();
        switch (type) {
            case Type::int8:
                return binary<std::int8_t>();
            case Type::uint8:
                return binary<std::uint8_t>();
            case Type::int16:
                return binary<std::int16_t>();
            case Type::uint16:
                return binary<std::uint16_t>();
            case Type::int32:
                return binary<std::int32_t>();
            case Type::uint32:
                return binary<std::uint32_t>();
            case Type::float32:
                return static_cast<double>(binary<float>());
            case Type::float64:
                return binary<double>();
        }
        return 0.0;
    }

    // How many values of the property follow.
    std::size_t length(const Property& property) {
        if (!property.list) return 1;
        const double count = next(property.count_type);
        if (!(count >= 0.0 && count <= static_cast<double>(end_ - at_))) fail("a list claims " + std::to_string(count) + " values");
        return static_cast<std::size_t>(count);
    }

    // Each value takes its size in binary files, a digit and a blank in text.
    void check_size(const Element& element) const {
        std::size_t least = 0;
        for (const Property& property : element.properties)
            least += ascii_ ? 2 : size_of(property.list ? property.count_type : property.type);
        const auto left = static_cast<std::size_t>(end_ - at_) + (ascii_ ? 1 : 0);
        if (least > 0 && element.count > left / least)
            fail("the file is too short for its " + std::to_string(element.count) + " `" + element.name +
                 "` elements");
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

constexpr int position_target = 0, normal_target = 3, uv_target = 6, attribute_target = 8;

// The attributes of one element, each three numbers from `attribute_target` on; those of one channel use the first.
std::vector<MeshAttribute> find_attributes(Element& element, const std::string& kind, const std::vector<std::string>& names) {
    std::vector<MeshAttribute> found;
    for (const std::string& name : names) {
        const std::vector<std::size_t> columns = find_attribute(element, kind, name);
        if (columns.empty()) continue;
        for (std::size_t i = 0; i < columns.size(); ++i)
            element.properties[columns[i]].targets.push_back(attribute_target + 3 * static_cast<int>(found.size()) + static_cast<int>(i));
        found.push_back({name, static_cast<int>(columns.size()), kind == "face_", {}});
    }
    return found;
}

// Numbers of one vertex or face by their targets.
class Record {
public:
    explicit Record(const std::vector<MeshAttribute>& attributes) : values_(attribute_target + 3 * attributes.size()) {}

    void set(const Property& property, double value) {
        for (const int target : property.targets) values_[static_cast<std::size_t>(target)] = static_cast<float>(value);
    }
    float operator[](int target) const { return values_[static_cast<std::size_t>(target)]; }
    glm::vec3 attribute(std::size_t number, int channels) const {
        const float* first = &values_[attribute_target + 3 * number];
        return channels == 1 ? glm::vec3(first[0]) : glm::vec3(first[0], first[1], first[2]);
    }

private:
    std::vector<float> values_;
};

// Which numbers of a vertex mean something here. Texture coordinates go by several names.
bool find_targets(Element& vertices, const std::vector<const char*>& names, int first) {
    std::vector<Property*> found;
    for (const char* name : names)
        for (Property& property : vertices.properties)
            if (property.name == name && !property.list) found.push_back(&property);
    if (found.size() != names.size()) return false;
    for (std::size_t i = 0; i < found.size(); ++i) found[i]->targets.push_back(first + static_cast<int>(i));
    return true;
}

void read_vertices(Cursor& cursor, Element& element, bool flip_tex_coords, const std::vector<std::string>& names, MeshSource& mesh) {
    if (!find_targets(element, {"x", "y", "z"}, position_target))
        cursor.fail("the vertices have no `x`, `y` and `z`");
    const bool normals = find_targets(element, {"nx", "ny", "nz"}, normal_target);
    const bool uvs = find_targets(element, {"u", "v"}, uv_target) || find_targets(element, {"s", "t"}, uv_target) ||
                     find_targets(element, {"texture_u", "texture_v"}, uv_target) ||
                     find_targets(element, {"texture_s", "texture_t"}, uv_target);
    std::vector<MeshAttribute> attributes = find_attributes(element, "vertex_", names);
    for (MeshAttribute& attribute : attributes) attribute.values.resize(element.count);
    Record values(attributes);
    mesh.positions.resize(element.count);
    if (normals) mesh.normals.resize(element.count);
    if (uvs) mesh.uvs.resize(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
            const std::size_t count = cursor.length(property);
            for (std::size_t k = 0; k < count; ++k) values.set(property, cursor.next(property.type));
        }
        mesh.positions[i] = {values[0], values[1], values[2]};
        if (normals) mesh.normals[i] = {values[3], values[4], values[5]};
        if (uvs) mesh.uvs[i] = {values[6], flip_tex_coords ? 1.0F - values[7] : values[7]};
        for (std::size_t k = 0; k < attributes.size(); ++k) attributes[k].values[i] = values.attribute(k, attributes[k].channels);
    }
    std::move(attributes.begin(), attributes.end(), std::back_inserter(mesh.attributes));
}

// Polygons are cut into fans around their first corner; each triangle has the attributes of its polygon.
void read_faces(Cursor& cursor, Element& element, std::size_t vertex_count, const std::vector<std::string>& names, MeshSource& mesh) {
    const auto is_indices = [](const Property& property) {
        return property.list && (property.name == "vertex_index" || property.name == "vertex_indices");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_indices))
        cursor.fail("the faces have no list `vertex_index` or `vertex_indices`");
    std::vector<MeshAttribute> attributes = find_attributes(element, "face_", names);
    Record values(attributes);
    mesh.triangles.reserve(element.count);
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
            const std::size_t count = cursor.length(property);
            const bool indices = is_indices(property);
            corners.clear();
            for (std::size_t k = 0; k < count; ++k) {
                const double value = cursor.next(property.type);
                if (!indices) {
                    values.set(property, value);
                    continue;
                }
                if (!(value >= 0.0 && value < static_cast<double>(vertex_count)))
                    cursor.fail("face " + std::to_string(i) + " names a vertex that is not among the " +
                                std::to_string(vertex_count));
                corners.push_back(static_cast<std::uint32_t>(value));
            }
            for (std::size_t k = 2; k < corners.size(); ++k)
                mesh.triangles.emplace_back(corners[0], corners[k - 1], corners[k]);
        }
        for (std::size_t k = 0; k < attributes.size(); ++k)
            attributes[k].values.resize(mesh.triangles.size(), values.attribute(k, attributes[k].channels));
    }
    std::move(attributes.begin(), attributes.end(), std::back_inserter(mesh.attributes));
}

void skip(Cursor& cursor, const Element& element) {
    if (element.properties.empty()) return;
    for (std::size_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) {
            const std::size_t count = cursor.length(property);
            for (std::size_t k = 0; k < count; ++k) cursor.next(property.type);
        }
}

}  // namespace

MeshSource load_ply(const std::string& path, bool flip_tex_coords, const std::vector<std::string>& attributes) {
    const std::string text = read_file(path);
    Header header = read_header(path, text);
    Cursor cursor(path, text, header);
    const auto is_vertices = [](const Element& element) { return element.name == "vertex"; };
    const auto vertices = std::find_if(header.elements.begin(), header.elements.end(), is_vertices);
    if (std::count_if(header.elements.begin(), header.elements.end(), is_vertices) != 1)
        cursor.fail("expected one `vertex` element");
    MeshSource mesh;
    for (Element& element : header.elements) {
        cursor.check_size(element);
        if (element.name == "vertex") read_vertices(cursor, element, flip_tex_coords, attributes, mesh);
        else if (element.name == "face") read_faces(cursor, element, vertices->count, attributes, mesh);
        else skip(cursor, element);
    }
    return mesh;
}

}  // namespace wavelobe
