#include "render/caustic_maps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numbers>

namespace wavelobe {
namespace {

// Fewer say nothing of where more would come from.
constexpr std::uint64_t least_photons = 12;
constexpr std::array<std::uint32_t, 4> cube_sides = {1, 2, 4, 8};
constexpr std::array<double, 18> shares = {1.0 / 64, 1.0 / 32, 3.0 / 64, 1.0 / 16, 3.0 / 32, 0.125,  0.1875, 0.25,   0.3125,
                                           0.375,    0.4375,   0.5,      0.5625,   0.625,    0.6875, 0.75,   0.8125, 0.875};
// What lobes bring besides: the second moment of their samples, as a share of the square of the scene's mean irradiance.
constexpr double other_moment = 16.0;

// The cubes of so many cells a side that a grid falls into.
struct Cubes {
    const CausticGrid& grid;
    std::uint32_t side;

    std::size_t along(int axis) const { return (grid.size[axis] + side - 1) / side; }
    std::size_t count() const { return along(0) * along(1) * along(2); }
    std::size_t of_cell(std::size_t cell) const {
        const std::size_t x = cell % grid.size[0], y = cell / grid.size[0] % grid.size[1], z = cell / grid.size[0] / grid.size[1];
        return (z / side * along(1) + y / side) * along(0) + x / side;
    }
};

// The cubes with enough photons, those with most of them first.
std::vector<std::size_t> lit_cubes(const std::vector<std::uint64_t>& photons, std::size_t most) {
    std::vector<std::size_t> lit;
    for (std::size_t i = 0; i < photons.size(); ++i) {
        if (photons[i] >= least_photons) lit.push_back(i);
    }
    std::ranges::stable_sort(lit, [&](std::size_t a, std::size_t b) { return photons[a] > photons[b]; });
    if (lit.size() > most) lit.resize(most);
    return lit;
}

// Second moments of what one sample of a white surface brings of a map's caustics, in the square of an irradiance.
struct CausticMoments {
    double of_lobes;  // a cosine-distributed sample
    double of_map;
};

// A cube's surface is taken to be as large as a side of it.
CausticMoments caustic_moments(const CausticGrid& grid, const CausticSums& sums, std::uint32_t side) {
    const auto value = [](std::uint32_t bits) { return static_cast<double>(std::bit_cast<float>(bits)); };
    const double length = static_cast<double>(side) / static_cast<double>(grid.inverse_step);
    const double unit = value(grid.greatest_flux) * 0x1p-32 / (static_cast<double>(grid.batches) * PHOTONS_A_BATCH * length * length);
    double sum = 0.0, squares = 0.0;
    for (const std::uint64_t bin : sums.bins) {
        sum += static_cast<double>(bin);
        squares += static_cast<double>(bin) * static_cast<double>(bin);
    }
    const double irradiance = sum * unit;
    const double of_lobes = std::numbers::pi * static_cast<double>(sums.square) * unit * value(grid.greatest_radiance);
    // The solid angle that light of one radiance fills is pi irradiance^2 / of_lobes; the map spreads samples over whole bins.
    const double spread = sum * sum / squares * (4.0 * std::numbers::pi / CAUSTIC_BINS);
    return {of_lobes, std::max(irradiance * irradiance, of_lobes * spread / std::numbers::pi)};
}

}  // namespace

std::vector<std::uint32_t> choose_caustic_maps(const CausticGrid& grid, std::span<const std::uint32_t> counts, std::span<std::uint32_t> cells) {
    std::vector<std::uint32_t> sides;
    std::ranges::fill(cells, 0U);
    for (const std::uint32_t side : cube_sides) {
        const Cubes cubes{grid, side};
        std::vector<std::uint64_t> photons(cubes.count(), 0);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (cells[i] == 0) photons[cubes.of_cell(i)] += counts[i];
        }
        std::vector<std::uint32_t> map_of_cube(cubes.count(), 0);
        for (const std::size_t cube : lit_cubes(photons, CAUSTIC_MAPS - sides.size())) {
            sides.push_back(side);
            map_of_cube[cube] = static_cast<std::uint32_t>(sides.size());
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (cells[i] == 0) cells[i] = map_of_cube[cubes.of_cell(i)];
        }
    }
    return sides;
}

// Mixed, map and lobes find caustics of one radiance with the moment 1 / (lobes' share / lobes' moment + map's share / map's moment), and
// lobes everything else with its moment over their share.
double best_caustic_share(const CausticGrid& grid, const CausticSums& sums, std::uint32_t side) {
    const CausticMoments m = caustic_moments(grid, sums, side);
    if (!(m.of_map > 0.0)) return 0.0;
    const auto irradiance = static_cast<double>(grid.mean_irradiance);
    const double other = other_moment * irradiance * irradiance;
    double best = m.of_lobes + other, best_share = 0.0;
    for (const double share : shares) {
        const double moment = 1.0 / ((1.0 - share) / m.of_lobes + share / m.of_map) + other / (1.0 - share);
        if (moment < best) best = moment, best_share = share;
    }
    return best_share;
}

}  // namespace wavelobe
