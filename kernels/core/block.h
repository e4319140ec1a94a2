// Access to a block's queues and radiance.
//
// Wants BLOCK_SLOTS, a multiple of 16: paths in flight in a block. The queues a scene has no use for take no memory.
#ifndef WAVELOBE_CORE_BLOCK_H
#define WAVELOBE_CORE_BLOCK_H

#include "core/vector.h"
#include "shared/block.h"

// Fields of a path, in order of storage. A path that was traced is kept without those it no longer needs: its origin
// (except where analytic shapes are refined from it) comes last and is dropped.
#define PATH_T 0u         // distance of the hit; before tracing: how far to look
#define PATH_HIT 1u       // what was hit, see shared/bvh.h; before tracing: the primitive that the ray leaves, or HIT_NONE
#define PATH_U 2u         // barycentric coordinates
#define PATH_V 3u
#define PATH_DIRECTION 4u // 3, unit
#define PATH_THROUGHPUT 7u // 3
#define PATH_PDF 10u      // solid angle density that chose `direction`; negative: a delta lobe or the camera did
#define PATH_ID 11u       // of the path within its block
#define PATH_DEPTH 12u    // vertices before this one; EMISSION_DEPTH: of a ray that ends with what it hits
#define PATH_ETA 13u      // product of the relative indices crossed, for Russian roulette; with caustics also the root of how much likelier guided samples were
#define PATH_RECEIVER 14u // where light was last sampled: code of the normal, and of the lobe in scenes with glossy ones (lights/receiver.h)
#define PATH_INSTANCE (PATH_RECEIVER + HAS_LIGHT_TREE + HAS_GLOSSY_RECEIVERS) // of the hit, or INSTANCE_NONE; in scenes with instances
#define PATH_MEDIUM (PATH_INSTANCE + HAS_INSTANCES) // that the ray is in; in scenes with media
#define PATH_ORIGIN (PATH_MEDIUM + HAS_MEDIA)       // 3
#define PATH_FIELDS (PATH_ORIGIN + 3u)

#if HAS_ANALYTIC
#define TRACED_FIELDS PATH_FIELDS
#else
#define TRACED_FIELDS PATH_ORIGIN
#endif

// Fields of a shadow ray.
#define SHADOW_T 0u           // distance to the light
#define SHADOW_DIRECTION 1u   // 3, unit
#define SHADOW_CONTRIBUTION 4u // 3, radiance the path gains if nothing is in the way
#define SHADOW_ID 7u
#define SHADOW_FROM 8u        // primitive that the ray leaves
#define SHADOW_ORIGIN 9u      // 3
#define SHADOW_MEDIUM 12u     // that the ray starts in; in scenes with media
#define SHADOW_TO (SHADOW_MEDIUM + HAS_MEDIA) // number of the triangle that it is aimed at; in scenes with facets

#define QUEUE_STRIDE (BLOCK_SLOTS + QUEUE_PADDING)
#define RAYS_OFFSET 0u
#define ESCAPED_OFFSET (RAYS_OFFSET + PATH_FIELDS * QUEUE_STRIDE)
#define EMITTED_OFFSET (ESCAPED_OFFSET + HAS_ENVIRONMENT * TRACED_FIELDS * QUEUE_STRIDE)
#define DELTA_OFFSET (EMITTED_OFFSET + HAS_SURFACE_LIGHTS * TRACED_FIELDS * QUEUE_STRIDE)
#define GLOSSY_OFFSET (DELTA_OFFSET + HAS_DELTA_LOBES * TRACED_FIELDS * QUEUE_STRIDE)
#define DIFFUSE_OFFSET (GLOSSY_OFFSET + HAS_GLOSSY_LOBES * TRACED_FIELDS * QUEUE_STRIDE)
#define SHADOW_OFFSET (DIFFUSE_OFFSET + HAS_DIFFUSE_LOBES * TRACED_FIELDS * QUEUE_STRIDE)
#define RADIANCE_OFFSET (SHADOW_OFFSET + (SHADOW_FIELDS + HAS_MEDIA + HAS_FACETS) * QUEUE_STRIDE)
#define BLOCK_WORDS (RADIANCE_OFFSET + 3u * TILE_PIXELS * BLOCK_SAMPLES)

typedef struct {
    global struct BlockHeader *header;
    global float *memory;
} Block;

INLINE Block block_of(global struct BlockHeader *headers, global float *blocks, size_t index) {
    Block b = {headers + index, blocks + index * BLOCK_WORDS};
    return b;
}

// One queue: field f of slot i is fields[f * QUEUE_STRIDE + i].
typedef struct {
    global float *fields;
    global uint *count;
} Queue;

INLINE Queue queue_at(Block b, uint which, uint offset) {
    Queue q = {b.memory + offset, &b.header->count[which]};
    return q;
}

#define QUEUE(block, NAME) queue_at(block, QUEUE_##NAME, NAME##_OFFSET)

