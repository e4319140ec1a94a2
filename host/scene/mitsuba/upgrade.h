// Scenes of Mitsuba 0.x, brought to the names of Mitsuba 3 while they are read.
#pragma once

#include <string>

#include "scene/mitsuba/elements.h"

namespace wavelobe::mitsuba {

// `toWorld` becomes `to_world`, `intIOR` `int_ior`.
std::string snake_case(const std::string& name);

// The element's tag and its `name`, as Mitsuba 3 calls them; colours get the form its elements have.
void upgrade_element(Element& element);

// An object whose properties and children are complete: plugins and properties that have changed names.
// What now does the same in another way is said in `warnings`.
void upgrade_object(Object& object, std::vector<Fault>& warnings);

}  // namespace wavelobe::mitsuba
