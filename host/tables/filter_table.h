// The table by which film positions are drawn in proportion to a reconstruction filter.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace wavelobe {

// Inverse of one tail of the filter along one axis: entry i is the distance from the pixel centre, in pixels, beyond which
// lies the share (i / FILTER_TABLE_CELLS)^2 of the filter, from the radius for i = 0 to 0 for i = FILTER_TABLE_CELLS.
// Squares, because filters that reach zero linearly have tails like the square of the distance to their end. With the
// share interpolated linearly between entries, the density is constant between them: exact for the box; for the others
// the distribution function is off by 1.5e-6 at most, and the variance by 1.5e-5 of itself.
//
// Filters that are negative somewhere are drawn from by their absolute value, and what follows the entries is for each cell what
// a sample in it counts along one axis: its share of the filter over its share of the absolute value, so that the product over
// both axes has mean one and the picture no bias. The price is variance: the weights are near +-c, with c the integral of the
// absolute value over that of the filter (1.07 for mitchell, 1.17 for catmullrom, 1.36 for lanczos with three lobes).
//
// Gaussian: max(0, exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2)), Mitsuba's: it reaches zero at the radius.
std::vector<float> build_filter_table(const ReconstructionFilter& filter);

}  // namespace wavelobe
