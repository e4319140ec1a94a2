// The headers of Stanford PLY files.
#include "scene/ply_header.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <utility>

#include "scene/fault.h"

namespace wavelobe::ply {

namespace {

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
            else
                fail("unknown header line `" + line.substr(0, 80) +
                     "`; expected format, element, property or comment");
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
            fail("unknown format `" + encoding + " " + version +
                 "`; expected ascii, binary_little_endian or binary_big_endian 1.0");
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
        constexpr std::array<const char*, 8> names{"char", "uchar", "short", "ushort",
                                                   "int",  "uint",  "float", "double"};
        constexpr std::array<const char*, 8> sized{"int8",  "uint8",  "int16",   "uint16",
                                                   "int32", "uint32", "float32", "float64"};
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

}  // namespace

void refuse(const std::string& path, int line, const std::string& message) {
    throw InputError(Fault{path, line, line > 0 ? 1 : 0, "", message, "export the mesh again"});
}

Header read_header(const std::string& path, const std::string& text) { return HeaderReader(path, text).read(); }

}  // namespace wavelobe::ply
