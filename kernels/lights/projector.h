// A point that throws a picture, as a perspective camera there would see it: on a plane at distance one that faces it, the
// irradiance is pi times the picture.  Fields: radiance (the picture), inverse_area (scale and pi), position, edge1 (axis, unit),
// edge2 and normal (the ways to the picture's left and upper edge, over the tangents of half the angles).
#ifndef WAVELOBE_LIGHTS_PROJECTOR_H
#define WAVELOBE_LIGHTS_PROJECTOR_H

#include "lights/point.h"
#include "lights/radiance.h"

INLINE LightSample projector_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    LightSample s = point_light_sample(reference, light_vector(in, position), vec3_all(ONE));
    Vec3 direction = negate(s.direction);
    Float cosine = dot3(direction, light_vector(in, edge1));
    Float u = madd(dot3(direction, light_vector(in, edge2)) / cosine, (Float)-0.5f, (Float)0.5f);
    Float v = madd(dot3(direction, light_vector(in, normal)) / cosine, (Float)-0.5f, (Float)0.5f);
    Int inside = (cosine > 0.0f) & (u >= 0.0f) & (u <= 1.0f) & (v >= 0.0f) & (v <= 1.0f);
    u = SELECT(inside, u, ZERO);
    v = SELECT(inside, v, ZERO);
    Rgb intensity = scale(light_radiance(in, u, v), light_field(in, inverse_area) / (cosine * cosine * cosine));
    s.radiance = select3(inside, mul(s.radiance, intensity), vec3_all(ZERO));
    return s;
}

#endif
