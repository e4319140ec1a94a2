// Parallel light along edge1.  Fields: radiance (irradiance of a surface facing it, W / m^2), edge1.
#ifndef WAVELOBE_LIGHTS_DIRECTIONAL_H
#define WAVELOBE_LIGHTS_DIRECTIONAL_H

#include "lights/infinite.h"

INLINE LightSample directional_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    return infinite_light_sample(negate(light_vector(in, edge1)), light_vector(in, radiance), ONE, TRUE_MASK);
}

#endif
