#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "render/driver.h"

namespace wavelobe {
namespace {

// Blocks in flight a compute thread: enough that a launch outweighs its overhead, few enough that their waves stay in the
// caches of the cores.
constexpr std::size_t blocks_per_thread = 32;

class StagedDriver final : public BlockDriver {
public:
    explicit StagedDriver(const RenderContext& context)
        : context_(context),
          ranges_(std::min(context.scheduler.tile_count(),
                           blocks_per_thread * std::max(context.device.info().compute_units, 1U))) {
        context_.buffers.add_blocks(ranges_.size(), block_words(context.features, context.block_slots));
        headers_ = context_.buffers.view<BlockHeader>("headers");
    }

    // PoCL generates a kernel's code at its first launch: done here, on blocks without work.
    void prepare(const Program& program) override {
        for (std::uint32_t stage = 0; stage < STAGE_COUNT; ++stage) {
            if (!context_.features.has_stage(stage)) continue;
            Kernel& kernel = kernels_.emplace(stage, Kernel(program, stage_name(stage))).first->second;
            kernel.bind(context_.buffers.table());
            run(stage);
        }
        context_.device.finish();
    }

    // One vertex of every path in flight.
    void step(double /*seconds*/) override {
        assign();
        start_and_trace();
        bool finished = false;
        for (const BlockHeader& block : headers_) {
            const std::uint32_t scattering =
                block.count[QUEUE_DELTA] + block.count[QUEUE_GLOSSY] + block.count[QUEUE_DIFFUSE];
            finished = finished || (block.path_count != 0 && block.next_path >= block.path_count && scattering == 0);
        }
        // Shadow rays of the vertex before go first: a path gains its radiance in order of its vertices.
        launch(STAGE_INTERSECT_SHADOW, QUEUE_SHADOW);
        launch(STAGE_SHADE_ESCAPED, QUEUE_ESCAPED);
        launch(STAGE_SHADE_EMITTED, QUEUE_EMITTED);
        launch(STAGE_SCATTER_DELTA, QUEUE_DELTA);
        launch(STAGE_SCATTER_GLOSSY, QUEUE_GLOSSY);
        launch(STAGE_SCATTER_DIFFUSE, QUEUE_DIFFUSE);
        if (finished) collect_finished();
    }

    void wait() override {
        context_.device.finish();
        context_.timer.collect();
    }

private:
    ClEvent run(std::uint32_t stage) { return kernels_.at(stage).launch(context_.device, headers_.size()); }

    // Gives work to every free block while there is some.
    void assign() {
        for (std::size_t i = 0; i < headers_.size(); ++i) {
            BlockHeader& block = headers_[i];
            if (block.path_count != 0) continue;
            const std::optional<TileRange> range = context_.scheduler.next();
            if (!range) return;
            ranges_[i] = *range;
            block = BlockHeader{};
            block.tile_x = range->x;
            block.tile_y = range->y;
            block.first_sample = range->first_sample;
            block.path_count = TILE_PIXELS * range->samples;
            block.nonfinite_path = WAVELOBE_NONE;
        }
    }

    void start_and_trace() {
        std::optional<ClEvent> generate;
        if (std::ranges::any_of(headers_, [](const BlockHeader& b) { return b.next_path < b.path_count; })) {
            generate = run(STAGE_GENERATE);
        }
        ClEvent intersect = run(STAGE_INTERSECT_CLOSEST);
        std::optional<ClEvent> layers;
        if (generate && context_.features.has_stage(STAGE_RECORD_LAYERS)) layers = run(STAGE_RECORD_LAYERS);
        ClEvent sort = run(STAGE_SORT_PATHS);
        context_.device.finish();
        std::uint64_t started = 0;
        std::uint64_t traced = 0;
        for (BlockHeader& block : headers_) {
            started += std::exchange(block.started, 0);
            traced += block.traced;
        }
        StageTimer& timer = context_.timer;
        if (generate) timer.add_launch(STAGE_GENERATE, started, std::move(*generate));
        timer.add_launch(STAGE_INTERSECT_CLOSEST, traced, std::move(intersect));
        if (layers) timer.add_launch(STAGE_RECORD_LAYERS, started, std::move(*layers));
        timer.add_launch(STAGE_SORT_PATHS, traced, std::move(sort));
        timer.collect();
    }

    void launch(std::uint32_t stage, std::uint32_t queue) {
        std::uint64_t items = 0;
        for (const BlockHeader& block : headers_) items += block.count[queue];
        if (items != 0) context_.timer.add_launch(stage, items, run(stage));
    }

    void collect_finished() {
        std::vector<bool> busy(headers_.size());
        for (std::size_t i = 0; i < headers_.size(); ++i) busy[i] = headers_[i].path_count != 0;
        ClEvent event = run(STAGE_ACCUMULATE);
        context_.device.finish();
        std::uint64_t collected = 0;
        for (std::size_t i = 0; i < headers_.size(); ++i) {
            if (!busy[i] || headers_[i].path_count != 0) continue;
            collected += ranges_[i].sample_count();
            note_nonfinite(context_.stats, ranges_[i], headers_[i].nonfinite_path, headers_[i].nonfinite_stage);
            context_.scheduler.finish(ranges_[i], {headers_[i].error, headers_[i].error_deviation});
        }
        context_.timer.add_launch(STAGE_ACCUMULATE, collected, std::move(event));
    }

    RenderContext context_;
    std::vector<TileRange> ranges_;  // of each block
    std::span<BlockHeader> headers_;
    std::map<std::uint32_t, Kernel> kernels_;
};

}  // namespace

std::unique_ptr<BlockDriver> make_staged_driver(const RenderContext& context) {
    return std::make_unique<StagedDriver>(context);
}

}  // namespace wavelobe
