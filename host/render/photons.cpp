#include "render/photons.h"

#include "render/caustic_maps.h"
#include "shared/block.h"

namespace wavelobe {

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

// All batches, the same photons each time.
void PhotonPass::shoot_all() {
    grid().next_batch = 0;
    run(shoot_, buffers_.view<BlockHeader>("headers").size());
}

// Enters the share of samples that each map takes, by the sides of its cube; where that is none, cells lose their map.
void PhotonPass::share_samples(const std::vector<std::uint32_t>& sides) {
    const auto sums = buffers_.view<std::uint64_t>("caustic_sums");
    const auto squares = buffers_.view<std::uint64_t>("caustic_squares");
    const auto maps = buffers_.view<float>("caustic_maps");
    const auto share = [&](std::size_t map) -> float& { return maps[map * CAUSTIC_MAP_FLOATS + CAUSTIC_SHARE]; };
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const CausticSums of_map{{sums.data() + i * CAUSTIC_BINS, CAUSTIC_BINS}, squares[i]};
        share(i) = static_cast<float>(best_caustic_share(grid(), of_map, sides[i]));
    }
    for (std::uint32_t& cell : buffers_.view<std::uint32_t>("caustic_cells")) {
        if (cell != 0 && share(cell - 1) == 0.0F) cell = 0;
    }
}

void PhotonPass::shoot() {
    shoot_all();
    const std::vector<std::uint32_t> sides =
        choose_caustic_maps(grid(), buffers_.view<std::uint32_t>("caustic_counts"), buffers_.view<std::uint32_t>("caustic_cells"));
    if (!sides.empty()) {
        grid().recording = 1;
        shoot_all();
        run(build_, sides.size());
        share_samples(sides);
    }
    for (const char* name : {"caustic_targets", "caustic_counts", "caustic_sums", "caustic_squares"}) buffers_.remove(name);
}

}  // namespace wavelobe
