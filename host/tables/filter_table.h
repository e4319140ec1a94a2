// Inverse distributions of pixel filters, for filter importance sampling (Ernst, Stamminger, Greiner 2006).
#pragma once

#include <vector>

#include "scene/scene.h"

namespace wavelobe {

// FILTER_STEPS + 1 offsets from the pixel's centre, in pixels, at equal steps of probability (kernels/sampling/warps.h).
// The box comes out exact; others are piecewise constant densities that follow the filter to within a step.
std::vector<float> build_filter_table(const ReconstructionFilter& filter);

}  // namespace wavelobe
