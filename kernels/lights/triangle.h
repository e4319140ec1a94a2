// A triangle that emits on the side of its normal.  Fields: radiance, position, edge1, edge2, normal, inverse_area, uv.
#ifndef WAVELOBE_LIGHTS_TRIANGLE_H
#define WAVELOBE_LIGHTS_TRIANGLE_H

#include "lights/area.h"
#include "sampling/warps.h"

// Of 2 pi: what is seen under a larger solid angle is touched, and sampled evenly over its area.
#define MOST_SOLID_ANGLE 6.25f

// Texture coordinates of the point position + b1 edge1 + b2 edge2 from those of the corners, which are three of a triangle (of half a parallelogram).
INLINE Float planar_light_uv(LightInput in, uint component, Float b1, Float b2) {
    Float uv0 = light_word(in, WORD_OFFSET(Light, uv) + component);
    Float uv1 = light_word(in, WORD_OFFSET(Light, uv) + 2u + component);
    Float uv2 = light_word(in, WORD_OFFSET(Light, uv) + 4u + component);
    return madd(uv1 - uv0, b1, madd(uv2 - uv0, b2, uv0));
}

// The point position + b1 edge1 + b2 edge2 of a triangle or parallelogram; `solid_angle` as in area_light_sample.
INLINE LightSample planar_light_sample(LightInput in, Vec3 reference, Float b1, Float b2, Float solid_angle) {
    PlanarLight l = planar_light(in);
    Vec3 p0 = l.position, e1 = l.edge1, e2 = l.edge2;
    Vec3 point = scale_add(e1, b1, scale_add(e2, b2, p0));
    // Two products, two sums and the edges' own rounding: five roundings where nothing is fused.
    Vec3 magnitude = scale_add(absolute(e1), b1, scale_add(absolute(e2), b2, absolute(p0)));
    return area_light_sample(in, reference, point, scale(magnitude, (Float)GAMMA(6)), l.normal, planar_light_uv(in, 0u, b1, b2), planar_light_uv(in, 1u, b1, b2),
                             solid_angle);
}

INLINE LightSample triangle_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    Vec2 b = square_to_triangle(u1, u2);
    return planar_light_sample(in, reference, b.x, b.y, ZERO);
}

INLINE Float triangle_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    return area_light_hit_pdf(in, direction, t, normal);
}

#endif
