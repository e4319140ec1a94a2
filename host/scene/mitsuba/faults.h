// Places in scene files, and the faults found there.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "scene/fault.h"

namespace wavelobe::mitsuba {

struct Place {
    const std::string* file = nullptr;  // owned by the Document
    int line = 0;
    int column = 0;
};

// Faults found so far, each once; reading goes on after a fault so that one run shows all of them. Where there are more than
// anyone reads, it ends: `add` throws them.
class Faults {
public:
    void add(const Place& place, std::string element, std::string message, std::string hint = "");
    // Faults of another file, and who uses it.
    void add(const InputError& error, const Place& place, const std::string& element);
    void add(Fault fault);
    std::vector<Fault>& list() { return list_; }
    bool empty() const { return list_.empty(); }

private:
    std::vector<Fault> list_;
    std::set<std::string> texts_;
};

}  // namespace wavelobe::mitsuba
