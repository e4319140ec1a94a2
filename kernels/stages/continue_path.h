// The end of every scattering stage: Russian roulette, and the next ray into the ray queue.
#ifndef WAVELOBE_STAGES_CONTINUE_PATH_H
#define WAVELOBE_STAGES_CONTINUE_PATH_H

#include "stages/dimensions.h"
#include "shapes/surface.h"

// Paths whose throughput has fallen below this play for their survival; those that win are brought back up to it, so that what a
// path may bring keeps its size. (Found by relMSE times rays over indoor scenes: half of it to twice as much costs at most some percent.)
#define ROULETTE_THRESHOLD 0.4f
// What the camera sees in mirrors is not to be noisier than what it sees: paths that only delta lobes have dimmed play when next to nothing is left.
#define ROULETTE_DELTA_THRESHOLD 0.01f
// From this vertex on all play, and one in twenty loses at least: paths between white walls end, too.
#define ROULETTE_FOR_ALL 16u

// Throughput stands for what a path may still bring: its largest component, corrected for the scaling of radiance by refraction.
// From `rr_depth` vertices on, below a threshold.
INLINE Int roulette(SampleId sample, UInt depth, Float eta, uint rr_depth, Float inverse_threshold, Rgb *throughput, Int alive) {
    Float survival = max_component(*throughput) * eta * eta * inverse_threshold;
    survival = LESSER(survival, SELECT(depth < (UInt)ROULETTE_FOR_ALL, ONE, (Float)0.95f));
    Int playing = alive & (survival < 1.0f) & (depth + (UInt)1u >= (UInt)rr_depth);
    if (!any_lane(playing)) return alive;
    Float u, unused;
    sample_2d(sample, vertex_pair(depth, PAIR_SURVIVAL), &u, &unused);
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
#if HAS_PATH_ETA
    append_field(rays, PATH_ETA, at, eta, bits);
#endif
    return at + popcount(bits);
}

#if HAS_PATH_ETA
#define PATH_ETA_OF(path) (path).eta
#else
#define PATH_ETA_OF(path) ONE
#endif

#endif
