// Sample values: uniform, and unrelated where they should not be related.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/sample_values.h"
#include "support/statistics.h"

namespace wavelobe::test {
namespace {

// Chance that any one of these tests of fixed samples fails although its hypothesis holds.
constexpr double significance = 1e-3;

// Two variables, independent and uniform: Pearson's test of their joint distribution on a grid.
double joint_p_value(const std::vector<float>& u, const std::vector<float>& v, int bins) {
    std::vector<double> counts(static_cast<std::size_t>(bins * bins), 0.0);
    for (std::size_t i = 0; i < u.size(); ++i) {
        const auto cell = static_cast<int>(u[i] * static_cast<float>(bins)) * bins + static_cast<int>(v[i] * static_cast<float>(bins));
        counts[static_cast<std::size_t>(cell)] += 1;
    }
    const std::vector<double> expected(counts.size(), static_cast<double>(u.size()) / static_cast<double>(counts.size()));
    return chi_square_test(counts, expected).p_value;
}

// The same sample in each pixel of a picture.
Samples picture(Word index, Word pair, Word seed, Word shift_x = 0, Word shift_y = 0) {
    Where where;
    for (Word y = 0; y < 512; ++y) {
        for (Word x = 0; x < 512; ++x) where.add(x + shift_x, y + shift_y, index, pair);
    }
    return sample(where, seed);
}

TEST(SamplerStatistics, IsUniformOverPixels) {
    const double threshold = sidak_threshold(significance, 5 * 3);
    for (auto [index, pair, seed] : {std::array{0u, 0u, 0u}, std::array{0u, 1u, 0u}, std::array{1u, 0u, 0u}, std::array{4097u, 9u, 3u},
                                     std::array{0u, 0u, 0x80000000u}}) {
        const Samples s = picture(index, pair, seed);
        EXPECT_GT(joint_p_value(s.u1, s.u2, 64), threshold) << index << " " << pair << " " << seed;
        double mean = 0, square = 0;
        for (float u : s.u1) {
            mean += u - 0.5;
            square += (u - 0.5) * (u - 0.5) - 1.0 / 12;
        }
        const double root = std::sqrt(static_cast<double>(s.u1.size()));
        EXPECT_GT(normal_p_value(mean / root * std::sqrt(12.0)), threshold);
        EXPECT_GT(normal_p_value(square / root * std::sqrt(180.0)), threshold);
    }
}

TEST(SamplerStatistics, NeighboursAreIndependent) {
    struct Shift {
        Word index, pair, seed, x, y;
    };
    const Samples here = picture(6, 4, 1);
    const std::vector<Shift> others = {{6, 4, 1, 1, 0}, {6, 4, 1, 0, 1}, {6, 4, 1, 1, 1}, {6, 4, 1, 2, 0},  {6, 4, 1, 0, 16}, {6, 5, 1, 0, 0},
                                       {6, 6, 1, 0, 0}, {6, 8, 1, 0, 0}, {6, 20, 1, 0, 0}, {6, 4, 2, 0, 0}, {6, 4, 3, 0, 0},  {6, 4, 0, 1, 0},
                                       // One more pixel and one pair less must not be the same.
                                       {6, 3, 1, 1, 0}};
    const double threshold = sidak_threshold(significance, others.size() * 4);
    for (const Shift& o : others) {
        const Samples there = picture(o.index, o.pair, o.seed, o.x, o.y);
        const auto where = testing::Message() << o.pair << " " << o.seed << " " << o.x << " " << o.y;
        EXPECT_GT(joint_p_value(here.u1, there.u1, 32), threshold) << where;
        EXPECT_GT(joint_p_value(here.u2, there.u2, 32), threshold) << where;
        EXPECT_GT(joint_p_value(here.u1, there.u2, 32), threshold) << where;
        EXPECT_GT(joint_p_value(here.u2, there.u1, 32), threshold) << where;
    }
}

// ---- pairs of one pixel against true random scrambling -----------------------------------------------------------------

constexpr Word grid_samples = 256;  // an average of one a cell of a 16 by 16 grid

// Pearson's statistic of the joint distribution of two values; no test by itself, because samples of nets are not
// independent.
int grid_statistic(const Word* a, const Word* b) {
    std::array<int, 256> counts{};
    for (Word i = 0; i < grid_samples; ++i) ++counts[(a[i] >> 20 << 4) | b[i] >> 20];
    int statistic = 0;
    for (int count : counts) statistic += (count - 1) * (count - 1);
    return statistic;
}

// Each pair is a net; shuffling must make two of them as unrelated as random scrambling would.
TEST(SamplerStatistics, PairsOfAPixelAreAsUnrelatedAsRandomScramblingMakesThem) {
    constexpr Word pixels = 12000;
    const int edges[] = {160, 180, 190, 200, 210, 220, 230, 240, 250, 260, 270, 280, 300, 320, 340, 370, 400, 450};
    const auto bin = [&](int statistic) { return static_cast<std::size_t>(std::upper_bound(std::begin(edges), std::end(edges), statistic) - edges); };
    struct Values {
        Word pair;
        int dimension;
    };
    struct Case {
        std::array<Values, 2> both;
        Word digits;
    };
    constexpr std::array<Case, 5> cases = {{{{{{1, 0}, {2, 0}}}, 31}, {{{{1, 1}, {2, 0}}}, 31}, {{{{1, 1}, {5, 1}}}, 31}, {{{{1, 0}, {2, 0}}}, 8}, {{{{1, 1}, {2, 0}}}, 8}}};
    for (const auto& [both, digits] : cases) {
        std::vector<Word> ours[2], ideal[2];
        for (int k : {0, 1}) {
            Where where;
            for (Word p = 0; p < pixels; ++p) {
                for (Word i = 0; i < grid_samples; ++i) where.add(p, 50, i, both[k].pair);
            }
            const Samples s = sample(where, 4, digits);
            for (Word p = 0; p < pixels; ++p) {
                const std::uint64_t seed = strong_hash((std::uint64_t{p} << 8) + both[k].pair);
                for (Word i = 0; i < grid_samples; ++i) {
                    const std::size_t at = std::size_t{p} * grid_samples + i;
                    ours[k].push_back(both[k].dimension == 0 ? s.a(at) : s.b(at));
                    // Eight bits of index and the four bits that choose a cell.
                    const Word shuffled = owen_scramble(i, seed, 7, 0);
                    const auto dimension_seed = strong_hash(seed + 1 + static_cast<std::uint64_t>(both[k].dimension));
                    ideal[k].push_back(owen_scramble(sobol(shuffled, both[k].dimension), dimension_seed, 31, 28) >> 8);
                }
            }
        }
        std::vector<double> our_counts(std::size(edges) + 1, 0.0), ideal_counts(std::size(edges) + 1, 0.0);
        for (std::size_t at = 0; at < ours[0].size(); at += grid_samples) {
            ++our_counts[bin(grid_statistic(&ours[0][at], &ours[1][at]))];
            ++ideal_counts[bin(grid_statistic(&ideal[0][at], &ideal[1][at]))];
        }
        // Two samples of one distribution: the sum of (a - b)^2 / (a + b) follows the chi-square distribution.
        double statistic = 0;
        for (std::size_t i = 0; i < our_counts.size(); ++i) {
            const double a = our_counts[i], b = ideal_counts[i];
            ASSERT_GT(a + b, 5);
            statistic += (a - b) * (a - b) / (a + b);
        }
        EXPECT_GT(chi_square_p_value(statistic, static_cast<double>(our_counts.size() - 1)), sidak_threshold(significance, cases.size()))
            << both[0].pair << " " << both[1].pair << " " << digits;
    }
}

}  // namespace
}  // namespace wavelobe::test
