// Weights of multiple importance sampling.
#ifndef WAVELOBE_SAMPLING_MIS_H
#define WAVELOBE_SAMPLING_MIS_H

#include "core/lanes.h"

// Which samples find direct light: both, weighted against each other; or one kind alone, to compare with.
#define ESTIMATOR_MIS 0
#define ESTIMATOR_BSDF 1
#define ESTIMATOR_LIGHT 2
#ifndef ESTIMATOR
#define ESTIMATOR ESTIMATOR_MIS
#endif

// Weight of a sample that was drawn with density pdf_a and could have been drawn with pdf_b: power heuristic with
// exponent 2 (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation"). Depends on the ratio alone, so
// densities of any size are safe: an infinite one takes all the weight, two infinite ones share it, zero has none.
INLINE Float inverse_power_heuristic(Float pdf_a, Float pdf_b) {
    Float ratio = SELECT(pdf_a == pdf_b, ONE, pdf_b / pdf_a);
    return madd(ratio, ratio, ONE);
}

INLINE Float power_heuristic(Float pdf_a, Float pdf_b) {
    return SELECT(pdf_a == 0.0f, ZERO, 1.0f / inverse_power_heuristic(pdf_a, pdf_b));
}

// Of a light sample: its weight over its density, which is finite and positive. No BSDF sample finds a delta light.
INLINE Float light_sample_share(Float pdf_light, Float pdf_bsdf, Int delta) {
#if ESTIMATOR == ESTIMATOR_MIS
    return 1.0f / (pdf_light * SELECT(delta, ONE, inverse_power_heuristic(pdf_light, pdf_bsdf)));
#else
    return SELECT(delta | (Int)(ESTIMATOR == ESTIMATOR_LIGHT ? -1 : 0), 1.0f / pdf_light, ZERO);
#endif
}

// Weight of a light that a BSDF sample found.
INLINE Float bsdf_sample_weight(Float pdf_bsdf, Float pdf_light) {
#if ESTIMATOR == ESTIMATOR_MIS
    return power_heuristic(pdf_bsdf, pdf_light);
#else
    return ESTIMATOR == ESTIMATOR_BSDF ? ONE : ZERO;
#endif
}

#endif
