// From the unit square to the shapes that are sampled. All warps are continuous enough to keep the stratification of
// their samples.
#ifndef WAVELOBE_SAMPLING_WARPS_H
#define WAVELOBE_SAMPLING_WARPS_H

#include "core/math.h"
#include "core/vector.h"

// The unit disk, area preserving. Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square".
INLINE void sample_concentric_disk(Float u1, Float u2, Float *x, Float *y) {
    Float a = madd(u1, (Float)2.0f, (Float)-1.0f), b = madd(u2, (Float)2.0f, (Float)-1.0f);
    Int first = fabs(a) > fabs(b);
    Float radius = SELECT(first, a, b), other = SELECT(first, b, a);
    // Eighth turns, measured from the x axis in two of the quadrants and from the y axis in the others.
    Float turn = 0.125f * SELECT(radius == 0.0f, ZERO, other / SELECT(radius == 0.0f, ONE, radius));
    Float s, c;
    lane_sin_cos_turns(turn, &s, &c);
    *x = radius * SELECT(first, c, s);
    *y = radius * SELECT(first, s, c);
}

// Density cos / pi over solid angle about +z. Malley's method.
INLINE Vec3 sample_cosine_hemisphere(Float u1, Float u2) {
    Float x, y;
    sample_concentric_disk(u1, u2, &x, &y);
    Float z2 = 1.0f - madd(x, x, y * y);
    return vec3(x, y, sqrt(GREATER(z2, ZERO)));
}

// Density 1 / (4 pi).
INLINE Vec3 sample_uniform_sphere(Float u1, Float u2) {
    Float z = madd(u1, (Float)-2.0f, ONE);
    Float r = 2.0f * sqrt(u1 * (1.0f - u1)); // without the cancellation of 1 - z^2
    Float s, c;
    lane_sin_cos_turns(u2, &s, &c);
    return vec3(r * c, r * s, z);
}

// Inverse distribution of a pixel filter, tabulated at equal steps of probability by host/tables/filter_table.h; linear
// in between. Returns the offset from the pixel's centre.
#define FILTER_STEPS 1024u
INLINE Float sample_filter(global const float *table, Float u) {
    Float at = u * (float)FILTER_STEPS;
    UInt i = as_UInt(convert_Int(at));
    Float low = gather(table, i), high = gather(table + 1, i);
    return madd(high - low, at - convert_Float(as_Int(i)), low);
}

#endif
