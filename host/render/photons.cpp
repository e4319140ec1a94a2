#include "render/photons.h"

#include <algorithm>
#include <bit>
#include <numbers>
#include <span>

#include "shared/block.h"

namespace wavelobe {
namespace {

// Fewer say nothing of where more would come from.
constexpr std::uint32_t least_photons = 12;
// Shares of samples come in steps of one in so many; the lobes keep two steps, for what the map does not know of.
constexpr int share_steps = 16, most_steps = 14;
// What lobes bring besides: the second moment of their samples, as a share of the square of the scene's mean irradiance.
constexpr double other_moment = 16.0;

// The cells with most photons, which are to have a map.
std::vector<std::size_t> choose_cells(const DeviceBuffers& buffers) {
    const auto counts = buffers.view<std::uint32_t>("caustic_counts");
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] >= least_photons) chosen.push_back(i);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) { return counts[a] > counts[b]; });
    if (chosen.size() > CAUSTIC_MAPS) chosen.resize(CAUSTIC_MAPS);
    return chosen;
}

// Second moments of what one sample of a white surface brings of a cell's caustics, in the square of an irradiance.
struct CausticMoments {
    double of_lobes;  // a cosine-distributed sample
    double of_map;
};

CausticMoments caustic_moments(std::span<const std::uint64_t> bins, double flux_unit, double square, double inverse_area) {
    double sum = 0.0, squares = 0.0;
    for (const std::uint64_t b : bins) {
        sum += static_cast<double>(b);
        squares += static_cast<double>(b) * static_cast<double>(b);
    }
    const double irradiance = sum * flux_unit * inverse_area;
    const double of_lobes = std::numbers::pi * square * inverse_area;
    // The solid angle that light of one radiance fills is pi irradiance^2 / of_lobes; the map spreads samples over whole bins.
    const double spread = sum * sum / squares * (4.0 * std::numbers::pi / CAUSTIC_BINS);
    return {of_lobes, std::max(irradiance * irradiance, of_lobes * spread / std::numbers::pi)};
}

// The share of samples that the map had best take: mixed, the two find caustics of one radiance with the moment
// 1 / (lobes' share / lobes' moment + map's share / map's moment), and everything else with that of the lobes over their share.
double best_share(const CausticMoments& m, double other) {
    if (!(m.of_map > 0.0)) return 0.0;
    double best = m.of_lobes + other, share = 0.0;
    for (int step = 1; step <= most_steps; ++step) {
        const double s = static_cast<double>(step) / share_steps;
        const double moment = 1.0 / ((1.0 - s) / m.of_lobes + s / m.of_map) + other / (1.0 - s);
        if (moment < best) best = moment, share = s;
    }
    return share;
}

// Enters the share of samples that each map takes; cells whose lobes find the light well enough lose theirs. A cell's surface
// is taken to be as large as a side of it.
void share_samples(const DeviceBuffers& buffers, const CausticGrid& grid, const std::vector<std::size_t>& chosen) {
    const auto sums = buffers.view<std::uint64_t>("caustic_sums");
    const auto squares = buffers.view<std::uint64_t>("caustic_squares");
    const auto cells = buffers.view<std::uint32_t>("caustic_cells");
    const auto maps = buffers.view<float>("caustic_maps");
    const auto value = [](std::uint32_t bits) { return static_cast<double>(std::bit_cast<float>(bits)); };
    const double photons = static_cast<double>(grid.batches) * PHOTONS_A_BATCH;
    const double flux_unit = value(grid.greatest_flux) * 0x1p-32 / photons;
    const double inverse_area = static_cast<double>(grid.inverse_step) * static_cast<double>(grid.inverse_step);
    const auto irradiance = static_cast<double>(grid.mean_irradiance);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const double square = static_cast<double>(squares[i]) * flux_unit * value(grid.greatest_radiance);
        const CausticMoments moments =
            caustic_moments({sums.data() + i * CAUSTIC_BINS, CAUSTIC_BINS}, flux_unit, square, inverse_area);
        const double share = best_share(moments, other_moment * irradiance * irradiance);
        maps[i * CAUSTIC_MAP_FLOATS + CAUSTIC_SHARE] = static_cast<float>(share);
        if (share == 0.0) cells[chosen[i]] = 0;
    }
}

}  // namespace

PhotonPass::PhotonPass(const Device& device, DeviceBuffers& buffers, const Program& program)
    : device_(device), buffers_(buffers), shoot_(program, "shoot_photons"), build_(program, "build_caustic_maps") {
    shoot_.bind(buffers_.table());
    build_.bind(buffers_.table());
    // PoCL generates a kernel's code at its first launch: done here, with no photon left to shoot and a map of none.
    grid().next_batch = grid().batches;
    run(shoot_, 1);
    run(build_, 1);
}

void PhotonPass::run(Kernel& kernel, std::size_t items) const {
    kernel.launch(device_, items);
    device_.finish();
}

// Shoots the same photons again, now into the maps of these cells.
void PhotonPass::record(const std::vector<std::size_t>& chosen) {
    const auto cells = buffers_.view<std::uint32_t>("caustic_cells");
    for (std::size_t i = 0; i < chosen.size(); ++i) cells[chosen[i]] = static_cast<std::uint32_t>(i + 1);
    grid().recording = 1;
    grid().next_batch = 0;
    run(shoot_, buffers_.view<BlockHeader>("headers").size());
    run(build_, chosen.size());
    share_samples(buffers_, grid(), chosen);
}

void PhotonPass::shoot() {
    grid().next_batch = 0;
    run(shoot_, buffers_.view<BlockHeader>("headers").size());
    const std::vector<std::size_t> chosen = choose_cells(buffers_);
    if (!chosen.empty()) record(chosen);
    for (const char* name : {"caustic_targets", "caustic_counts", "caustic_sums", "caustic_squares"}) buffers_.remove(name);
}

}  // namespace wavelobe
