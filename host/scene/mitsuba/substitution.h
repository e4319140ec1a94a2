// $name parameters of scene files.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/mitsuba_reader.h"

namespace wavelobe::mitsuba {

class Substitution {
public:
    explicit Substitution(const Definitions& definitions);

    // What <default> states holds for names that no definition has set.
    void set_default(const std::string& name, const std::string& value);

    // The text with every $name replaced, \$ standing for the dollar sign. Names that are not defined go
    // to `undefined` and leave nothing behind. Throws std::length_error where parameters that hold others grow without measure.
    std::string apply(std::string_view text, const std::function<void(const std::string&)>& undefined);

    // Definitions that have replaced nothing so far.
    std::vector<std::string> unused() const;

private:
    struct Parameter {
        std::string value;
        bool used = false;
    };

    // Appends the value of the name that `rest` starts with; returns how many characters the name takes.
    std::size_t replace(std::string_view rest, std::string& result,
                        const std::function<void(const std::string&)>& undefined);

    std::map<std::string, Parameter, std::less<>> parameters_;
    std::size_t replaced_ = 0;  // characters that came in so far
};

}  // namespace wavelobe::mitsuba
