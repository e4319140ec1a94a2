// Multiple importance sampling. Veach and Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering".
#ifndef WAVELOBE_SAMPLING_MIS_H
#define WAVELOBE_SAMPLING_MIS_H

#include "core/lanes.h"

// The power heuristic (exponent 2) for a sample made with density pdf_a that pdf_b could have made too. The ratio is
// squared, not the densities: those of small lights and sharp lobes would overflow.
INLINE Float power_heuristic(Float pdf_a, Float pdf_b) {
    Float ratio = pdf_b / pdf_a;
    Float weight = 1.0f / madd(ratio, ratio, ONE);
    return SELECT(pdf_a > 0.0f, weight, ZERO);
}

#endif
