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

// What a finished range tells of its tile, where errors are estimated.
struct TileError {
    float relative_mse = 0.0F;
    float deviation = 0.0F;  // standard error of the estimate
};

// How samples are handed out.
struct SamplePlan {
    std::uint32_t samples_per_pixel = 1;
    // Double the samples of a tile with each range, from one on: a picture that may be ended at any time is there early.
    bool growing_ranges = false;
    double target_error = 0.0;  // relMSE at which a tile is done; 0: never before its last sample
};

enum class TileOrder {
    rows,   // neighbours follow each other: they share the caches
    mixed,  // neighbours, which cost alike, are apart: any run of ranges costs about the same
};

// A tile's ranges are handed out one after the other, the next when the one before is in the film: each pixel sums its
// samples in order, whatever the order of the tiles.
class TileScheduler {
public:
    TileScheduler(const RenderParameters& window, const SamplePlan& plan, TileOrder order);

    std::size_t tile_count() const { return tiles_.size(); }
    std::size_t ready_count() const { return ready_.size(); }
    std::uint64_t total_samples() const { return total_samples_; }  // fewer when tiles are done early
    std::uint64_t samples_done() const { return samples_done_; }
    bool finished() const { return samples_done_ == total_samples_; }
    double share_done() const;       // of the work; how far tiles are from their target is guessed from their error
    double estimated_error() const;  // mean of the tiles' last estimates, by pixels

    // The next range to render; nothing while those that remain wait for others to finish.
    std::optional<TileRange> next();

    // Takes note that a range is in the film.
    void finish(const TileRange& range, const TileError& error = {});

private:
    struct Tile {
        std::uint32_t x, y;
        std::uint32_t next_sample;
        std::uint32_t pixels;
        float error = 0.0F;
    };

    bool reached_target(const Tile& tile, const TileError& error) const;

    std::vector<Tile> tiles_;
    std::deque<std::size_t> ready_;
    std::uint64_t pixels_ = 0;
    std::uint64_t total_samples_ = 0;
    std::uint64_t samples_done_ = 0;
    SamplePlan plan_;
};

}  // namespace wavelobe
