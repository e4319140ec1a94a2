// What the lights with a surface share: from a density over area to one over solid angle.
#ifndef WAVELOBE_LIGHTS_AREA_H
#define WAVELOBE_LIGHTS_AREA_H

#include "lights/radiance.h"

// Solid angle density, as seen from a distance, of points spread evenly over an area: distance^2 / (|cos| area).
// Zero where the surface is seen edge-on or touched: there no density is finite, and no light arrives.
INLINE Float area_light_pdf(Float distance_squared, Float cosine, Float inverse_area) {
    Float pdf = distance_squared * inverse_area / fabs(cosine);
    return SELECT(pdf < INFINITY, pdf, ZERO);
}

INLINE Float area_light_hit_pdf(LightInput in, Vec3 direction, Float t, Vec3 normal) {
    return area_light_pdf(t * t, dot3(direction, normal), light_field(in, inverse_area));
}

// The sample that a point on the surface makes; `u`, `v` are its texture coordinates.
INLINE LightSample area_light_sample(LightInput in, Vec3 reference, Vec3 point, Vec3 error, Vec3 normal, Float u, Float v) {
    Vec3 to_point = sub(point, reference);
    Float distance_squared = length_squared(to_point);
    LightSample s;
    s.direction = select3(distance_squared > 0.0f, scale(to_point, 1.0f / sqrt(distance_squared)), negate(normal));
    Float cosine = -dot3(s.direction, normal);
    s.point = point;
    s.error = error;
    s.normal = normal;
    s.at_infinity = !TRUE_MASK;
    s.pdf = area_light_pdf(distance_squared, cosine, light_field(in, inverse_area));
    s.radiance = select3((cosine > 0.0f) & (s.pdf > 0.0f), light_radiance(in, u, v), vec3_all(ZERO));
    s.delta = !TRUE_MASK;
    return s;
}

#endif
