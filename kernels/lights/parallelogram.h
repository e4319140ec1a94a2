// A parallelogram that emits on the side of its normal.  Fields: radiance, position (a corner), edge1, edge2 (the sides
// from it), normal, inverse_area, uv (of the corner and of the ends of edge1 and edge2).
#ifndef WAVELOBE_LIGHTS_PARALLELOGRAM_H
#define WAVELOBE_LIGHTS_PARALLELOGRAM_H

#include "lights/triangle.h"

INLINE LightSample parallelogram_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    return planar_light_sample(in, reference, u1, u2, ZERO);
}

INLINE Float parallelogram_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    return area_light_hit_pdf(in, direction, t, normal);
}

#endif
