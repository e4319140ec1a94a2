// A point that shines evenly in all directions.  Fields: radiance (intensity, W / sr), position, inverse_range.
#ifndef WAVELOBE_LIGHTS_POINT_H
#define WAVELOBE_LIGHTS_POINT_H

#include "lights/light.h"

// Whether some light of the scene has a range.
#ifndef HAS_LIGHT_RANGE
#define HAS_LIGHT_RANGE 1
#endif

// The sample of a light at one point: `intensity` over the squared distance.
INLINE LightSample point_light_sample(Vec3 reference, Vec3 position, Rgb intensity) {
    Vec3 to_point = sub(position, reference);
    Float distance_squared = length_squared(to_point);
    Int apart = distance_squared > 0.0f;
    LightSample s;
    s.direction = select3(apart, scale(to_point, 1.0f / sqrt(distance_squared)), vec3(ZERO, ZERO, ONE));
    s.point = position;
    s.error = vec3_all(ZERO);
    s.normal = vec3_all(ZERO);
    s.at_infinity = !TRUE_MASK;
    s.radiance = select3(apart, scale(intensity, 1.0f / distance_squared), vec3_all(ZERO));
    s.pdf = ONE;
    s.delta = TRUE_MASK;
    return s;
}

// Lessens a sample towards the light's range and ends it there: Khronos Group 2018, "KHR_lights_punctual", section "Range
// Property".
INLINE LightSample within_range(LightInput in, Vec3 reference, LightSample s) {
#if HAS_LIGHT_RANGE
    Float inverse_range = light_field(in, inverse_range);
    Float x = length_squared(sub(s.point, reference)) * (inverse_range * inverse_range);
    s.radiance = scale(s.radiance, GREATER(madd(-x, x, ONE), ZERO));
#endif
    return s;
}

INLINE LightSample point_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    return within_range(in, reference, point_light_sample(reference, light_vector(in, position), light_vector(in, radiance)));
}

#endif
