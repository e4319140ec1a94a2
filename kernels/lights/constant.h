// The same radiance from every direction, sampled evenly over the sphere of directions.
// Uses Environment.radiance, W / (m^2 sr).
#ifndef WAVELOBE_LIGHTS_CONSTANT_H
#define WAVELOBE_LIGHTS_CONSTANT_H

#include "lights/infinite.h"
#include "sampling/warps.h"

INLINE Rgb constant_radiance(LightInput in, Vec3 direction) {
    global const struct Packed3 *radiance = &in.environment->radiance;
    return vec3((Float)radiance->x, (Float)radiance->y, (Float)radiance->z);
}

INLINE Float constant_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    return (Float)INV_FOUR_PI_F;
}

INLINE LightSample constant_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    Vec3 direction = square_to_uniform_sphere(u1, u2);
    return infinite_light_sample(direction, constant_radiance(in, direction), (Float)INV_FOUR_PI_F, !TRUE_MASK);
}

#endif
