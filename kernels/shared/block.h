// A block: a tile of pixels, a range of their samples, and a small wave of path slots. One work-item owns it.
//
// Block memory is a set of queues, each a structure of arrays with QUEUE_STRIDE slots a field, and the radiance of each
// path of the block. A stage reads its queue from the first slot to the last and appends to others.
#ifndef WAVELOBE_SHARED_BLOCK_H
#define WAVELOBE_SHARED_BLOCK_H

#include "shared/types.h"

#define TILE_WIDTH 16u
#define TILE_PIXELS 256u
#define BLOCK_SAMPLES 16u // of each pixel at the most: radiance of a block's paths stays in the core's cache
// Pixels of a tile go in 4 x 4 squares, so that 16 in a row are neighbours in the picture too: the bits of a pixel are yyxx of the
// square, then yyxx inside it.
#define TILE_X(pixel) (((pixel) & 3u) | (((pixel) >> 2) & 12u))
#define TILE_Y(pixel) ((((pixel) >> 2) & 3u) | (((pixel) >> 4) & 12u))

// Ids of the paths of a block, in the order in which they start: 2^digits samples of a pixel one after the other, since they see more
// alike than neighbours do, then those of the next pixel, and after the tile's last pixel the next samples of the first. So many as
// divide the samples, BLOCK_SAMPLES at the most.
#define PATH_DIGITS(samples) ((samples) & 1u ? 0u : (samples) & 2u ? 1u : (samples) & 4u ? 2u : (samples) & 8u ? 3u : (samples) & 16u ? 4u : 0u)
#define PATH_PIXEL(id, digits) ((id) >> (digits) & (TILE_PIXELS - 1u))
#define PATH_SAMPLE(id, digits) ((((id) >> (digits)) / TILE_PIXELS << (digits)) | ((id) & ((1u << (digits)) - 1u)))
#define ID_OF_PATH(pixel, sample, digits) \
    (((((sample) >> (digits)) * TILE_PIXELS + (pixel)) << (digits)) | ((sample) & ((1u << (digits)) - 1u)))

#define QUEUE_PADDING 16u     // vector stores may run past the last slot
#define RAY_FIELDS 17u        // of struct-of-arrays fields, see core/block.h; one more with a light tree, one if that serves glossy lobes, one with instances, one with media
#define SHADOW_FIELDS 12u     // one more with media, one with facets

// More vertices than any path has: what rays of the camera that look for emitters alone, EMISSION_RAYS a sample, say of their depth.
#define EMISSION_DEPTH 0x7fffffffu

// Queues, in order of the pipeline. `rays` holds paths about to be traced; the others those that were.
#define QUEUE_RAYS 0u
#define QUEUE_ESCAPED 1u
#define QUEUE_EMITTED 2u
#define QUEUE_DELTA 3u
#define QUEUE_GLOSSY 4u
#define QUEUE_DIFFUSE 5u
#define QUEUE_SHADOW 6u
#define QUEUE_COUNT 7u

// Ranges of samples go to the two halves of the film in turn, and each half has a scramble of its own. Sample s of the
// picture is sample HALF_INDEX(s) of half HALF_OF(s).
#define HALF_OF(s) ((s) / BLOCK_SAMPLES & 1u)
#define HALF_INDEX(s) ((s) / (2u * BLOCK_SAMPLES) * BLOCK_SAMPLES + (s) % BLOCK_SAMPLES)

// What the host fills in to hand a block its work, and reads back to launch only what has something to do.
struct BlockHeader {
    Uint32 tile_x, tile_y;     // film coordinates of the tile's first pixel
    Uint32 first_sample;       // index of the first sample
    Uint32 path_count;         // TILE_PIXELS * samples
    Uint32 next_path;          // how many are started
    Uint32 count[QUEUE_COUNT]; // items in each queue
    Uint32 nonfinite_path;     // id of a path whose sample was not finite; WAVELOBE_NONE: none
    Uint32 started;            // camera rays of the last round
    Uint32 traced;             // all rays of the last round
    float error;               // of a scene with HAS_ERROR_ESTIMATE: relMSE of the tile so far
    float error_deviation;     // standard error of that estimate
    Uint32 nonfinite_stage;    // that made it so, STAGE_x
    Uint32 next_emission_ray;  // of a scene with EMISSION_RAYS: how many are started
    Uint32 unused;
};
WAVELOBE_CHECK_SIZE(BlockHeader, 80);

// A tile and a range of its samples, for render_tiles: what BlockHeader says of it when a block takes it up.
struct TileJob {
    Uint32 tile_x, tile_y;
    Uint32 first_sample;
    Uint32 path_count;
    // Written when it is done:
    Uint32 nonfinite_path, nonfinite_stage;
    float error, error_deviation;
};
WAVELOBE_CHECK_SIZE(TileJob, 32);

struct TileQueue {
    Uint32 next;  // first job that no block has taken
    Uint32 count;
};
WAVELOBE_CHECK_SIZE(TileQueue, 8);

// What one path met, for replay_path: a record a stage that took it up.
struct ReplayRecord {
    Uint32 stage, depth;
    Uint32 shape, primitive;     // that was hit; WAVELOBE_NONE: none. Shadow rays: that they leave
    float t;                     // length of the ray
    struct Packed3 position;     // of the hit; of rays that hit nothing and of shadow rays: where they start
    struct Packed3 direction;    // of the ray
    struct Packed3 throughput;   // of the path; shadow rays: what they bring if nothing is in the way
    float pdf;                   // that chose the direction; negative: a delta lobe or the camera did
    struct Packed3 radiance;     // of the path, after the stage
};
WAVELOBE_CHECK_SIZE(ReplayRecord, 72);

struct ReplayLog {
    Uint32 path;                 // id
    Uint32 count;                // of records; those beyond REPLAY_RECORDS are not kept
    Uint32 stage;                // that broke the sample, should it not be finite
    struct Packed3 radiance;     // of the sample
};
WAVELOBE_CHECK_SIZE(ReplayLog, 24);
#define REPLAY_RECORDS 4096u

// What render_tiles did in one stage of one block's rounds.
struct StageCounters {
    Uint64 calls;  // that found something to do
    Uint64 items;
    Uint64 cycles; // of the time stamp counter; 0 on machines without one that kernels can read
};
WAVELOBE_CHECK_SIZE(StageCounters, 24);

// Index of each stage.
enum {
#define STAGE(name, NAME) STAGE_##NAME,
#include "stages/stages.def"
#undef STAGE
    STAGE_COUNT
};

#endif
