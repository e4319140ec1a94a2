// Typed access to a glTF document: what is of the wrong kind or out of range becomes a fault with its JSON path.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/fault.h"

namespace wavelobe::gltf {

using Json = nlohmann::json;

// Faults found so far; reading goes on after a fault so that one run shows all of them.
class Faults {
public:
    explicit Faults(std::string file) : file_(std::move(file)) {}

    // The text in which faults look up the lines of their paths; it must outlive them.
    void set_text(std::string_view text) { text_ = text; }

    void add(const std::string& path, std::string message, std::string hint = "");
    // Faults of a file that the document names at `path`.
    void add(const InputError& error, const std::string& path);
    bool empty() const { return list_.empty(); }
    std::size_t size() const { return list_.size(); }
    // All of them; beyond the first hundred, their number.
    [[noreturn]] void raise() const;

private:
    void add(Fault fault);

    std::string file_;
    std::string_view text_;
    std::vector<Fault> list_;
    std::unordered_set<std::string> known_;  // their texts
    std::size_t left_out_ = 0;
};

struct NumberRange {
    double least = -std::numeric_limits<float>::max();
    double greatest = std::numeric_limits<float>::max();
};

// A value of the document, or the absence of one: an absent element has no members, and defaults for all values.
class Element {
public:
    Element(const Json* value, std::string path, Faults* faults) : value_(value), path_(std::move(path)), faults_(faults) {}

    bool present() const { return value_ != nullptr; }
    const Json* json() const { return value_; }  // null: absent
    const std::string& path() const { return path_; }
    void fault(const std::string& message, const std::string& hint = "") const { faults_->add(path_, message, hint); }

    bool has(const char* name) const { return find(name) != nullptr; }
    // Absent where the document has no such member, and, after a fault, where it is something else.
    Element object(const char* name) const;
    std::vector<Element> objects(const char* name) const;
    std::vector<double> numbers(const char* name) const;
    std::vector<std::int64_t> whole_numbers(const char* name) const;
    std::vector<std::string> texts(const char* name) const;
    Element extension(const char* name) const { return object("extensions").object(name); }

    double number(const char* name, double fallback, NumberRange range = {}) const;
    std::optional<double> number(const char* name) const;
    std::int64_t whole(const char* name, std::int64_t fallback, std::int64_t least, std::int64_t greatest) const;
    bool flag(const char* name, bool fallback) const;
    std::string text(const char* name, const std::string& fallback = "") const;
    // A reference to one of `count` things called `what`; nothing where it is absent or, after a fault, out of range.
    std::optional<std::size_t> index(const char* name, std::size_t count, const char* what) const;
    std::vector<std::size_t> indices(const char* name, std::size_t count, const char* what) const;
    void require(const char* name) const;
    void refuse_empty(const char* list) const;

    template <std::size_t N>
    std::array<float, N> vector(const char* name, const std::array<float, N>& fallback, NumberRange range = {}) const {
        std::array<float, N> out = fallback;
        if (!has(name)) return out;
        const std::vector<double> values = numbers(name);
        if (!check_vector(name, values, N, range)) return fallback;
        for (std::size_t i = 0; i < N; ++i) out[i] = static_cast<float>(values[i]);
        return out;
    }

    // The keys of an object with whole numbers for values, as `attributes` has.
    std::vector<std::string> keys() const;

private:
    const Json* find(const char* name) const;
    const Json* array(const char* name) const;
    std::string child(const char* name) const { return path_ + "/" + name; }
    bool check_vector(const char* name, const std::vector<double>& values, std::size_t length, NumberRange range) const;

    const Json* value_;
    std::string path_;
    Faults* faults_;
};

// `5 numbers`, `the string "..."`: what stands where something else was expected.
std::string describe(const Json& value);

}  // namespace wavelobe::gltf
