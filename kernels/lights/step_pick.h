// A step of a running sum by one random number. Unlike an alias table this keeps the order of the numbers, so that samples that are
// well spread over [0, 1) stay so over the steps.
#ifndef WAVELOBE_LIGHTS_STEP_PICK_H
#define WAVELOBE_LIGHTS_STEP_PICK_H

#include "core/math.h"

typedef struct {
    UInt index;     // below the number of steps
    Float fraction; // where in the step, even over [0, 1)
} StepPick;

// Among `count` steps whose sums start at `first` with 0 and end with 1. One without height is never picked.
INLINE StepPick step_pick(global const float *sums, UInt first, uint count, Float u) {
    UInt low = (UInt)0u;
    uint stride = 1u;
    while (stride < count) stride <<= 1;
    for (stride >>= 1; stride > 0u; stride >>= 1) {
        UInt next = low + stride;
        Int within = next < (UInt)count;
        Float sum = gather(sums, first + SELECT(within, next, (UInt)0u));
        low = SELECT(within & (sum <= u), next, low);
    }
    Float below = gather(sums, first + low), above = gather(sums, first + low + 1u);
    StepPick p = {low, LESSER((u - below) / (above - below), (Float)BELOW_ONE)};
    return p;
}

#endif
