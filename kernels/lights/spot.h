// A point that shines in a cone about edge1: full intensity up to the beam's angle, then falling to zero at the cutoff:
// linearly with the angle, or smoothly.  Fields: radiance (intensity on the axis, W / sr, and a texture that scales it), position,
// edge1, cos_beam, cos_cutoff, smooth_cone, inverse_range; with a texture edge2 and normal, its two ways over the tangent of the
// cutoff.
#ifndef WAVELOBE_LIGHTS_SPOT_H
#define WAVELOBE_LIGHTS_SPOT_H

#include "lights/point.h"
#if HAS_TEXTURED_EMITTERS
#include "bsdf/texture.h"
#endif

// Whether some spot of the scene falls smoothly.
#ifndef HAS_SMOOTH_CONES
#define HAS_SMOOTH_CONES 1
#endif

// Share of the axial intensity that leaves along `direction`.
INLINE Float spot_falloff(LightInput in, Vec3 direction) {
    Vec3 axis = light_vector(in, edge1);
    Float cosine = dot3(direction, axis);
    Float cos_beam = light_field(in, cos_beam), cos_cutoff = light_field(in, cos_cutoff);
    // From sine and cosine, because the cosine alone hardly changes within a narrow beam.
    Float angle = lane_atan2(sqrt(length_squared(cross3(direction, axis))), cosine);
    Float beam = lane_acos(cos_beam), cutoff = lane_acos(cos_cutoff);
    Float ramp = (cutoff - angle) / (cutoff - beam);
    ramp = LESSER(GREATER(ramp, ZERO), ONE);
#if HAS_SMOOTH_CONES
    // Khronos Group 2018, "KHR_lights_punctual", section "Inner and Outer Cone Angles".
    Float linear_cosine = LESSER(GREATER((cosine - cos_cutoff) / (cos_beam - cos_cutoff), ZERO), ONE);
    Int smooth = as_UInt(light_field(in, smooth_cone)) != (UInt)0u;
    ramp = SELECT(smooth, linear_cosine * linear_cosine, ramp);
#endif
    return SELECT(cosine >= cos_beam, ONE, SELECT(cosine > cos_cutoff, ramp, ZERO));
}

#if HAS_TEXTURED_EMITTERS
// What the texture lets through along `direction`: it spans the square about the cone.
INLINE Rgb spot_texture(LightInput in, Vec3 direction) {
    UInt texture = as_UInt(light_word(in, WORD_OFFSET(Light, radiance) + 3u));
    Int textured = texture != (UInt)WAVELOBE_NONE;
    Float cosine = dot3(direction, light_vector(in, edge1));
    textured &= cosine > 0.0f;
    if (!any_lane(textured)) return vec3_all(ONE);
    Float u = madd(dot3(direction, light_vector(in, edge2)) / cosine, (Float)0.5f, (Float)0.5f);
    Float v = madd(dot3(direction, light_vector(in, normal)) / cosine, (Float)0.5f, (Float)0.5f);
    TextureBuffers buffers = {in.textures, in.texels};
    Rgb share = texture_rgb(buffers, SELECT(textured, texture, (UInt)0u), SELECT(textured, u, ZERO), SELECT(textured, v, ZERO));
    return select3(textured, share, vec3_all(ONE));
}
#endif

INLINE LightSample spot_sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    LightSample s = point_light_sample(reference, light_vector(in, position), light_vector(in, radiance));
    s.radiance = scale(s.radiance, spot_falloff(in, negate(s.direction)));
#if HAS_TEXTURED_EMITTERS
    s.radiance = mul(s.radiance, spot_texture(in, negate(s.direction)));
#endif
    return within_range(in, reference, s);
}

#endif
