// From XML files to a document of objects.
#include "scene/mitsuba/document.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <pugixml.hpp>

#include "scene/file.h"
#include "scene/mitsuba/elements.h"
#include "scene/mitsuba/references.h"
#include "scene/mitsuba/substitution.h"
#include "scene/mitsuba/upgrade.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_include_depth = 15;
constexpr std::size_t max_includes = 10000;  // each as often as it is named
constexpr std::size_t max_properties = 256;

// One that ends the reading.
Fault fault_at(const Place& place, const std::string& element, const std::string& message, const std::string& hint) {
    return {place.file == nullptr ? "" : *place.file, place.line, place.column, element, message, hint};
}

// One file while it is being read.
struct SourceFile {
    const std::string* name = nullptr;
    std::vector<std::size_t> line_starts;

    SourceFile(const std::string* file_name, const std::string& text) : name(file_name), line_starts{0} {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') line_starts.push_back(i + 1);
    }

    Place place(std::ptrdiff_t offset) const {
        const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
        const auto line = std::upper_bound(line_starts.begin(), line_starts.end(), at) - line_starts.begin();
        return {name, static_cast<int>(line),
                static_cast<int>(at - line_starts[static_cast<std::size_t>(line - 1)]) + 1};
    }

    // The offset of a node is that of its name, one behind the bracket.
    Place place(const pugi::xml_node& node) const { return place(node.offset_debug() - 1); }
};

class DocumentReader {
public:
    DocumentReader(Document& document, const Definitions& definitions, Faults& faults)
        : document_(document), faults_(faults), substitution_(definitions) {}

    void read(const std::string& path) {
        document_.search_folders.push_back(fs::path(path).parent_path().string());
        read_file_into(path, nullptr, Place{});
        resolve_references(document_, ids_, faults_);
        for (const std::string& name : substitution_.unused())
            faults_.add(Place{&document_.files.front(), 0, 0}, "-D " + name,
                        "the scene does not use this definition",
                        "remove it, or write $" + name + " where it should apply");
    }

private:
    // `parent` receives what an included file holds; null for the scene file itself.
    void read_file_into(const std::string& path, Object* parent, const Place& from) {
        const std::string canonical = fs::weakly_canonical(path).string();
        if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
            return faults_.add(from, "<include>", "`" + path + "` includes itself, directly or through other files",
                               "remove one include of the loop");
        if (++includes_ > max_includes)
            throw InputError(fault_at(from, "<include>", "the scene includes more than " + std::to_string(max_includes) + " files", ""));
        if (open_files_.size() >= max_include_depth)
            return faults_.add(from, "<include>",
                               "includes are nested more than " + std::to_string(max_include_depth) + " deep",
                               "flatten the files");
        document_.files.push_back(path);
        const std::string& name = document_.files.back();
        const std::string text = wavelobe::read_file(path);
        const SourceFile file(&name, text);
        pugi::xml_document xml;
        const pugi::xml_parse_result result = xml.load_buffer(text.data(), text.size());
        if (!result)
            return faults_.add(file.place(result.offset), "",
                               std::string("not well-formed XML: ") + result.description(), "correct the XML");
        open_files_.push_back(canonical);
        const bool outer_legacy = legacy_;
        legacy_ = false;
        read_root(xml.document_element(), file, parent);
        legacy_ = outer_legacy;
        open_files_.pop_back();
    }

    void read_root(const pugi::xml_node& node, const SourceFile& file, Object* parent) {
        Element element = make_element(node, file);
        if (!check_version(element)) return;
        std::erase_if(element.attributes, [](const auto& attribute) { return attribute.first == "version"; });
        if (element.tag == "scene") {
            check_attributes(element, {}, {"type", "id", "name"}, faults_);
            if (parent == nullptr) {
                document_.root = &document_.objects.emplace_back();
                document_.root->tag = document_.root->type = "scene";
                document_.root->place = element.place;
                parent = document_.root;
            }
            read_children(node, file, *parent);
        } else if (parent != nullptr && is_object_tag(element.tag)) {
            read_object(node, element, file, *parent);
        } else {
            faults_.add(element.place, "<" + element.tag + ">",
                        "a scene file starts with <scene version=\"3.0.0\">", "");
        }
    }

