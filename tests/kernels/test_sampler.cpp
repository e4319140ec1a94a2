// Sample values: against an integer reference, and the net property of every pair in a pixel and in squares of pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "support/probe.h"
#include "support/sample_values.h"

namespace wavelobe::test {
namespace {

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
    for (auto [seed, digits] : {std::array{0u, 31u}, std::array{1u, 0u}, std::array{2u, 4u}, std::array{3u, 20u}, std::array{4u, 21u},
                                std::array{5u, 24u}, std::array{6u, 30u}, std::array{0xdeadbeefu, 10u}}) {
        const Samples s = sample(where, seed, digits);
        for (std::size_t i = 0; i < where.x.size(); ++i) {
            const auto expected = reference_pair(where.x[i], where.y[i], where.index[i], where.pair[i], seed, digits);
            ASSERT_EQ(s.a(i), expected[0]) << i << " " << digits;
            ASSERT_EQ(s.b(i), expected[1]) << i << " " << digits;
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
        const Samples s = sample(where, 5, 31, lanes);
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

// Whether the points of these samples, 2^m of them, lie one in each elementary interval.
testing::AssertionResult is_net(const Samples& s, const std::vector<std::size_t>& samples, int m) {
    for (int a = 0; a <= m; ++a) {
        std::vector<bool> taken(samples.size(), false);
        for (const std::size_t i : samples) {
            const std::size_t cell = (s.a(i) >> (24 - a) << (m - a)) | s.b(i) >> (24 - (m - a));
            if (taken[cell]) return testing::AssertionFailure() << "two points in one interval of 2^-" << a << " by 2^-" << m - a;
            taken[cell] = true;
        }
    }
    return testing::AssertionSuccess();
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
                    std::vector<std::size_t> samples(std::size_t{1} << m);
                    std::iota(samples.begin(), samples.end(), std::size_t{block} << m);
                    ASSERT_TRUE(is_net(s, samples, m)) << "start " << start << " m " << m;
                }
            }
        }
    }
}

// What is gained by sharing a sequence: each aligned square of 2^k by 2^k pixels has a net of its own, by any aligned run of its samples.
TEST(Sampler, SquaresOfPixelsAreNetsToo) {
    constexpr Word size = 64, digits = 2, count = 1u << digits;
    Where where;
    for (Word y = 0; y < size; ++y) {
        for (Word x = 0; x < size; ++x) {
            for (Word i = 0; i < count; ++i) where.add(3 * size + x, 5 * size + y, i, 1);
        }
    }
    const Samples s = sample(where, 7, digits);
    for (Word k = 0; k <= 5; ++k) {
        for (Word corner_y = 0; corner_y < size; corner_y += 1u << k) {
            for (Word corner_x = 0; corner_x < size; corner_x += 1u << k) {
                std::vector<std::size_t> samples;
                for (Word p = 0; p < 1u << (2 * k); ++p) {
                    const Word x = corner_x + (p & ((1u << k) - 1)), y = corner_y + (p >> k);
                    for (Word i = 0; i < count; ++i) samples.push_back((y * size + x) * count + i);
                }
                ASSERT_TRUE(is_net(s, samples, static_cast<int>(2 * k + digits))) << corner_x << " " << corner_y << " " << k;
            }
        }
    }
}

// No value serves twice: within a square the pixels have different runs of one sequence, and squares have different sequences.
TEST(Sampler, SharesSequencesAmongSquares) {
    for (Word digits : {0u, 1u, 10u, 20u, 22u, 29u, 31u}) {
        Where where;
        for (Word y = 0; y < 130; ++y) {
            for (Word x = 0; x < 130; ++x) where.add(x, y, (1u << digits) - 1, 0);
        }
        const Samples s = sample(where, 1, digits);
        std::vector<std::uint64_t> values;
        for (std::size_t i = 0; i < s.u1.size(); ++i) values.push_back(std::uint64_t{s.a(i)} << 24 | s.b(i));
        std::sort(values.begin(), values.end());
        // Of 130^2 random pairs of 24 bits, two are the same once in two million pictures.
        EXPECT_EQ(std::adjacent_find(values.begin(), values.end()), values.end()) << digits;
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
