// The objects of a scene file and of what it includes: elements with their substitutions done, their
// values parsed and their references resolved, but with no meaning attached yet.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "scene/mitsuba/faults.h"
#include "scene/mitsuba_reader.h"
#include "scene/spectrum.h"

namespace wavelobe::mitsuba {

struct Colour {
    glm::dvec3 rgb{0.0};
};

struct UniformSpectrum {
    double value = 0.0;
};

// A value that could not be read: its fault is on record, whoever asks gets the default.
struct Unreadable {};

using Value = std::variant<Unreadable, double, std::int64_t, bool, std::string, glm::dvec3, Colour, UniformSpectrum,
                           SampledSpectrum, glm::dmat4>;

struct Property {
    std::string name;
    Value value;
    Place place;
};

struct Object;

struct Child {
    std::string name;          // empty: not named in the file
    Object* object = nullptr;  // null: a reference that does not resolve
    std::string reference;     // id, empty: nested in place
    Place place;
};

struct Object {
    std::string tag;   // such as `shape`
    std::string type;  // such as `obj`
    std::string id;
    Place place;
    std::vector<Property> properties;
    std::vector<Child> children;
    bool broken = false;  // its type could not be read; the fault is on record
    bool legacy = false;  // of a file of Mitsuba 0.x: what is unknown there is passed over

    std::string label() const;  // `shape[obj] "id"`
};

struct Document {
    std::deque<std::string> files;  // names, the scene itself first
    std::deque<Object> objects;
    Object* root = nullptr;
    std::vector<Fault> warnings;
    std::vector<std::string> search_folders;  // where relative file names are looked up, in order

    // The first existing file of that relative or absolute name; empty when there is none.
    std::string find_file(const std::string& name, const Place& place) const;
};

std::unique_ptr<Document> read_document(const std::string& path, const Definitions& definitions, Faults& faults);

}  // namespace wavelobe::mitsuba
