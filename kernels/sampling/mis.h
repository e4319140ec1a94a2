// Weights of multiple importance sampling.
#ifndef WAVELOBE_SAMPLING_MIS_H
#define WAVELOBE_SAMPLING_MIS_H

#include "core/lanes.h"

// Weight of a sample that was drawn with density pdf_a and could have been drawn with pdf_b: power heuristic with
// exponent 2 (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation"). Depends on the ratio alone, so
// densities of any size are safe: an infinite one takes all the weight, two infinite ones share it, zero has none.
INLINE Float power_heuristic(Float pdf_a, Float pdf_b) {
    Float ratio = SELECT(pdf_a == pdf_b, ONE, pdf_b / pdf_a);
    return SELECT(pdf_a == 0.0f, ZERO, 1.0f / madd(ratio, ratio, ONE));
}

#endif
