// Scrambled Sobol points bit by bit, as the papers define them, and true random scrambling to compare with.
#pragma once

#include <array>
#include <cstdint>

namespace wavelobe::test {

using Word = std::uint32_t;

inline Word reversed(Word x) {
    Word y = 0;
    for (int i = 0; i < 32; ++i) y |= (x >> i & 1u) << (31 - i);
    return y;
}

// Generator columns of the first two Sobol dimensions (Joe and Kuo 2008): the identity, and 1 + x with m = 1.
inline Word sobol(Word index, int dimension) {
    Word column = 0x80000000u, value = 0;
    for (; index != 0; index >>= 1) {
        if ((index & 1u) != 0) value ^= column;
        column = dimension == 0 ? column >> 1 : column ^ (column >> 1);
    }
    return value;
}

inline Word mixed(Word x) {
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0xd35a2d97u;
    return x ^ (x >> 15);
}

inline Word next(Word seed) { return (seed ^ (seed >> 16)) * 0x7feb352du; }

inline Word nested_uniform_scramble(Word x, Word seed) {
    x = reversed(x);
    x += seed;
    x ^= x * 0x3d20adeau;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reversed(x);
}

// The number of a pixel in Morton order of a square of 2^side by 2^side pixels.
inline Word morton_number(Word x, Word y, Word side) {
    Word number = 0;
    for (Word i = 0; i < side; ++i) number |= (x >> i & 1u) << (2 * i) | (y >> i & 1u) << (2 * i + 1);
    return number;
}

// The two values of a pair, as multiples of 2^-24.
inline std::array<Word, 2> reference_pair(Word x, Word y, Word index, Word pair, Word seed, Word digits) {
    const Word side = digits >= 31 ? 0 : digits <= 20 ? 6 : (32 - digits) / 2;
    const Word shuffle = mixed(mixed(mixed(mixed(seed) + (x >> side)) + (y >> side)) + pair * 0x9e3779b9u);
    index += morton_number(x, y, side) << digits;
    const Word seed1 = next(shuffle), seed2 = next(seed1);
    const Word shuffled = nested_uniform_scramble(index, shuffle);
    return {nested_uniform_scramble(sobol(shuffled, 0), seed1) >> 8, nested_uniform_scramble(sobol(shuffled, 1), seed2) >> 8};
}

// SplitMix64 (Steele, Lea, Flood 2014).
inline std::uint64_t strong_hash(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

// Owen's scrambling by its definition: each bit from `highest` to `lowest` flips at random, independently for each value of
// the bits above it.
inline Word owen_scramble(Word x, std::uint64_t seed, int highest, int lowest) {
    Word result = x;
    for (int bit = highest; bit >= lowest; --bit) {
        const std::uint64_t above = std::uint64_t{x} >> (bit + 1);
        const auto node = strong_hash(seed * 64 + static_cast<std::uint64_t>(bit)) + above;
        result ^= static_cast<Word>(strong_hash(node) & 1u) << bit;
    }
    return result;
}

}  // namespace wavelobe::test
