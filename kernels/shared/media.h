// What fills space: media that absorb and do not scatter.
#ifndef WAVELOBE_SHARED_MEDIA_H
#define WAVELOBE_SHARED_MEDIA_H

#include "shared/types.h"

struct Medium {
    struct Packed3 absorption; // 1 / m
};
WAVELOBE_CHECK_SIZE(Medium, 12);

#define MEDIUM_VACUUM 0u // the first of them

// What lies on the two sides of a shape that parts media; one record a shape, in scenes with media.
struct ShapeMedia {
    Uint32 interior; // behind its normal
    Uint32 exterior;
};
WAVELOBE_CHECK_SIZE(ShapeMedia, 8);

#endif
