#include "render/scheduler.h"

#include <algorithm>
#include <random>

namespace wavelobe {

TileScheduler::TileScheduler(const RenderParameters& window, std::uint32_t samples_per_pixel,
                             std::uint32_t samples_per_range)
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
    // Threads take runs of blocks: neighbouring tiles, which cost alike, must not end up in the same one.
    std::ranges::shuffle(ready_, std::mt19937{});
}

std::size_t TileScheduler::assign(std::span<BlockHeader> blocks) {
    tile_of_block_.resize(blocks.size());
    samples_of_block_.resize(blocks.size());
    std::size_t busy = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        BlockHeader& block = blocks[i];
        if (block.path_count == 0 && !ready_.empty()) {
            const std::size_t index = ready_.front();
            ready_.pop_front();
            Tile& tile = tiles_[index];
            const std::uint32_t samples = std::min(samples_per_range_, samples_per_pixel_ - tile.next_sample);
            block = BlockHeader{};
            block.tile_x = tile.x;
            block.tile_y = tile.y;
            block.first_sample = tile.next_sample;
            block.path_count = TILE_PIXELS * samples;
            block.nonfinite_path = WAVELOBE_NONE;
            tile.next_sample += samples;
            tile_of_block_[i] = index;
            samples_of_block_[i] = samples;
        }
        if (block.path_count != 0) ++busy;
    }
    return busy;
}

std::uint64_t TileScheduler::finish(std::size_t block) {
    const std::size_t index = tile_of_block_[block];
    const Tile& tile = tiles_[index];
    if (tile.next_sample < samples_per_pixel_) ready_.push_back(index);
    return std::uint64_t{tile.pixels} * samples_of_block_[block];
}

}  // namespace wavelobe
