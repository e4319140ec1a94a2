// Which cells of the caustic grid share a map of directions, and how many samples follow it.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "render/caustic_maps.h"

namespace wavelobe {
namespace {

// A grid of 16 x 8 x 8 cells of unit size under an irradiance of `mean`, of one batch of photons that brings at most unit flux and radiance.
CausticGrid grid_under(float mean) {
    CausticGrid grid{};
    grid.size[0] = 16;
    grid.size[1] = grid.size[2] = 8;
    grid.inverse_step = 1.0F;
    grid.batches = 1;
    grid.greatest_flux = grid.greatest_radiance = std::bit_cast<std::uint32_t>(1.0F);
    grid.mean_irradiance = mean;
    return grid;
}

class ChosenMaps : public testing::Test {
protected:
    static std::size_t cell(std::size_t x, std::size_t y, std::size_t z) { return (z * 8 + y) * 16 + x; }
    std::uint32_t side_of(std::size_t i) const { return cells_[i] == 0 ? 0 : sides_[cells_[i] - 1]; }
    void choose() { sides_ = choose_caustic_maps(grid_under(1.0F), counts_, cells_); }

    std::vector<std::uint32_t> counts_ = std::vector<std::uint32_t>(16 * 8 * 8), cells_ = counts_, sides_;
};

TEST_F(ChosenMaps, BrightCellsHaveTheirOwnAndDimOnesShare) {
    counts_[cell(0, 0, 0)] = 50;
    counts_[cell(1, 0, 0)] = 12;
    counts_[cell(0, 1, 0)] = 7;  // together with the next enough for the cube of two
    counts_[cell(1, 1, 0)] = 5;
    counts_[cell(2, 0, 0)] = 6;  // with the next, enough for the cube of four
    counts_[cell(3, 3, 3)] = 6;
    counts_[cell(7, 7, 7)] = 11;  // too few for any
    choose();
    EXPECT_EQ(side_of(cell(0, 0, 0)), 1U);
    EXPECT_EQ(side_of(cell(1, 0, 0)), 1U);
    EXPECT_NE(cells_[cell(0, 0, 0)], cells_[cell(1, 0, 0)]);
    EXPECT_EQ(side_of(cell(0, 1, 0)), 2U);
    EXPECT_EQ(cells_[cell(0, 1, 0)], cells_[cell(1, 1, 0)]);
    EXPECT_EQ(side_of(cell(2, 0, 0)), 4U);
    EXPECT_EQ(cells_[cell(2, 0, 0)], cells_[cell(3, 3, 3)]);
    EXPECT_EQ(side_of(cell(7, 7, 7)), 0U);
    EXPECT_EQ(sides_.size(), 4U);
}

TEST_F(ChosenMaps, CubesDoNotReachAcrossTheirBounds) {
    counts_[cell(7, 0, 0)] = 8;
    counts_[cell(8, 0, 0)] = 8;
    choose();
    EXPECT_TRUE(sides_.empty());
    EXPECT_TRUE(std::ranges::all_of(cells_, [](std::uint32_t c) { return c == 0; }));
}

TEST(ChosenMapsOfManyCells, AreNoMoreThanThereIsRoomFor) {
    CausticGrid grid = grid_under(1.0F);
    grid.size[0] = grid.size[1] = grid.size[2] = 20;
    std::vector<std::uint32_t> counts(20 * 20 * 20), cells(counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = 20 + static_cast<std::uint32_t>(i % 100);
    const auto sides = choose_caustic_maps(grid, counts, cells);
    EXPECT_EQ(sides.size(), std::size_t{CAUSTIC_MAPS});
    EXPECT_EQ(cells[0], 0U);
    EXPECT_NE(cells[99], 0U) << "a cell with most photons";
    for (const std::uint32_t map : cells) ASSERT_LE(map, sides.size());
}

// Light of radiance `radiance` that arrives from so many bins, and gives the irradiance `irradiance` on a cell.
double share_of(float mean, double irradiance, double radiance, std::size_t bins, std::uint32_t side = 1) {
    const double unit = 0x1p32 * PHOTONS_A_BATCH;
    std::vector<std::uint64_t> sums(CAUSTIC_BINS, 0);
    for (std::size_t i = 0; i < bins; ++i) sums[i] = static_cast<std::uint64_t>(irradiance * unit / static_cast<double>(bins));
    return best_caustic_share(grid_under(mean), {sums, static_cast<std::uint64_t>(irradiance * radiance * unit)}, side);
}

TEST(GuidedShare, IsLargeForWhatIsBrightAndSmall) {
    EXPECT_GT(share_of(0.01F, 1.0, 1000.0, 1), 0.7);
    EXPECT_EQ(share_of(1.0F, 0.1, 0.1, 128), 0.0) << "from everywhere";
    EXPECT_EQ(share_of(1.0F, 0.0, 0.0, 0), 0.0) << "no light";
    EXPECT_EQ(share_of(1e6F, 1.0, 1000.0, 1), 0.0) << "faint beside the rest";
    double before = 1.0;
    for (const float mean : {0.01F, 0.1F, 1.0F, 10.0F}) {
        const double share = share_of(mean, 1.0, 100.0, 1);
        EXPECT_LE(share, before) << "under more other light";
        before = share;
    }
    EXPECT_LE(share_of(0.3F, 1.0, 100.0, 1, 8), share_of(0.3F, 1.0, 100.0, 1)) << "the same flux on more surface is fainter";
}

}  // namespace
}  // namespace wavelobe
