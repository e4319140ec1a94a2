// Finds out with photons where caustics come from, before the first sample.
#pragma once

#include "render/driver.h"

namespace wavelobe {

// Fills the maps of scenes with caustics. The driver has its blocks; `work_items` of them are used.
void shoot_photons(const RenderContext& context, const Program& program, std::size_t work_items);

}  // namespace wavelobe
