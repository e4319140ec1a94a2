// Drives blocks through the stages until the picture is made.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "cl/program.h"
#include "render/device_buffers.h"
#include "render/render.h"
#include "render/scheduler.h"
#include "render/stage_timer.h"

namespace wavelobe {

// What drivers share. The buffers are those of the scene; each driver adds its own.
struct RenderContext {
    const Device& device;
    const FeatureSet& features;
    DeviceBuffers& buffers;
    TileScheduler& scheduler;
    StageTimer& timer;
    RenderStats& stats;
    int block_slots;
};

class BlockDriver {
public:
    virtual ~BlockDriver() = default;

    // Makes the kernels ready for their first launch.
    virtual void prepare(const Program& program) = 0;

    // Some more of the picture: as much as the host may leave unattended, a fraction of a second, and no more than `seconds`
    // as far as the driver can tell.
    virtual void step(double seconds) = 0;

    // Until the device has finished.
    virtual void wait() {}
};

// A launch a stage and round, over many blocks. The host reads the blocks' counts once a round and launches only stages
// that have something to do.
std::unique_ptr<BlockDriver> make_staged_driver(const RenderContext& context);

// One launch for all stages of many tiles, a work-item a compute thread.
std::unique_ptr<BlockDriver> make_one_kernel_driver(const RenderContext& context);

// One path of the block that holds it, into `RenderStats::replay`. One step, and nothing gets into the film.
std::unique_ptr<BlockDriver> make_replay_driver(const RenderContext& context, const SampleName& sample);

// Takes note of a path whose sample was not finite (WAVELOBE_NONE: none) and of the stage that made it so, for the first few.
void note_nonfinite(RenderStats& stats, const TileRange& range, std::uint32_t path, std::uint32_t stage);

}  // namespace wavelobe
