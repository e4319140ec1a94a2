// Radiance of area lights: a constant or a texture over the surface.
#ifndef WAVELOBE_LIGHTS_RADIANCE_H
#define WAVELOBE_LIGHTS_RADIANCE_H

#include "lights/light.h"

// With HAS_TEXTURED_EMITTERS goes HAS_TEXTURES, which brings bsdf/texture.h.
// Towards any direction on the emitting side, at texture coordinates (u, v); W / (m^2 sr).
INLINE Rgb light_radiance(LightInput in, Float u, Float v) {
    Rgb radiance = light_vector(in, radiance);
#if HAS_TEXTURED_EMITTERS
    UInt texture = as_UInt(light_word(in, WORD_OFFSET(Light, radiance) + 3u));
    Int textured = texture != (UInt)WAVELOBE_NONE;
    if (any_lane(textured)) {
        TextureBuffers buffers = {in.textures, in.texels};
        radiance = select3(textured, texture_rgb(buffers, SELECT(textured, texture, (UInt)0u), u, v), radiance);
    }
#endif
    return radiance;
}

#endif
