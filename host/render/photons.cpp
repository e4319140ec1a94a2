#include "render/photons.h"

#include <algorithm>
#include <bit>
#include <numbers>
#include <vector>

namespace wavelobe {
namespace {

// Fewer say nothing of where more would come from.
constexpr std::uint32_t least_photons = 12;
// What a sample of the lobes alone adds to the squared relative error, at the least, for guiding to be worth the other samples it takes.
constexpr double least_variance = 10.0;

// Gives the cells with most photons a map.
std::vector<std::size_t> choose_cells(const DeviceBuffers& buffers) {
    const auto counts = buffers.view<std::uint32_t>("caustic_counts");
    const auto cells = buffers.view<std::uint32_t>("caustic_cells");
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] >= least_photons) chosen.push_back(i);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) { return counts[a] > counts[b]; });
    if (chosen.size() > CAUSTIC_MAPS) chosen.resize(CAUSTIC_MAPS);
    for (std::size_t i = 0; i < chosen.size(); ++i) cells[chosen[i]] = static_cast<std::uint32_t>(i + 1);
    return chosen;
}

// Takes their map from cells where samples of the lobes find the light well enough: what these add to the squared relative error is
// about pi times the integral of the squared radiance over the square of the irradiance, the scene's mean for that of the cell, whose
// surface is taken to be as large as a side of it.
void drop_easy_cells(const DeviceBuffers& buffers, const std::vector<std::size_t>& chosen) {
    const CausticGrid& grid = buffers.view<CausticGrid>("caustic_grid")[0];
    const auto squares = buffers.view<std::uint64_t>("caustic_squares");
    const auto cells = buffers.view<std::uint32_t>("caustic_cells");
    const auto value = [](std::uint32_t bits) { return static_cast<double>(std::bit_cast<float>(bits)); };
    const double unit = value(grid.greatest_flux) * value(grid.greatest_radiance) * 0x1p-32 / (static_cast<double>(grid.batches) * PHOTONS_A_BATCH);
    const double per_area = static_cast<double>(grid.inverse_step) * static_cast<double>(grid.inverse_step);
    const auto mean_irradiance = static_cast<double>(grid.mean_irradiance);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const double square = static_cast<double>(squares[i]) * unit * per_area;
        const double variance = std::numbers::pi * square / (mean_irradiance * mean_irradiance);
        if (!(variance >= least_variance)) cells[chosen[i]] = 0;
    }
}

void fill_maps(const RenderContext& context, const Program& program, std::size_t work_items) {
    const DeviceBuffers& buffers = context.buffers;
    Kernel shoot(program, "shoot_photons"), build(program, "build_caustic_maps");
    shoot.bind(buffers.table());
    build.bind(buffers.table());
    const auto run = [&](Kernel& kernel, std::size_t items) {
        kernel.launch(context.device, items);
        context.device.finish();
    };
    run(shoot, work_items);
    const std::vector<std::size_t> chosen = choose_cells(buffers);
    if (chosen.empty()) return;
    CausticGrid& grid = buffers.view<CausticGrid>("caustic_grid")[0];
    grid.next_batch = 0;
    grid.recording = 1;
    run(shoot, work_items);
    run(build, chosen.size());
    drop_easy_cells(buffers, chosen);
}

}  // namespace

void shoot_photons(const RenderContext& context, const Program& program, std::size_t work_items) {
    if (!context.features.caustics) return;
    fill_maps(context, program, work_items);
    for (const char* name : {"caustic_targets", "caustic_counts", "caustic_sums", "caustic_squares"}) context.buffers.remove(name);
}

}  // namespace wavelobe
