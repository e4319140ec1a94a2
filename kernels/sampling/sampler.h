// Owen-scrambled Sobol points by hashing, in padded pairs of dimensions.
// Burley 2020, "Practical Hash-Based Owen Scrambling"; constants of the hash by Vegdahl 2021.
//
// A value is a function of (pixel, sample index, pair, seed) alone. Each pair shuffles the index by a nested uniform
// scramble, takes the first two Sobol dimensions there, and scrambles both: within a pair the first 2^k samples of a pixel
// are a (0, 2)-net, between pairs and pixels there is no structure.
#ifndef WAVELOBE_SAMPLING_SAMPLER_H
#define WAVELOBE_SAMPLING_SAMPLER_H

#include "core/lanes.h"

typedef struct {
    UInt pixel_hash;
    UInt reversed_index; // bits of the sample index in reverse order
} SampleId;

// Finalizer of MurmurHash3 (Appleby 2011): every input bit reaches every output bit.
INLINE UInt mix_bits(UInt h) {
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    return h ^ (h >> 16);
}

INLINE UInt reverse_bits(UInt x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// A permutation in which each bit depends on the bits below it alone: on reversed bits, an Owen scramble
// (Laine and Karras 2011, "Stratified Sampling for Stochastic Transparency").
INLINE UInt permute_upwards(UInt x, UInt seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

// The second Sobol dimension of an index, bits reversed: bit j is the sum modulo 2 of the index bits k with C(k, j) odd,
// which by Lucas' theorem are the k that contain j as a set of bits. Five steps sum over all supersets.
INLINE UInt second_dimension_reversed(UInt x) {
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    return x ^ ((x >> 16) & 0x0000ffffu);
}

INLINE SampleId sample_id(UInt x, UInt y, UInt index, uint seed) {
    SampleId id;
    id.pixel_hash = mix_bits(x ^ mix_bits(y ^ mix_bits((UInt)(seed + 0x9e3779b9u))));
    id.reversed_index = reverse_bits(index);
    return id;
}

// To [0, 1): multiples of 2^-24, so that 1 is never reached.
INLINE Float unit_float(UInt bits) { return convert_Float(as_Int(bits >> 8)) * 0x1p-24f; }

INLINE void sample_2d(SampleId id, UInt pair, Float *u1, Float *u2) {
    UInt shuffle = mix_bits(id.pixel_hash ^ (pair * 0x9e3779b9u));
    UInt seed1 = mix_bits(shuffle ^ 0x68bc21ebu), seed2 = mix_bits(shuffle ^ 0x02e5be93u);
    UInt index = reverse_bits(permute_upwards(id.reversed_index, shuffle));
    // The first dimension of an index is its reversal: reversed, the index itself.
    *u1 = unit_float(reverse_bits(permute_upwards(index, seed1)));
    *u2 = unit_float(reverse_bits(permute_upwards(second_dimension_reversed(index), seed2)));
}

#endif
