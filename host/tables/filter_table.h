// The table by which film positions are drawn in proportion to a reconstruction filter.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace wavelobe {

// Inverse distribution function of the filter along one axis, in pixels from the pixel centre, at i / FILTER_TABLE_CELLS
// for i from 0 to FILTER_TABLE_CELLS: increasing from -radius to radius, odd about the middle. Linear between entries, it
// is exact for the box; for the others its distribution function is off by 2.5e-4 at most, in the outermost cells, and
// by less than 1e-6 inside half the radius.
//
// Gaussian: max(0, exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2)), Mitsuba's: it reaches zero at the radius.
std::vector<float> build_filter_table(const ReconstructionFilter& filter);

}  // namespace wavelobe