INLINE Float read_field(Queue q, uint field, uint i) { return load(q.fields + (size_t)field * QUEUE_STRIDE + i); }
INLINE UInt read_uint(Queue q, uint field, uint i) { return as_UInt(read_field(q, field, i)); }
INLINE Vec3 read_vec3(Queue q, uint field, uint i) {
    return vec3(read_field(q, field, i), read_field(q, field + 1u, i), read_field(q, field + 2u, i));
}

INLINE void write_field(Queue q, uint field, uint i, Float v) { store(q.fields + (size_t)field * QUEUE_STRIDE + i, v); }

INLINE void write_vec3(Queue q, uint field, uint i, Vec3 v) {
    write_field(q, field, i, v.x);
    write_field(q, field + 1u, i, v.y);
    write_field(q, field + 2u, i, v.z);
}

// One slot, for stages that go ray by ray.
INLINE float slot_float(Queue q, uint field, uint i) { return q.fields[(size_t)field * QUEUE_STRIDE + i]; }
INLINE uint slot_uint(Queue q, uint field, uint i) { return as_uint(slot_float(q, field, i)); }
INLINE void set_slot(Queue q, uint field, uint i, float v) { q.fields[(size_t)field * QUEUE_STRIDE + i] = v; }

// Appends the lanes of `bits`: all fields at slot `at`, then the count.
INLINE void append_field(Queue q, uint field, uint at, Float v, uint bits) {
    compress_store(q.fields + (size_t)field * QUEUE_STRIDE + at, v, bits);
}
INLINE void append_uint(Queue q, uint field, uint at, UInt v, uint bits) { append_field(q, field, at, as_Float(v), bits); }
INLINE void append_vec3(Queue q, uint field, uint at, Vec3 v, uint bits) {
    append_field(q, field, at, v.x, bits);
    append_field(q, field + 1u, at, v.y, bits);
    append_field(q, field + 2u, at, v.z, bits);
}

// ---- radiance of the block's paths ---------------------------------------------------------------------

// Channel c of path `id` is at RADIANCE_AT(id) of radiance_channel(b, c): what is added to a path is on one line of memory.
#define RADIANCE_AT(id) ((id) * 3u)

INLINE global float *radiance_channel(Block b, uint channel) { return b.memory + RADIANCE_OFFSET + channel; }

// Lane by lane: gathers and scatters cost several times as much.
INLINE void add_radiance(Block b, UInt id, Rgb radiance, uint bits) {
    LaneUints ids = lane_uints(id);
    LaneFloats red = lane_floats(radiance.x), green = lane_floats(radiance.y), blue = lane_floats(radiance.z);
    while (bits) {
        POP_LOWEST_BIT(bits, k);
        global float *of_path = radiance_channel(b, 0u) + RADIANCE_AT(ids.value[k]);
        of_path[0] += red.value[k];
        of_path[1] += green.value[k];
        of_path[2] += blue.value[k];
    }
}

// The red channel of a sample that met what is no finite number: a quiet NaN that carries the stage, and keeps it in sums.
#define BROKEN_SAMPLE 0x7fc00000u

// Marks the samples of the live lanes in which `finiteness` is not zero, and returns these lanes. Comparisons are false for what is
// not a number: without this such paths would end unseen.
INLINE Int mark_broken(Block b, uint stage, UInt id, Int live, Float finiteness) {
    Int broken = live & !(finiteness == 0.0f);
    uint bits = lane_bits(broken);
    if (UNLIKELY(bits != 0u)) {
        global float *red = radiance_channel(b, 0u);
        Float before = gather(red, RADIANCE_AT(id)); // the first stage to break a sample is the one that counts
        scatter(red, RADIANCE_AT(id), as_Float((UInt)(BROKEN_SAMPLE + 1u + stage)), bits & lane_bits(before == before));
    }
    return broken;
}

// The stage that broke a sample whose radiance is not finite; by itself, without any stage's doing, a sum overflows.
INLINE uint breaking_stage(float red) {
    uint carried = as_uint(red) - BROKEN_SAMPLE;
    return carried != 0u && carried <= (uint)STAGE_COUNT ? carried - 1u : (uint)STAGE_ACCUMULATE;
}

// ---- which pixel and sample a path is --------------------------------------------------------------------

INLINE uint path_digits(Block b) { return PATH_DIGITS(b.header->path_count / TILE_PIXELS); }
INLINE UInt path_pixel_x(Block b, UInt id) { return TILE_X(PATH_PIXEL(id, path_digits(b))) + (UInt)b.header->tile_x; }
INLINE UInt path_pixel_y(Block b, UInt id) { return TILE_Y(PATH_PIXEL(id, path_digits(b))) + (UInt)b.header->tile_y; }
INLINE UInt path_sample(Block b, UInt id) { return PATH_SAMPLE(id, path_digits(b)) + (UInt)b.header->first_sample; }

#endif
