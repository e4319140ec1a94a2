// How wide a camera or projector sees.
#pragma once

#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

// The horizontal angle that `fov` with `fov_axis`, or `focal_length`, gives a picture of that width over height.
float horizontal_degrees(Query& query, double aspect);

}  // namespace wavelobe::mitsuba
