// What the lights with a surface share: from a density over area to one over solid angle.
#ifndef WAVELOBE_LIGHTS_AREA_H
#define WAVELOBE_LIGHTS_AREA_H

#include "lights/radiance.h"

// Zero where the surface is seen edge-on or touched: there no density is finite, and no light arrives.
INLINE Float finite_density(Float pdf) { return SELECT(pdf < INFINITY, pdf, ZERO); }

// Solid angle density, as seen from a distance, of points spread evenly over an area: distance^2 / (|cos| area).
INLINE Float area_light_hit_pdf(LightInput in, Vec3 direction, Float t, Vec3 normal) {
    return finite_density(t * t * light_field(in, inverse_area) / fabs(dot3(direction, normal)));
}

// The sample that a point on the surface makes; `u`, `v` are its texture coordinates. `solid_angle`: over which directions are spread
// evenly; zero: points are, over the area.
INLINE LightSample area_light_sample(LightInput in, Vec3 reference, Vec3 point, Vec3 error, Vec3 normal, Float u, Float v, Float solid_angle) {
    Vec3 to_point = sub(point, reference);
    Float distance_squared = length_squared(to_point);
    LightSample s;
    s.direction = select3(distance_squared > 0.0f, scale(to_point, 1.0f / sqrt(distance_squared)), negate(normal));
    Float cosine = -dot3(s.direction, normal);
    s.point = point;
    s.error = error;
    s.normal = normal;
    s.at_infinity = !TRUE_MASK;
    Int by_area = solid_angle == 0.0f;
    Float pdf = SELECT(by_area, distance_squared * light_field(in, inverse_area), ONE) / SELECT(by_area, fabs(cosine), solid_angle);
    s.pdf = SELECT(distance_squared > 0.0f, finite_density(pdf), ZERO);
    s.radiance = select3((cosine > 0.0f) & (s.pdf > 0.0f), light_radiance(in, u, v), vec3_all(ZERO));
    s.delta = !TRUE_MASK;
    return s;
}

#endif
