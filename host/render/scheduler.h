// Hands out tiles of the picture, a range of samples at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "shared/scene.h"

namespace wavelobe {

// One tile and a range of its samples.
struct TileRange {
    std::uint32_t x = 0, y = 0;        // film coordinates of its first pixel
    std::uint32_t first_sample = 0;
    std::uint32_t samples = 0;         // of each pixel
    std::uint32_t pixels = 0;          // inside the window
    std::size_t tile = 0;

    std::uint64_t sample_count() const { return std::uint64_t{pixels} * samples; }
};

enum class TileOrder {
    rows,   // neighbours follow each other: they share the caches
    mixed,  // neighbours, which cost alike, are apart: any run of ranges costs about the same
};

// A tile's ranges are handed out one after the other, the next when the one before is in the film: each pixel sums its
// samples in order, whatever the order of the tiles.
class TileScheduler {
public:
    TileScheduler(const RenderParameters& window, std::uint32_t samples_per_pixel, std::uint32_t samples_per_range,
                  TileOrder order);

    std::size_t tile_count() const { return tiles_.size(); }
    std::size_t ready_count() const { return ready_.size(); }
    std::uint64_t total_samples() const { return pixels_ * samples_per_pixel_; }
    std::uint64_t samples_done() const { return samples_done_; }
    bool finished() const { return samples_done_ == total_samples(); }

    // The next range to render; nothing while those that remain wait for others to finish.
    std::optional<TileRange> next();

    // Takes note that a range is in the film.
    void finish(const TileRange& range);

private:
    struct Tile {
        std::uint32_t x, y;
        std::uint32_t next_sample;
        std::uint32_t pixels;
    };

    std::vector<Tile> tiles_;
    std::deque<std::size_t> ready_;
    std::uint64_t pixels_ = 0;
    std::uint64_t samples_done_ = 0;
    std::uint32_t samples_per_pixel_;
    std::uint32_t samples_per_range_;
};

}  // namespace wavelobe
