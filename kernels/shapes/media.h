// Media that absorb: how much light they let through, and which one a ray is in once it leaves a surface.
#ifndef WAVELOBE_SHAPES_MEDIA_H
#define WAVELOBE_SHAPES_MEDIA_H

#include "core/math.h"
#include "shapes/surface.h"
#include "shared/media.h"

typedef struct {
    global const struct Medium *media;
    global const struct ShapeMedia *shape_media;
} MediaView;

// Of one colour: exp(-absorption distance). Where nothing absorbs, an infinite way takes nothing off.
INLINE Float channel_transmittance(Float absorption, Float distance) {
    return lane_exp(-SELECT(absorption > 0.0f, absorption * distance, ZERO));
}

// The share of light that is left after a way through a medium (Beer's law).
INLINE Rgb transmittance(MediaView m, UInt medium, Float distance) {
    UInt at = medium * RECORD_WORDS(Medium);
    global const float *absorption = (global const float *)m.media;
    return vec3(channel_transmittance(gather(absorption, at), distance),
                channel_transmittance(gather(absorption + 1, at), distance),
                channel_transmittance(gather(absorption + 2, at), distance));
}

// The medium on the side of the surface to which `direction` points: what the shape says, or else the one before it.
INLINE UInt medium_beyond(MediaView m, SurfaceView s, const Surface *surface, Vec3 direction, UInt before) {
    UInt flags = GATHER_UINT_FIELD(s.shapes, Shape, surface->shape, flags);
    Int parts = (flags & (UInt)SHAPE_PARTS_MEDIA) != (UInt)0u;
    Int outwards = dot3(surface->normal, direction) > 0.0f;
    UInt interior = GATHER_UINT_FIELD(m.shape_media, ShapeMedia, surface->shape, interior);
    UInt exterior = GATHER_UINT_FIELD(m.shape_media, ShapeMedia, surface->shape, exterior);
    return SELECT(parts, SELECT(outwards, exterior, interior), before);
}

#endif
