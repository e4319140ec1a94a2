#include "render/scheduler.h"

#include <algorithm>
#include <random>

#include "shared/block.h"

namespace wavelobe {
namespace {

constexpr std::uint32_t least_samples_for_target = 4 * BLOCK_SAMPLES;

}  // namespace

TileScheduler::TileScheduler(const RenderParameters& window, const SamplePlan& plan, TileOrder order) : plan_(plan) {
    for (std::uint32_t y = 0; y < window.window_height; y += TILE_WIDTH) {
        for (std::uint32_t x = 0; x < window.window_width; x += TILE_WIDTH) {
            const std::uint32_t width = std::min(TILE_WIDTH, window.window_width - x);
            const std::uint32_t height = std::min(TILE_WIDTH, window.window_height - y);
            tiles_.push_back({window.window_x + x, window.window_y + y, 0, width * height});
            pixels_ += std::uint64_t{width} * height;
        }
    }
    total_samples_ = pixels_ * plan_.samples_per_pixel;
    for (std::size_t i = 0; i < tiles_.size(); ++i) ready_.push_back(i);
    if (order == TileOrder::mixed) std::ranges::shuffle(ready_, std::mt19937{});
}

std::optional<TileRange> TileScheduler::next() {
    if (ready_.empty()) return std::nullopt;
    const std::size_t index = ready_.front();
    ready_.pop_front();
    Tile& tile = tiles_[index];
    std::uint32_t samples = std::min(BLOCK_SAMPLES, plan_.samples_per_pixel - tile.next_sample);
    if (plan_.growing_ranges) samples = std::min(samples, std::max(tile.next_sample, 1U));
    const TileRange range{tile.x, tile.y, tile.next_sample, samples, tile.pixels, index};
    tile.next_sample += samples;
    return range;
}

// Only when both halves of the film have as many samples, enough of them that rare bright paths have had their chance, and when
// the estimate is not merely low by luck: else tiles would stop on their lucky days, and the picture be worse than it says.
bool TileScheduler::reached_target(const Tile& tile, const TileError& error) const {
    return plan_.target_error > 0.0 && tile.next_sample >= least_samples_for_target &&
           tile.next_sample % (2 * BLOCK_SAMPLES) == 0 &&
           static_cast<double>(error.relative_mse + 2.0F * error.deviation) <= plan_.target_error;
}

void TileScheduler::finish(const TileRange& range, const TileError& error) {
    Tile& tile = tiles_[range.tile];
    samples_done_ += range.sample_count();
    tile.error = error.relative_mse;
    if (reached_target(tile, error)) {
        total_samples_ -= std::uint64_t{tile.pixels} * (plan_.samples_per_pixel - tile.next_sample);
    } else if (tile.next_sample < plan_.samples_per_pixel) {
        ready_.push_back(range.tile);
    }
}

double TileScheduler::share_done() const {
    if (!(plan_.target_error > 0.0)) {
        return static_cast<double>(samples_done_) / static_cast<double>(std::max<std::uint64_t>(total_samples_, 1));
    }
    double sum = 0.0;
    for (const Tile& tile : tiles_) {
        const double by_samples = static_cast<double>(tile.next_sample) / plan_.samples_per_pixel;
        const double by_error = tile.error > 0.0F ? plan_.target_error / static_cast<double>(tile.error) : 0.0;
        sum += tile.pixels * std::min(std::max(by_samples, by_error), 1.0);
    }
    return sum / static_cast<double>(std::max<std::uint64_t>(pixels_, 1));
}

double TileScheduler::estimated_error() const {
    double sum = 0.0;
    for (const Tile& tile : tiles_) sum += static_cast<double>(tile.error) * tile.pixels;
    return sum / static_cast<double>(std::max<std::uint64_t>(pixels_, 1));
}

}  // namespace wavelobe
