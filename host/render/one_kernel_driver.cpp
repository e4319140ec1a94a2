#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "render/driver.h"

namespace wavelobe {
namespace {

// How long a launch should take: long enough that the wait for its last tile is small against it, short enough for
// progress and interrupts.
constexpr double launch_seconds = 0.4;
// Tiles a compute thread in a launch, at the least: the last one's wait is a share of all.
constexpr std::size_t least_tiles_per_thread = 16;

class OneKernelDriver final : public BlockDriver {
public:
    explicit OneKernelDriver(const RenderContext& context)
        : context_(context), threads_(std::max(context.device.info().compute_units, 1U)) {
        DeviceBuffers& buffers = context_.buffers;
        buffers.add_blocks(threads_, block_words(context.features, context.block_slots));
        buffers.add_zeros<TileQueue>("tile_queue", 1);
        buffers.add_zeros<TileJob>("tile_jobs", context.scheduler.tile_count());
        buffers.add_zeros<StageCounters>("stage_counters", threads_ * STAGE_COUNT);
        tiles_per_launch_ = threads_ * least_tiles_per_thread;
    }

    // PoCL generates a kernel's code at its first launch: done here, on an empty queue.
    void prepare(const Program& program) override {
        kernel_.emplace(program, "render_tiles");
        kernel_->bind(context_.buffers.table());
        kernel_->launch(context_.device, threads_);
        context_.device.finish();
    }

    void step() override {
        const std::vector<TileRange> ranges = take_ranges();
        // As many work-items as compute threads: the queue, not PoCL, shares out the work.
        const ClEvent event = kernel_->launch(context_.device, threads_);
        context_.device.finish();
        const auto jobs = context_.buffers.view<TileJob>("tile_jobs");
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            note_nonfinite(context_.stats, ranges[i], jobs[i].nonfinite_path);
            context_.scheduler.finish(ranges[i]);
        }
        const double seconds = event_seconds(event);
        add_stages(seconds);
        const double ideal = static_cast<double>(ranges.size()) * launch_seconds / std::max(seconds, 1e-6);
        // Tiles differ: no jump by more than four times on the word of one launch.
        tiles_per_launch_ = std::clamp(static_cast<std::size_t>(std::min(ideal, 4.0 * static_cast<double>(ranges.size()))),
                                       threads_ * least_tiles_per_thread, context_.scheduler.tile_count() + threads_ * least_tiles_per_thread);
    }

private:
    std::vector<TileRange> take_ranges() {
        const auto jobs = context_.buffers.view<TileJob>("tile_jobs");
        std::vector<TileRange> ranges;
        while (ranges.size() < tiles_per_launch_) {
            const std::optional<TileRange> range = context_.scheduler.next();
            if (!range) break;
            jobs[ranges.size()] = {range->x, range->y, range->first_sample, TILE_PIXELS * range->samples, WAVELOBE_NONE};
            ranges.push_back(*range);
        }
        context_.buffers.view<TileQueue>("tile_queue")[0] = {0, static_cast<std::uint32_t>(ranges.size())};
        return ranges;
    }

    // The launch's time is shared among the stages by the cycles each took.
    void add_stages(double seconds) {
        std::array<StageCounters, STAGE_COUNT> sums{};
        std::uint64_t cycles = 0;
        const auto counters = context_.buffers.view<StageCounters>("stage_counters");
        for (std::size_t i = 0; i < counters.size(); ++i) {
            StageCounters& sum = sums[i % STAGE_COUNT];
            sum.calls += counters[i].calls;
            sum.items += counters[i].items;
            sum.cycles += counters[i].cycles;
            cycles += counters[i].cycles;
            counters[i] = {};
        }
        const double per_cycle = cycles > 0 ? seconds / static_cast<double>(cycles) : 0.0;
        for (std::uint32_t stage = 0; stage < STAGE_COUNT; ++stage) {
            const StageCounters& sum = sums[stage];
            context_.timer.add(stage, {.name = {},
                                       .launches = sum.calls,
                                       .items = sum.items,
                                       .seconds = static_cast<double>(sum.cycles) * per_cycle});
        }
    }

    RenderContext context_;
    std::size_t threads_;
    std::size_t tiles_per_launch_;
    std::optional<Kernel> kernel_;
};

}  // namespace

std::unique_ptr<BlockDriver> make_one_kernel_driver(const RenderContext& context) {
    return std::make_unique<OneKernelDriver>(context);
}

}  // namespace wavelobe
