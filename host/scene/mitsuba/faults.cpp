// Places in scene files, and the faults found there.
#include "scene/mitsuba/faults.h"

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
    constexpr std::size_t most = 1000;
    if (!texts_.insert(fault.text()).second) return;
    list_.push_back(std::move(fault));
    if (list_.size() < most) return;
    list_.push_back({list_.front().file, 0, 0, "", "has more faults than these " + std::to_string(most), "correct them first"});
    throw InputError(std::move(list_));
}

}  // namespace wavelobe::mitsuba
