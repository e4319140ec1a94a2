// A disk (an ellipse where the map stretches it) that emits on the side of its normal, sampled evenly over its area: an
// affine map keeps even what is even in a plane.  Fields: radiance, analytic, inverse_area.
#ifndef WAVELOBE_LIGHTS_DISK_H
#define WAVELOBE_LIGHTS_DISK_H

#include "lights/analytic.h"
#include "sampling/warps.h"

INLINE LightSample disk_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    Vec2 d = square_to_disk(u1, u2);
    return analytic_light_sample(in, reference, vec3(d.x, d.y, ZERO), vec3(ZERO, ZERO, ONE));
}

INLINE Float disk_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    return area_light_hit_pdf(in, direction, t, normal);
}

#endif
