#include "render/scheduler.h"

#include <algorithm>
#include <random>

#include "shared/block.h"

namespace wavelobe {

TileScheduler::TileScheduler(const RenderParameters& window, std::uint32_t samples_per_pixel,
                             std::uint32_t samples_per_range, TileOrder order)
    : samples_per_pixel_(samples_per_pixel), samples_per_range_(samples_per_range) {
    for (std::uint32_t y = 0; y < window.window_height; y += TILE_WIDTH) {
        for (std::uint32_t x = 0; x < window.window_width; x += TILE_WIDTH) {
            const std::uint32_t width = std::min(TILE_WIDTH, window.window_width - x);
            const std::uint32_t height = std::min(TILE_WIDTH, window.window_height - y);
            tiles_.push_back({window.window_x + x, window.window_y + y, 0, width * height});
            pixels_ += std::uint64_t{width} * height;
        }
    }
    for (std::size_t i = 0; i < tiles_.size(); ++i) ready_.push_back(i);
    if (order == TileOrder::mixed) std::ranges::shuffle(ready_, std::mt19937{});
}

std::optional<TileRange> TileScheduler::next() {
    if (ready_.empty()) return std::nullopt;
    const std::size_t index = ready_.front();
    ready_.pop_front();
    Tile& tile = tiles_[index];
    const std::uint32_t samples = std::min(samples_per_range_, samples_per_pixel_ - tile.next_sample);
    const TileRange range{tile.x, tile.y, tile.next_sample, samples, tile.pixels, index};
    tile.next_sample += samples;
    return range;
}

void TileScheduler::finish(const TileRange& range) {
    if (tiles_[range.tile].next_sample < samples_per_pixel_) ready_.push_back(range.tile);
    samples_done_ += range.sample_count();
}

}  // namespace wavelobe
