// The principled BSDF plugins.
#pragma once

#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

Bsdf read_principled(Query& query);
Bsdf read_principled_thin(Query& query);

}  // namespace wavelobe::mitsuba
