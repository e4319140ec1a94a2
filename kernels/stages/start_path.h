// The first ray of a path, from the camera or from a light.
#ifndef WAVELOBE_STAGES_START_PATH_H
#define WAVELOBE_STAGES_START_PATH_H

#include "core/block.h"
#include "shared/bvh.h"
#include "shared/scene.h"

// Appends the lanes' rays, no longer than `length`; returns the new count. They leave no primitive, and no lobe chose their direction.
// `depth`: 0, or EMISSION_DEPTH.
INLINE uint append_first_rays(Queue rays, uint at, global const struct RenderParameters *p, Vec3 origin, Vec3 direction, Float length,
                              UInt id, Float throughput, uint depth, uint bits) {
    append_vec3(rays, PATH_ORIGIN, at, origin, bits);
    append_vec3(rays, PATH_DIRECTION, at, direction, bits);
    append_field(rays, PATH_T, at, length, bits);
    append_uint(rays, PATH_HIT, at, (UInt)HIT_NONE, bits);
    append_vec3(rays, PATH_THROUGHPUT, at, vec3_all(throughput), bits);
    append_field(rays, PATH_PDF, at, (Float)-1.0f, bits);
    append_uint(rays, PATH_ID, at, id, bits);
    append_uint(rays, PATH_DEPTH, at, (UInt)depth, bits);
#if HAS_MEDIA
    append_uint(rays, PATH_MEDIUM, at, (UInt)p->camera_medium, bits);
#endif
#if HAS_PATH_ETA
    append_field(rays, PATH_ETA, at, ONE, bits);
#endif
    return at + popcount(bits);
}

#endif
