// References between the objects of a document.
#pragma once

#include <map>
#include <string>

#include "scene/mitsuba/document.h"

namespace wavelobe::mitsuba {

// Of objects in objects, by nesting and by reference: far beyond any scene, and no strain on the stack.
constexpr std::size_t max_object_depth = 64;

void refuse_depth(const Place& place, const std::string& label, Faults& faults);

// Lets references point to their objects. Those that lead nowhere, in a circle or too deep are faults and point to none.
void resolve_references(Document& document, const std::map<std::string, Object*>& ids, Faults& faults);

}  // namespace wavelobe::mitsuba
