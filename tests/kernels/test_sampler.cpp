// Sample values: against an integer reference, the net property of every pair, and independence of what should not be
// related.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "support/probe.h"
#include "support/sobol_reference.h"
#include "support/statistics.h"

namespace wavelobe::test {
namespace {

// ---- the sampler ---------------------------------------------------------------------------------------------

// Values as multiples of 2^-24, by sample.
struct Samples {
    std::vector<float> u1, u2;
    Word a(std::size_t i) const { return static_cast<Word>(u1[i] * 0x1p24F); }
    Word b(std::size_t i) const { return static_cast<Word>(u2[i] * 0x1p24F); }
};

struct Where {
    std::vector<Word> x, y, index, pair;
    void add(Word x_, Word y_, Word index_, Word pair_) {
        x.push_back(x_);
        y.push_back(y_);
        index.push_back(index_);
        pair.push_back(pair_);
    }
};

Samples sample(const Where& where, Word seed, int lanes = 16) {
    Probe probe(R"(
        #include "sampling/sampler.h"
        INLINE UInt load_words(global const uint *p) { return *(global const UIntUnaligned *)p; }
        kernel void run(global const uint *x, global const uint *y, global const uint *index, global const uint *pair,
                        global float *out1, global float *out2, uint seed) {
            size_t i = get_global_id(0) * LANES;
            SampleId id = sample_id(load_words(x + i), load_words(y + i), load_words(index + i), seed);
            Float u1, u2;
            sample_2d(id, load_words(pair + i), &u1, &u2);
            store(out1 + i, u1);
            store(out2 + i, u2);
        })",
                {.lanes = lanes, .defines = ""});
    Where w = where;
    const std::size_t count = w.x.size();
    for (auto* list : {&w.x, &w.y, &w.index, &w.pair}) list->resize((count + 15) / 16 * 16);
    const Where& padded = w;
    Samples s{std::vector<float>(w.x.size()), std::vector<float>(w.x.size())};
    probe.run("run", w.x.size() / static_cast<unsigned>(lanes), padded.x, padded.y, padded.index, padded.pair, s.u1, s.u2, seed);
    s.u1.resize(count);
    s.u2.resize(count);
    return s;
}

Where anywhere() {
    std::mt19937 random(2);
    Where where;
    for (int i = 0; i < 40000; ++i) {
        const auto r = [&] { return static_cast<Word>(random()); };
        where.add(r() >> (i % 3 * 10), r() >> (i % 5 * 6), r() >> (1 + i % 31), r() >> (i % 4 * 8));
    }
    where.add(0, 0, 0, 0);
    where.add(0xffffffffu, 0xffffffffu, 0x7fffffffu, 0xffffffffu);
    return where;
}

TEST(Sampler, FollowsTheReference) {
    const Where where = anywhere();
    for (Word seed : {0u, 1u, 0xdeadbeefu}) {
        const Samples s = sample(where, seed);
        for (std::size_t i = 0; i < where.x.size(); ++i) {
            const auto expected = reference_pair(where.x[i], where.y[i], where.index[i], where.pair[i], seed);
            ASSERT_EQ(s.a(i), expected[0]) << i;
            ASSERT_EQ(s.b(i), expected[1]) << i;
            // A multiple of 2^-24 below one.
            ASSERT_EQ(static_cast<float>(expected[0]) * 0x1p-24F, s.u1[i]);
            ASSERT_LT(s.u1[i], 1.0F);
            ASSERT_LT(s.u2[i], 1.0F);
        }
    }
}

TEST(Sampler, HasTheSameBitsAtEveryWidth) {
    const Where where = anywhere();
    const Samples wide = sample(where, 5);
    for (int lanes : {1, 8}) {
        const Samples s = sample(where, 5, lanes);
        EXPECT_EQ(s.u1, wide.u1) << lanes;
        EXPECT_EQ(s.u2, wide.u2) << lanes;
    }
}

TEST(Sampler, BuildingBlocks) {
    Probe probe(R"(
        #include "sampling/sampler.h"
        kernel void run(global const uint *in, global uint *reverse, global uint *second, global uint *scrambled, uint seed) {
            size_t i = get_global_id(0) * LANES;
            UInt x = *(global const UIntUnaligned *)(in + i);
            *(global UIntUnaligned *)(reverse + i) = reverse_bits(x);
            *(global UIntUnaligned *)(second + i) = sobol_second_reversed(x);
            *(global UIntUnaligned *)(scrambled + i) = scramble_reversed(x, (UInt)seed);
        })");
    std::mt19937 random(7);
    std::vector<Word> words;
    for (int k = 0; k < 32; ++k) words.push_back(1u << k);
    // Pairs that differ from bit `k` on, in that bit and anything above.
    for (int k = 0; k < 32; ++k) {
        for (int i = 0; i < 500; ++i) {
            const Word x = static_cast<Word>(random());
            words.push_back(x);
            words.push_back(x ^ ((static_cast<Word>(random()) << 1 | 1u) << k));
        }
    }
    const auto& in = words;
    for (Word seed : {0u, 0xffffffffu, 0x12345678u, 0x9abcdef1u}) {
        std::vector<Word> reverse(in.size()), second(in.size()), scrambled(in.size());
        probe.run("run", in.size() / 16, in, reverse, second, scrambled, seed);
        for (std::size_t i = 0; i < in.size(); ++i) {
            ASSERT_EQ(reverse[i], reversed(in[i]));
            ASSERT_EQ(second[i], reversed(sobol(in[i], 1)));
        }
        // Nested scrambling: a bit is kept or flipped by what is below it alone.
        for (std::size_t i = 32; i < in.size(); i += 2) {
            const Word difference = in[i] ^ in[i + 1];
            const Word up_to_lowest = difference ^ (difference - 1);
            ASSERT_EQ((scrambled[i] ^ scrambled[i + 1]) & up_to_lowest, difference & up_to_lowest);
        }
    }
}

// The first 2^m samples, and every later aligned run of 2^m, have one point in each elementary interval.
TEST(Sampler, EveryPairIsAScrambledNet) {
    constexpr int most = 10;
    for (Word start : {0u, 1u << most, 5u << most, 0x7fffffffu - ((1u << most) - 1)}) {
        for (auto [x, y, pair, seed] : {std::array{0u, 0u, 0u, 0u}, std::array{3u, 2u, 1u, 0u}, std::array{1919u, 1079u, 17u, 1u},
                                        std::array{5u, 7u, 2u, 77u}, std::array{5u, 8u, 123u, 77u}}) {
            Where where;
            for (Word i = 0; i < 1u << most; ++i) where.add(x, y, start + i, pair);
            const Samples s = sample(where, seed);
            for (int m = 0; m <= most; ++m) {
                for (Word block = 0; block < 1u << (most - m); ++block) {
                    for (int a = 0; a <= m; ++a) {
                        std::vector<bool> taken(std::size_t{1} << m, false);
                        for (std::size_t i = std::size_t{block} << m; i < std::size_t{block + 1} << m; ++i) {
                            const std::size_t cell = (s.a(i) >> (24 - a) << (m - a)) | s.b(i) >> (24 - (m - a));
                            ASSERT_FALSE(taken[cell]) << "start " << start << " m " << m << " a " << a;
                            taken[cell] = true;
                        }
                    }
                }
            }
        }
    }
}

// Any number of samples, not just a power of two: each elementary interval of size 2^-m holds n / 2^m, rounded down or up.
TEST(Sampler, EveryPrefixIsBalanced) {
    constexpr Word count = 1000;
    Where where;
    for (Word i = 0; i < count; ++i) where.add(12, 34, i, 3);
    const Samples s = sample(where, 9);
    for (int m = 1; m <= 7; ++m) {
        for (int a = 0; a <= m; ++a) {
            std::vector<Word> counts(std::size_t{1} << m, 0);
            for (Word n = 1; n <= count; ++n) {
                ++counts[(s.a(n - 1) >> (24 - a) << (m - a)) | s.b(n - 1) >> (24 - (m - a))];
                const auto [least, greatest] = std::minmax_element(counts.begin(), counts.end());
                ASSERT_GE(*least, n >> m);
                ASSERT_LE(*greatest, (n >> m) + 1);
            }
        }
    }
}

// ---- statistics over pixels, pairs and seeds ------------------------------------------------------------------------

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

TEST(Sampler, IsUniformOverPixels) {
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

TEST(Sampler, NeighboursAreIndependent) {
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
TEST(Sampler, PairsOfAPixelAreAsUnrelatedAsRandomScramblingMakesThem) {
    constexpr Word pixels = 12000;
    const int edges[] = {160, 180, 190, 200, 210, 220, 230, 240, 250, 260, 270, 280, 300, 320, 340, 370, 400, 450};
    const auto bin = [&](int statistic) { return static_cast<std::size_t>(std::upper_bound(std::begin(edges), std::end(edges), statistic) - edges); };
    struct Values {
        Word pair;
        int dimension;
    };
    constexpr std::array<std::array<Values, 2>, 3> cases = {{{{{1, 0}, {2, 0}}}, {{{1, 1}, {2, 0}}}, {{{1, 1}, {5, 1}}}}};
    for (const auto& both : cases) {
        std::vector<Word> ours[2], ideal[2];
        for (int k : {0, 1}) {
            Where where;
            for (Word p = 0; p < pixels; ++p) {
                for (Word i = 0; i < grid_samples; ++i) where.add(p, 50, i, both[k].pair);
            }
            const Samples s = sample(where, 4);
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
            << both[0].pair << " " << both[1].pair;
    }
}

// What a net is for: the mean of a smooth function converges faster than that of random points, whose variance here is the
// function's over n.
TEST(Sampler, SmoothIntegralsConvergeFasterThanRandomly) {
    constexpr Word count = 1024, pixels = 64;
    Where where;
    for (Word p = 0; p < pixels; ++p) {
        for (Word i = 0; i < count; ++i) where.add(p, 1, i, 2);
    }
    const Samples s = sample(where, 6);
    double square = 0;
    for (std::size_t p = 0; p < pixels; ++p) {
        double mean = 0;
        for (std::size_t i = p * count; i < (p + 1) * count; ++i) mean += s.u1[i] * s.u2[i] / count;
        square += (mean - 0.25) * (mean - 0.25) / pixels;
    }
    const double random_variance = (1.0 / 9 - 1.0 / 16) / count;
    // Owen 1997: the variance of scrambled nets is of order n^-3 (log n) for smooth functions, a factor of 10^6 / 7 here.
    EXPECT_LT(square, random_variance / 10000);
}

}  // namespace
}  // namespace wavelobe::test