    bool check_version(const Element& element) {
        const std::string* version = element.attribute("version");
        const std::string label = "<" + element.tag + ">";
        if (version == nullptr) {
            faults_.add(element.place, label, "the attribute `version` is missing", "add version=\"3.0.0\"");
            return false;
        }
        std::vector<std::int64_t> parts;
        std::size_t begin = 0;
        bool numbers = true;
        while (begin <= version->size()) {
            const std::size_t end = std::min(version->find('.', begin), version->size());
            const auto part = parse_integer(version->substr(begin, end - begin));
            numbers = numbers && part && *part >= 0;
            parts.push_back(part.value_or(0));
            begin = end + 1;
        }
        if (!numbers || parts.size() != 3) {
            faults_.add(element.place, label,
                        "cannot read the version `" + *version + "`; expected three numbers such as 3.0.0", "");
            return false;
        }
        legacy_ = parts[0] < 2;
        return true;
    }

    Element make_element(const pugi::xml_node& node, const SourceFile& file) {
        Element element{node.name(), {}, file.place(node), false};
        const auto undefined = [&](const std::string& name) {
            faults_.add(element.place, "<" + element.tag + ">", "$" + name + " is not defined",
                        "define it before its use with <default name=\"" + name + "\" value=\"...\"/> or -D " +
                            name + "=...");
            element.broken = true;
        };
        try {
            for (const pugi::xml_attribute& attribute : node.attributes())
                element.attributes.emplace_back(attribute.name(), substitution_.apply(attribute.value(), undefined));
        } catch (const std::length_error&) {
            throw InputError(fault_at(element.place, "<" + element.tag + ">", "the parameters of the scene hold each other and grow beyond 64 MiB",
                                      "let their values be plain"));
        }
        if (legacy_) upgrade_element(element);
        return element;
    }

