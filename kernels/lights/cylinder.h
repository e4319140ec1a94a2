// The mantle of a cylinder that emits on the side of its normal, sampled evenly over its area.  Its map scales both
// directions across the axis alike, so that what is even on the unit cylinder stays even.
// Fields: radiance, analytic, inverse_area.
#ifndef WAVELOBE_LIGHTS_CYLINDER_H
#define WAVELOBE_LIGHTS_CYLINDER_H

#include "lights/analytic.h"

INLINE LightSample cylinder_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    Float sine, cosine;
    lane_sin_cos_turns(u1, &sine, &cosine);
    return analytic_light_sample(in, reference, vec3(cosine, sine, u2), vec3(cosine, sine, ZERO));
}

INLINE Float cylinder_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    return area_light_hit_pdf(in, direction, t, normal);
}

#endif
