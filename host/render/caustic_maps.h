// Which parts of the caustic grid have a map of directions, and how many samples follow it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/caustics.h"

namespace wavelobe {

// Enters into `cells` the number of each cell's map plus one, by the photons that arrived in each. A cell with few of them shares a map
// with its neighbours, a cube of 2, 4 or 8 cells a side. Returns the side of each map's cube.
std::vector<std::uint32_t> choose_caustic_maps(const CausticGrid& grid, std::span<const std::uint32_t> counts, std::span<std::uint32_t> cells);

// Sums of the photons of a map: flux a bin, and flux times radiance, as caustics/photons.h keeps them.
struct CausticSums {
    std::span<const std::uint64_t> bins;
    std::uint64_t square;
};

// The share of samples that had best follow a map, 0 where the lobes' own samples do as well.
double best_caustic_share(const CausticGrid& grid, const CausticSums& sums, std::uint32_t side);

}  // namespace wavelobe
