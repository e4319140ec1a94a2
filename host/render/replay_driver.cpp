#include <algorithm>
#include <cmath>
#include <optional>

#include "render/driver.h"

namespace wavelobe {
namespace {

std::optional<std::uint32_t> number(std::uint32_t word) {
    return word == WAVELOBE_NONE ? std::nullopt : std::optional(word);
}

Replay::Vertex vertex_of(const ReplayRecord& r) {
    return {.stage = stage_name(r.stage),
            .depth = r.depth,
            .shadow = r.stage == STAGE_INTERSECT_SHADOW,
            .emission_ray = r.depth == EMISSION_DEPTH,
            .shape = number(r.shape),
            .primitive = number(r.primitive),
            .distance = static_cast<double>(r.t),
            .position = vector_of(r.position),
            .direction = vector_of(r.direction),
            .throughput = vector_of(r.throughput),
            .pdf = r.pdf,
            .radiance = vector_of(r.radiance)};
}

// The number of a pixel within its tile.
std::uint32_t pixel_number(std::uint32_t x, std::uint32_t y) {
    for (std::uint32_t pixel = 0; pixel < TILE_PIXELS; ++pixel) {
        if (TILE_X(pixel) == x && TILE_Y(pixel) == y) return pixel;
    }
    return WAVELOBE_NONE;
}

class ReplayDriver final : public BlockDriver {
public:
    ReplayDriver(const RenderContext& context, const SampleName& sample) : context_(context), sample_(sample) {
        DeviceBuffers& buffers = context_.buffers;
        buffers.add_blocks(1, block_words(context.features, context.block_slots));
        buffers.add_zeros<ReplayLog>("replay_log", 1);
        buffers.add_zeros<ReplayRecord>("replay_records", REPLAY_RECORDS);
    }

    void prepare(const Program& program) override {
        kernel_.emplace(program, "replay_path");
        kernel_->bind(context_.buffers.table());
    }

    void step(double /*seconds*/) override {
        const auto x = static_cast<std::uint32_t>(sample_.x);
        const auto y = static_cast<std::uint32_t>(sample_.y);
        // In a range of one sample the id of a path is the number of its pixel.
        const std::uint32_t id = pixel_number(x % TILE_WIDTH, y % TILE_WIDTH);
        BlockHeader& block = context_.buffers.view<BlockHeader>("headers")[0];
        block.tile_x = x - x % TILE_WIDTH;
        block.tile_y = y - y % TILE_WIDTH;
        block.first_sample = sample_.sample;
        // The only one that is left to start.
        block.next_path = id;
        block.next_emission_ray = id * static_cast<std::uint32_t>(context_.features.emission_rays);
        block.path_count = id + 1;
        ReplayLog& log = context_.buffers.view<ReplayLog>("replay_log")[0];
        log.path = id;
        kernel_->launch(context_.device, 1);
        context_.device.finish();
        collect(log);
    }

private:
    void collect(const ReplayLog& log) {
        Replay& replay = context_.stats.replay;
        const auto records = context_.buffers.view<ReplayRecord>("replay_records");
        const std::uint32_t kept = std::min(log.count, REPLAY_RECORDS);
        for (std::uint32_t i = 0; i < kept; ++i) replay.vertices.push_back(vertex_of(records[i]));
        replay.left_out = log.count - kept;
        replay.radiance = vector_of(log.radiance);
        const bool finite = std::isfinite(log.radiance.x) && std::isfinite(log.radiance.y) && std::isfinite(log.radiance.z);
        if (!finite) replay.broken_by = stage_name(log.stage);
    }

    RenderContext context_;
    SampleName sample_;
    std::optional<Kernel> kernel_;
};

}  // namespace

std::unique_ptr<BlockDriver> make_replay_driver(const RenderContext& context, const SampleName& sample) {
    return std::make_unique<ReplayDriver>(context, sample);
}

}  // namespace wavelobe
