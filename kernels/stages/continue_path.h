// The end of every scattering stage: Russian roulette, and the next ray into the ray queue.
#ifndef WAVELOBE_STAGES_CONTINUE_PATH_H
#define WAVELOBE_STAGES_CONTINUE_PATH_H

#include "stages/dimensions.h"
#include "shapes/surface.h"

// Survival probabilities as Mitsuba 3 documents them: the largest component of the throughput, corrected for the
// scaling of radiance by refraction, at most 0.95, from `rr_depth` vertices on.
INLINE Int roulette(SampleId sample, UInt depth, Float eta, uint rr_depth, Rgb *throughput, Int alive) {
    Int playing = alive & (depth + (UInt)1u >= (UInt)rr_depth);
    if (!any_lane(playing)) return alive;
    Float u, unused;
    sample_2d(sample, vertex_pair(depth, PAIR_SURVIVAL), &u, &unused);
    Float survival = LESSER(max_component(*throughput) * eta * eta, (Float)0.95f);
    *throughput = select3(playing, scale(*throughput, 1.0f / survival), *throughput);
    return alive & (!playing | (u < survival));
}

// Appends the surviving lanes' rays; returns the new count.
INLINE uint append_rays(Queue rays, uint at, const TracedPath *path, const Surface *surface, Vec3 direction,
                        Rgb throughput, Float pdf, Float eta, Int alive) {
    uint bits = lane_bits(alive);
    if (bits == 0u) return at;
    append_vec3(rays, PATH_ORIGIN, at, offset_ray_origin(surface->position, surface->error, surface->normal, direction),
                bits);
    append_vec3(rays, PATH_DIRECTION, at, direction, bits);
    append_field(rays, PATH_T, at, (Float)INFINITY, bits);
    append_uint(rays, PATH_HIT, at, surface->primitive, bits);
    append_vec3(rays, PATH_THROUGHPUT, at, throughput, bits);
    append_field(rays, PATH_PDF, at, pdf, bits);
    append_uint(rays, PATH_ID, at, path->id, bits);
    append_uint(rays, PATH_DEPTH, at, path->depth + (UInt)1u, bits);
#if HAS_TRANSMISSION
    append_field(rays, PATH_ETA, at, eta, bits);
#endif
    return at + popcount(bits);
}

#if HAS_TRANSMISSION
#define PATH_ETA_OF(path) (path).eta
#else
#define PATH_ETA_OF(path) ONE
#endif

#endif
