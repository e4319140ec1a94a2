// What the lights without a place share.
#ifndef WAVELOBE_LIGHTS_INFINITE_H
#define WAVELOBE_LIGHTS_INFINITE_H

#include "lights/light.h"

INLINE LightSample infinite_light_sample(Vec3 direction, Rgb radiance, Float pdf, Int delta) {
    LightSample s;
    s.direction = direction;
    s.point = vec3_all(ZERO);
    s.error = vec3_all(ZERO);
    s.normal = vec3_all(ZERO);
    s.at_infinity = TRUE_MASK;
    s.radiance = radiance;
    s.pdf = pdf;
    s.delta = delta;
    return s;
}

#endif
