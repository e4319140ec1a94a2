// Hands tiles of the picture, a range of samples at a time, to blocks.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "shared/block.h"
#include "shared/scene.h"

namespace wavelobe {

// A tile's ranges are handed out one after the other, the next when the one before is in the film: each pixel sums its
// samples in order, whatever the number of blocks.
class TileScheduler {
public:
    TileScheduler(const RenderParameters& window, std::uint32_t samples_per_pixel, std::uint32_t samples_per_range);

    std::size_t tile_count() const { return tiles_.size(); }
    std::uint64_t total_samples() const { return pixels_ * samples_per_pixel_; }

    // Gives work to every free block (path_count 0) while there is some. Returns the number of blocks with work.
    std::size_t assign(std::span<BlockHeader> blocks);

    // Takes note of a block whose samples are in the film. Returns how many they were.
    std::uint64_t finish(std::size_t block);

private:
    struct Tile {
        std::uint32_t x, y;         // film coordinates
        std::uint32_t next_sample;  // first of the next range
        std::uint32_t pixels;       // inside the window
    };

    std::vector<Tile> tiles_;
    std::deque<std::size_t> ready_;
    std::vector<std::size_t> tile_of_block_;
    std::vector<std::uint32_t> samples_of_block_;
    std::uint64_t pixels_ = 0;
    std::uint32_t samples_per_pixel_;
    std::uint32_t samples_per_range_;
};

}  // namespace wavelobe
