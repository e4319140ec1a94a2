// Sixteen consecutive words for each lane, as sixteen vectors of one word of every lane: a load a lane and a transposition cost a third of
// what six gathers do.
#ifndef WAVELOBE_CORE_ROWS_H
#define WAVELOBE_CORE_ROWS_H

#include "core/lanes.h"
#include "shared/types.h"

typedef struct {
    Float word[ROW_WORDS];
} Rows;

#if LANES == 16
// Of two rows a and b the words by pairs of one, and by pairs of two, from the lower or upper halves of each four words; then by fours.
#define ONES_LOW(a, b) __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
#define ONES_HIGH(a, b) __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
#define TWOS_LOW(a, b) __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
#define TWOS_HIGH(a, b) __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)
#define FOURS_EVEN(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)
#define FOURS_ODD(a, b) __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31)

// Words 4 i + k of rows 4 r to 4 r + 3 are the i-th four words of out[4 * r + k].
INLINE void transpose_fours(const Float *row, Float *out) {
#pragma unroll
    for (uint r = 0u; r < 16u; r += 4u) {
        Float low0 = ONES_LOW(row[r], row[r + 1u]), high0 = ONES_HIGH(row[r], row[r + 1u]);
        Float low1 = ONES_LOW(row[r + 2u], row[r + 3u]), high1 = ONES_HIGH(row[r + 2u], row[r + 3u]);
        out[r] = TWOS_LOW(low0, low1), out[r + 1u] = TWOS_HIGH(low0, low1);
        out[r + 2u] = TWOS_LOW(high0, high1), out[r + 3u] = TWOS_HIGH(high0, high1);
    }
}

INLINE void transpose(const Float *row, Rows *rows) {
    Float fours[16];
    transpose_fours(row, fours);
#pragma unroll
    for (uint k = 0u; k < 4u; k++) {
        Float even_low = FOURS_EVEN(fours[k], fours[4u + k]), odd_low = FOURS_ODD(fours[k], fours[4u + k]);
        Float even_high = FOURS_EVEN(fours[8u + k], fours[12u + k]), odd_high = FOURS_ODD(fours[8u + k], fours[12u + k]);
        rows->word[k] = FOURS_EVEN(even_low, even_high), rows->word[8u + k] = FOURS_ODD(even_low, even_high);
        rows->word[4u + k] = FOURS_EVEN(odd_low, odd_high), rows->word[12u + k] = FOURS_ODD(odd_low, odd_high);
    }
}
#endif

// word[k] of each lane is p[i + k].
INLINE void gather_rows(global const float *p, UInt i, Rows *rows) {
#if LANES == 16
    LaneUints at = lane_uints(i);
    Float row[ROW_WORDS];
#pragma unroll
    for (uint k = 0u; k < ROW_WORDS; k++) row[k] = load(p + at.value[k]);
    transpose(row, rows);
#else
#pragma unroll
    for (uint k = 0u; k < ROW_WORDS; k++) rows->word[k] = gather(p + k, i);
#endif
}

#endif
