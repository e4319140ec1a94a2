// Which pair of sample dimensions serves what: a value is a function of (pixel, sample, pair, seed) alone.
#ifndef WAVELOBE_STAGES_DIMENSIONS_H
#define WAVELOBE_STAGES_DIMENSIONS_H

#include "core/block.h"
#include "sampling/sampler.h"
#include "shared/scene.h"

#define PAIR_FILM 0u
#if HAS_THIN_LENS
#define PAIR_LENS 1u // point on the lens
#define PAIRS_BEFORE_PATH 2u
#else
#define PAIRS_BEFORE_PATH 1u
#endif
#define PAIRS_PER_VERTEX (4u + HAS_BLENDS)
#define PAIR_LIGHT 0u     // point on the light
#define PAIR_DIRECTION 1u // direction of the lobe
#define PAIR_CHOICE 2u    // which light; reflection or refraction
#define PAIR_SURVIVAL 3u  // which class of lobes; Russian roulette
#define PAIR_BLEND 4u     // which of two materials

// How many binary digits number `count` things.
INLINE uint digits_of(uint count) { return 32u - clz(count - 1u); }

// Of `parts` samples in place of each of the path's pixel, number `part` of those in place of the path's own.
INLINE SampleId path_sample_part(Block block, UInt id, struct SampleSequence sequence, UInt part, uint parts) {
    UInt sample = path_sample(block, id);
    sequence.digits = min(sequence.digits + digits_of(parts), SEQUENCE_A_PIXEL);
#if HAS_ERROR_ESTIMATE
    // Two pictures that share no random number.
    sample = HALF_INDEX(sample);
    sequence.seed ^= HALF_OF(block.header->first_sample) * 0x9e3779b9u;
#endif
    return sample_id(path_pixel_x(block, id), path_pixel_y(block, id), sample * (UInt)parts + part, sequence);
}

INLINE SampleId path_sample_id(Block block, UInt id, struct SampleSequence sequence) {
    return path_sample_part(block, id, sequence, (UInt)0u, 1u);
}

INLINE UInt vertex_pair(UInt depth, uint pair) { return depth * PAIRS_PER_VERTEX + (UInt)(PAIRS_BEFORE_PATH + pair); }

#endif
