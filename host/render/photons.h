// Finds out with photons where caustics come from, before the first sample.
#pragma once

#include "cl/program.h"
#include "render/device_buffers.h"

namespace wavelobe {

class PhotonPass {
public:
    // Makes the kernels ready for their first launch. `buffers` are those of a scene with caustics, and have the blocks of a driver.
    PhotonPass(const Device& device, DeviceBuffers& buffers, const Program& program);

    // Fills the scene's maps, once, and gives the sums back that they are made of.
    void shoot();

private:
    CausticGrid& grid() const { return buffers_.view<CausticGrid>("caustic_grid")[0]; }
    void run(Kernel& kernel, std::size_t items) const;
    void shoot_all();
    void share_samples(const std::vector<std::uint32_t>& sides);

    const Device& device_;
    DeviceBuffers& buffers_;
    Kernel shoot_, build_;
};

}  // namespace wavelobe
