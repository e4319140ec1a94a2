// Sample values: Owen-scrambled Sobol points in padded pairs of dimensions, all from hashes of where they are used, so
// that a value is a function of (pixel, sample index, pair, sequence) alone.
//
// Squares of pixels share one sequence, of which each pixel has a run, in Morton order: as the samples of a run are well
// spread, so are those of 2 x 2, 4 x 4 ... pixels together, and what is left of the noise is fine-grained, which eyes and
// denoisers mind least. Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
// Hierarchical Ordering of Pixels"; there the order is scrambled, here the sequence is.
//
// Burley 2020, "Practical Hash-based Owen Scrambling". Each pair is the first two Sobol dimensions: a (0, 2)-sequence,
// which scrambling keeps; nested uniform shuffling of the index makes pairs independent of each other.
#ifndef WAVELOBE_SAMPLING_SAMPLER_H
#define WAVELOBE_SAMPLING_SAMPLER_H

#include "core/lanes.h"
#include "shared/scene.h"

#define LARGEST_SQUARE 6u // binary digits of the pixels along a side: in larger ones nothing more is gained

typedef struct {
    UInt square_hash; // of the square of pixels and the seed
    UInt reversed_index;
} SampleId;

INLINE UInt reverse_bits(UInt x) {
    x = ((x >> 1) & (UInt)0x55555555u) | ((x & (UInt)0x55555555u) << 1);
    x = ((x >> 2) & (UInt)0x33333333u) | ((x & (UInt)0x33333333u) << 2);
    x = ((x >> 4) & (UInt)0x0f0f0f0fu) | ((x & (UInt)0x0f0f0f0fu) << 4);
    x = ((x >> 8) & (UInt)0x00ff00ffu) | ((x & (UInt)0x00ff00ffu) << 8);
#ifdef __SPIR__ // tools that interpret code for SPIR lack the reversal that a compiler recognises in the other form
    return rotate(x, (UInt)16u);
#else
    return (x >> 16) | (x << 16);
#endif
}

// A bijection in which each bit of the result depends on every bit of x: the multiply-xorshift finaliser of MurmurHash3
// (Appleby 2011) with the shifts and factors Wellons found in 2018 to have the least bias ("Prospecting for Hash
// Functions").
INLINE UInt mix_bits(UInt x) {
    x = (x ^ (x >> 16)) * (UInt)0x21f0aaadu;
    x = (x ^ (x >> 15)) * (UInt)0xd35a2d97u;
    return x ^ (x >> 15);
}

// The next of several seeds drawn from one well-mixed hash.
INLINE UInt next_seed(UInt h) { return (h ^ (h >> 16)) * (UInt)0x7feb352du; }

// Owen scrambling of a number whose bits are reversed: a bit flips by a hash of the bits below it. Laine and Karras
// 2011, "Stratified Sampling for Stochastic Transparency", with the rounds and factors of Vegdahl 2021, "Building a
// Better LK Hash", but the seed is added before the first round: the low bits of few indices are zero, which wasted that
// round, and one pair in a thousand was closer to another than random scrambling makes them.
INLINE UInt scramble_reversed(UInt x, UInt seed) {
    x += seed;
    x ^= x * (UInt)0x3d20adeau;
    x *= (seed >> 16) | (UInt)1u;
    x ^= x * (UInt)0x05526c56u;
    x ^= x * (UInt)0x53a22864u;
    return x;
}

// The second Sobol dimension of an index, bits reversed. Its matrix is Pascal's triangle modulo 2, where entry (j, k) is
// odd if and only if k is a bitwise subset of j (Lucas 1878): bit k is the parity of the index bits at supersets of k,
// a butterfly of five steps.
INLINE UInt sobol_second_reversed(UInt index) {
    index ^= (index >> 1) & (UInt)0x55555555u;
    index ^= (index >> 2) & (UInt)0x33333333u;
    index ^= (index >> 4) & (UInt)0x0f0f0f0fu;
    index ^= (index >> 8) & (UInt)0x00ff00ffu;
    return index ^ (index >> 16);
}

// The upper 24 bits as a multiple of 2^-24 in [0, 1).
INLINE Float unit_float(UInt bits) { return convert_Float(as_Int(bits >> 8)) * 5.9604644775390625e-8f; }

// The bits of x and y, below 2^8, in turn.
INLINE UInt morton(UInt x, UInt y) {
    UInt both = x | y << 16;
    both = (both | both << 4) & (UInt)0x0f0f0f0fu;
    both = (both | both << 2) & (UInt)0x33333333u;
    both = (both | both << 1) & (UInt)0x55555555u;
    return (both | both >> 15) & (UInt)0xffffu;
}

// The sample of one path: `index` counts the samples of its pixel, below 2^digits of the sequence.
INLINE SampleId sample_id(UInt x, UInt y, UInt index, struct SampleSequence sequence) {
    uint side = min(LARGEST_SQUARE, (32u - sequence.digits) / 2u);
    UInt inside = (UInt)((1u << side) - 1u);
    SampleId id;
    id.square_hash = mix_bits(mix_bits(mix_bits((UInt)sequence.seed) + (x >> side)) + (y >> side));
    id.reversed_index = reverse_bits(index + (morton(x & inside, y & inside) << sequence.digits));
    return id;
}

// Two values of the 2D pair number `pair`, in [0, 1).
INLINE void sample_2d(SampleId id, UInt pair, Float *u1, Float *u2) {
    UInt shuffle_seed = mix_bits(id.square_hash + pair * (UInt)0x9e3779b9u); // golden ratio: spreads small counts
#if INDEPENDENT_SAMPLES // to compare with: every sample drawn by itself
    UInt h = mix_bits(shuffle_seed + mix_bits(id.reversed_index + (UInt)0x9e3779b9u));
    *u1 = unit_float(h);
    *u2 = unit_float(mix_bits(h + (UInt)0x9e3779b9u));
    return;
#endif
    UInt seed1 = next_seed(shuffle_seed);
    UInt seed2 = next_seed(seed1);
    UInt index = reverse_bits(scramble_reversed(id.reversed_index, shuffle_seed));
    // The first Sobol dimension is the index with its bits reversed: reversed, the index itself.
    *u1 = unit_float(reverse_bits(scramble_reversed(index, seed1)));
    *u2 = unit_float(reverse_bits(scramble_reversed(sobol_second_reversed(index), seed2)));
}

#endif