    void read_children(const pugi::xml_node& node, const SourceFile& file, Object& parent) {
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element) read_child(child, file, parent);
    }

    void read_child(const pugi::xml_node& node, const SourceFile& file, Object& parent) {
        const Element element = make_element(node, file);
        const std::string& tag = element.tag;
        // <spectrum type="..."> is an object, as a texture is.
        const bool spectrum_object = tag == "spectrum" && element.attribute("type") != nullptr;
        if (is_object_tag(tag) || spectrum_object) {
            if (check_attributes(element, {"type"}, {"id", "name"}, faults_))
                read_object(node, element, file, parent);
            return;
        }
        if (is_property_tag(tag)) return read_property(node, element, file, parent);
        if (tag == "ref") read_reference(element, parent);
        else if (tag == "default") read_default(element);
        else if (tag == "alias") read_alias(element);
        else if (tag == "path") read_path(element, parent);
        else if (tag == "include") read_include(element, parent);
        else if (is_transform_operation(tag))
            faults_.add(element.place, element.label(), "only a <transform> can hold this operation", "");
        else
            faults_.add(element.place, "<" + tag + ">",
                        "unknown element; expected one of " + quoted_list(known_tags()),
                        suggestion(tag, known_tags()));
        refuse_children(node, element, file);
    }

    void refuse_children(const pugi::xml_node& node, const Element& element, const SourceFile& file) {
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element)
                faults_.add(file.place(child), element.label(),
                            std::string("<") + child.name() + "> cannot be nested here", "");
    }

    void read_object(const pugi::xml_node& node, const Element& element, const SourceFile& file, Object& parent) {
        Object& object = document_.objects.emplace_back();
        object.tag = element.tag;
        object.type = element.text("type");
        object.id = element.text("id");
        object.place = element.place;
        object.broken = element.broken;
        if (!object.id.empty() && !ids_.emplace(object.id, &object).second)
            faults_.add(object.place, object.label(),
                        "the id `" + object.id + "` is taken by line " +
                            std::to_string(ids_[object.id]->place.line) + " of " + *ids_[object.id]->place.file,
                        "give every object an id of its own");
        parent.children.push_back({element.text("name"), &object, "", object.place});
        if (++object_depth_ <= max_object_depth) read_children(node, file, object);
        else refuse_depth(object.place, object.label(), faults_);
        --object_depth_;
        if (legacy_) upgrade_object(object, document_.warnings);
    }

    void read_property(const pugi::xml_node& node, const Element& element, const SourceFile& file, Object& parent) {
        std::vector<Element> operations;
        if (element.tag == "transform") {
            for (const pugi::xml_node& child : node.children())
                if (child.type() == pugi::node_element) operations.push_back(make_element(child, file));
        } else {
            refuse_children(node, element, file);
        }
        const std::string name = element.text("name");
        const auto same = [&](const Property& property) { return property.name == name; };
        if (std::any_of(parent.properties.begin(), parent.properties.end(), same))
            return faults_.add(element.place, element.label(),
                               "the property is given more than once in " + parent.label(), "keep one of them");
        if (parent.properties.size() == max_properties)
            return faults_.add(element.place, element.label(), parent.label() + " has more than " + std::to_string(max_properties) + " properties", "");
        if (element.tag == "spectrum" && element.attribute("filename") != nullptr)
            parent.properties.push_back({name, read_spectrum_file(element), element.place});
        else parent.properties.push_back({name, parse_property(element, operations, faults_), element.place});
    }

    Value read_spectrum_file(const Element& element) {
        if (!check_attributes(element, {"name", "filename"}, {}, faults_) || element.broken) return Unreadable{};
        const std::string path = document_.find_file(element.text("filename"), element.place);
        if (path.empty()) {
            faults_.add(element.place, element.label(), "the file `" + element.text("filename") + "` does not exist",
                        "check the name, or add its folder with <path>");
            return Unreadable{};
        }
        try {
            return load_spd(path);
        } catch (const InputError& error) {
            faults_.add(error, element.place, element.label());
            return Unreadable{};
        }
    }

    void read_reference(const Element& element, Object& parent) {
        if (!check_attributes(element, {"id"}, {"name"}, faults_) || element.broken) return;
        if (element.text("id").empty())
            return faults_.add(element.place, element.label(), "the id is empty", "name the object that is meant");
        parent.children.push_back({element.text("name"), nullptr, element.text("id"), element.place});
    }

    void read_default(const Element& element) {
        if (!check_attributes(element, {"name", "value"}, {}, faults_)) return;
        if (element.text("name").empty())
            return faults_.add(element.place, element.label(), "the name is empty", "name the parameter");
        substitution_.set_default(element.text("name"), element.text("value"));
    }

    void read_alias(const Element& element) {
        if (!check_attributes(element, {"id", "as"}, {}, faults_)) return;
        const auto source = ids_.find(element.text("id"));
        if (source == ids_.end())
            return faults_.add(element.place, "<alias>",
                               "no object before this line has the id `" + element.text("id") + "`",
                               "place the alias behind the object");
        if (!ids_.emplace(element.text("as"), source->second).second)
            faults_.add(element.place, "<alias>", "the id `" + element.text("as") + "` is taken", "choose another");
    }

    void read_path(const Element& element, const Object& parent) {
        if (!check_attributes(element, {"value"}, {}, faults_)) return;
        if (&parent != document_.root)
            return faults_.add(element.place, "<path>", "only the scene itself can hold a search path",
                               "move it up");
        const std::string folder = document_.find_file(element.text("value"), element.place);
        if (folder.empty())
            return faults_.add(element.place, "<path>", "the folder `" + element.text("value") + "` does not exist",
                               "");
        document_.search_folders.insert(document_.search_folders.begin(), folder);
    }

    void read_include(const Element& element, Object& parent) {
        if (!check_attributes(element, {"filename"}, {"name"}, faults_) || element.broken) return;
        // The folder of the including file comes before the search path.
        const fs::path beside = fs::path(*element.place.file).parent_path() / element.text("filename");
        const std::string path = fs::is_regular_file(beside)
                                     ? beside.string()
                                     : document_.find_file(element.text("filename"), element.place);
        if (path.empty())
            return faults_.add(element.place, "<include>",
                               "the file `" + element.text("filename") + "` does not exist",
                               "check the name, or add its folder with <path>");
        const std::size_t first = parent.children.size();
        read_file_into(path, &parent, element.place);
        // The name belongs to the one object of a file that is no scene.
        if (element.attribute("name") != nullptr && parent.children.size() == first + 1)
            parent.children[first].name = element.text("name");
    }

    Document& document_;
    Faults& faults_;
    Substitution substitution_;
    std::map<std::string, Object*> ids_;
    std::vector<std::string> open_files_;
    std::size_t object_depth_ = 0;
    std::size_t includes_ = 0;
    bool legacy_ = false;  // the file that is being read is of Mitsuba 0.x
};

}  // namespace

std::string Object::label() const {
    return tag + (tag == type ? "" : "[" + type + "]") + (id.empty() ? "" : " \"" + id + "\"");
}

std::string Document::find_file(const std::string& name, const Place& place) const {
    const fs::path path(name);
    std::vector<fs::path> candidates;
    if (path.is_absolute()) {
        candidates.push_back(path);
    } else {
        for (const std::string& folder : search_folders) candidates.push_back(fs::path(folder) / path);
        if (place.file != nullptr) candidates.push_back(fs::path(*place.file).parent_path() / path);
    }
    for (const fs::path& candidate : candidates)
        if (!name.empty() && fs::exists(candidate)) return candidate.string();
    return {};
}

std::unique_ptr<Document> read_document(const std::string& path, const Definitions& definitions, Faults& faults) {
    auto document = std::make_unique<Document>();
    DocumentReader(*document, definitions, faults).read(path);
    return document;
}

}  // namespace wavelobe::mitsuba
