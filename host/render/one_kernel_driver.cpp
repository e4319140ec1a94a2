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
    }

    // PoCL generates a kernel's code at its first launch: done here, on an empty queue.
    void prepare(const Program& program) override {
        kernel_.emplace(program, "render_tiles");
        kernel_->bind(context_.buffers.table());
        kernel_->launch(context_.device, threads_);
        context_.device.finish();
    }

    void step(double seconds) override {
        const std::vector<TileRange> ranges = take_ranges(seconds);
        // As many work-items as compute threads: the queue, not PoCL, shares out the work.
        const ClEvent event = kernel_->launch(context_.device, threads_);
        context_.device.finish();
        const auto jobs = context_.buffers.view<TileJob>("tile_jobs");
        std::uint64_t samples = 0;
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            note_nonfinite(context_.stats, ranges[i], jobs[i].nonfinite_path, jobs[i].nonfinite_stage);
            context_.scheduler.finish(ranges[i], {jobs[i].error, jobs[i].error_deviation});
            samples += ranges[i].sample_count();
        }
        const double taken = event_seconds(event);
        add_stages(taken);
        samples_per_second_ = static_cast<double>(samples) / std::max(taken, 1e-6);
    }

private:
    // As many samples as the last launch says go into `seconds`, but a few tiles a thread at the least while there is time.
    std::vector<TileRange> take_ranges(double seconds) {
        const auto jobs = context_.buffers.view<TileJob>("tile_jobs");
        const double wanted = samples_per_second_ * std::min(seconds, launch_seconds);
        const std::size_t least = seconds >= launch_seconds ? threads_ * least_tiles_per_thread : threads_;
        std::vector<TileRange> ranges;
        double samples = 0.0;
        while (ranges.size() < least || samples < wanted) {
            const std::optional<TileRange> range = context_.scheduler.next();
            if (!range) break;
            jobs[ranges.size()] = {.tile_x = range->x,
                                   .tile_y = range->y,
                                   .first_sample = range->first_sample,
                                   .path_count = TILE_PIXELS * range->samples,
                                   .nonfinite_path = WAVELOBE_NONE,
                                   .nonfinite_stage = 0,
                                   .error = 0.0F,
                                   .error_deviation = 0.0F};
            ranges.push_back(*range);
            samples += static_cast<double>(range->sample_count());
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
    double samples_per_second_ = 0.0;  // of the last launch
    std::optional<Kernel> kernel_;
};

}  // namespace

std::unique_ptr<BlockDriver> make_one_kernel_driver(const RenderContext& context) {
    return std::make_unique<OneKernelDriver>(context);
}

}  // namespace wavelobe
