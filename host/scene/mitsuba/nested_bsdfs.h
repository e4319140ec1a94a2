// BSDF plugins that hold others, and the one that is not there.
#pragma once

#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

Bsdf read_blend(Query& query);
Bsdf read_bump_map(Query& query);
Bsdf read_mask(Query& query);
Bsdf read_normal_map(Query& query);
Bsdf read_null(Query& query);
Bsdf read_twosided(Query& query);

}  // namespace wavelobe::mitsuba
