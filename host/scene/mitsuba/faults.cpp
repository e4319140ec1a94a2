// Places in scene files, and the faults found there.
#include "scene/mitsuba/faults.h"

#include <algorithm>
#include <utility>

namespace wavelobe::mitsuba {

void Faults::add(const Place& place, std::string element, std::string message, std::string hint) {
    add({place.file == nullptr ? "" : *place.file, place.line, place.column, std::move(element), std::move(message),
         std::move(hint)});
}

void Faults::add(const InputError& error, const Place& place, const std::string& element) {
    const std::string used = "used at " + *place.file + ":" + std::to_string(place.line) + " by " + element;
    for (Fault fault : error.faults()) {
        fault.hint += (fault.hint.empty() ? "" : "; ") + used;
        add(std::move(fault));
    }
}

void Faults::add(Fault fault) {
    const std::string text = fault.text();
    if (std::any_of(list_.begin(), list_.end(), [&](const Fault& other) { return other.text() == text; })) return;
    list_.push_back(std::move(fault));
}

}  // namespace wavelobe::mitsuba
