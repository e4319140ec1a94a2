// Where photons are aimed that find out where caustics come from.
#pragma once

#include "render/flatten_lights.h"

namespace wavelobe {

// Which surfaces have delta lobes, and the grid about them; nothing where no path could find a caustic: without such surfaces or
// diffuse ones, or without lights that paths can hit. `bounds` are those of the scene.
void flatten_caustics(DeviceScene& out, const Bounds& bounds, const LightFlattener& lights);

// Photons in proportion to the samples of the picture, a sixteenth of them, within limits. The same for each window of it.
void set_photon_count(DeviceScene& scene, std::uint64_t samples);

std::size_t caustic_cells(const CausticGrid& grid);

// Of its buffers.
std::uint64_t caustic_bytes(const CausticGrid& grid);

}  // namespace wavelobe
