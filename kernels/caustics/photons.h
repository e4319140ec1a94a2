// Photons: aimed from the lights at surfaces with delta lobes, followed as long as these lead them on, and recorded where they arrive
// on others. They make no light, only maps of where it comes from (caustics/guide.h). Sums are of integers: their order does not matter.
#ifndef WAVELOBE_CAUSTICS_PHOTONS_H
#define WAVELOBE_CAUSTICS_PHOTONS_H

#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#include "stages/intersect_closest.h"
#include "stages/scatter_delta.h"
#include "stages/sort_paths.h"
#include "stages/start_path.h"

typedef struct {
    global struct CausticGrid *grid;
    global const struct CausticTarget *targets;
    global uint *counts;  // photons of each cell
    global ulong *sums;   // of flux, in units of 2^-32 of the greatest: CAUSTIC_BINS a map
    global ulong *squares; // of flux times radiance, the same, one a map
} PhotonRecord;

typedef struct {
    Vec3 center;
    Float radius, inverse_chance;
} PhotonTarget;

INLINE PhotonTarget choose_target(PhotonRecord r, Float u) {
    UInt target = (UInt)0u;
    for (uint k = 0u; k + 1u < r.grid->target_count; k++) target += SELECT(u >= (Float)r.targets[k].cumulative, (UInt)1u, (UInt)0u);
    global const float *words = (global const float *)r.targets;
    UInt at = target * RECORD_WORDS(CausticTarget);
    PhotonTarget t = {gather_vec3(words, at), gather(words + WORD_OFFSET(CausticTarget, radius), at),
                      gather(words + WORD_OFFSET(CausticTarget, inverse_chance), at)};
    return t;
}

// The light whose photon it is, as the target's centre sees it.
INLINE LightSample photon_light(LightInput in, SampleId sample, Vec3 center, Float u_light, Float u_deep, Float *pdf) {
#if HAS_LIGHT_TREE
    ReceiverCode any;
    any.normal = (UInt)RECEIVER_ANY;
#if HAS_GLOSSY_RECEIVERS
    any.lobe = (UInt)NO_LOBE;
#endif
    Float choice = choose_light(&in, receiver_of(center, any), u_light, u_deep, TRUE_MASK);
#else
    Float choice = choose_light(&in, u_light);
#endif
    Float u1, u2;
    sample_2d(sample, (UInt)2u, &u1, &u2);
    LightSample light = sample_light(in, center, u1, u2);
    *pdf = choice * light.pdf;
    return light;
}

// Starts the photons from `first` on that the ray queue has room for: from a point of a light through one of the target's disk that
// faces it. The flux of a photon and the radiance it is of stand in the first channels of its path's radiance. Returns the next to start.
INLINE uint emit_photons(Block block, const SceneView *scene, PhotonRecord record, uint first) {
    Queue rays = QUEUE(block, RAYS);
    // Their number is not that of the picture's samples.
    struct SampleSequence sequence = {scene->parameters->sequence.seed, SEQUENCE_A_PIXEL};
    uint count = 0u;
    for (; first < PHOTONS_A_BATCH && count + LANES <= BLOCK_SLOTS; first += LANES) {
        UInt id = LANE_INDEX + (UInt)first;
        SampleId sample = path_sample_id(block, id, sequence);
        Float u_target, u_light, u_deep, v1, v2, unused;
        sample_2d(sample, (UInt)0u, &u_target, &unused);
        sample_2d(sample, (UInt)1u, &u_light, &u_deep);
        sample_2d(sample, (UInt)3u, &v1, &v2);
        PhotonTarget target = choose_target(record, u_target);
        Float pdf;
        LightSample light = photon_light(scene->lights, sample, target.center, u_light, u_deep, &pdf);
        Vec2 disk = square_to_disk(v1, v2);
        Frame facing = frame_of_normal(light.direction);
        Vec3 through = scale_add(facing.s, disk.x * target.radius, scale_add(facing.t, disk.y * target.radius, target.center));
        Vec3 start = select3(light.at_infinity, scale_add(light.direction, (Float)record.grid->scene_size, through), light.point);
        Vec3 direction = normalize3(sub(through, start));
        start = offset_ray_origin(start, light.error, light.normal, direction);
        Float flux = luminance(light.radiance) * (PI_F * target.radius * target.radius) * target.inverse_chance / pdf;
        // What delta lights make of caustics no path can find.
        uint bits = lane_bits(!light.delta & (pdf > 0.0f) & (flux > 0.0f) & (flux < INFINITY) & (finiteness3(start) + finiteness3(direction) == 0.0f));
        scatter(radiance_channel(block, 0u), RADIANCE_AT(id), flux, bits);
        scatter(radiance_channel(block, 1u), RADIANCE_AT(id), luminance(light.radiance), bits);
        count = append_first_rays(rays, count, scene->parameters, start, direction, (Float)INFINITY, id, ONE, 0u, bits);
    }
    *rays.count = count;
    return first;
}

// Takes the photons of a queue off at surfaces with more than delta lobes, if they have come by such.
INLINE void record_photons(Block block, const SceneView *scene, PhotonRecord record, Queue arrived) {
    uint n = *arrived.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(arrived, i);
        Surface surface = load_surface(scene->surfaces, &path);
        // Throughput is that of radiance, which refraction scales; flux it does not.
        LaneFloats flux, radiance;
        Float share = luminance(path.throughput) * path.eta * path.eta;
        *(Float *)flux.value = gather(radiance_channel(block, 0u), RADIANCE_AT(path.id)) * share;
        *(Float *)radiance.value = gather(radiance_channel(block, 1u), RADIANCE_AT(path.id)) * share;
        Int within;
        LaneUints cell, bin;
        *(UInt *)cell.value = caustic_cell(record.grid, surface.position, &within);
        *(UInt *)bin.value = caustic_bin(negate(path.direction));
        Float f = LANES_OF(flux);
        uint bits = lane_bits(path.live & within & (path.depth > (UInt)0u) & (f > 0.0f) & (f < INFINITY));
        float unit = 0x1p32f / as_float(record.grid->greatest_flux), unit_radiance = 1.0f / as_float(record.grid->greatest_radiance);
        while (bits) {
            POP_LOWEST_BIT(bits, k);
            uint map = scene->caustics.cells[cell.value[k]];
            if (record.grid->recording == 0u) {
                atomic_inc(record.counts + cell.value[k]);
                // Floats above zero are ordered as their bits.
                atomic_max(&record.grid->greatest_flux, as_uint(flux.value[k]));
                atomic_max(&record.grid->greatest_radiance, as_uint(radiance.value[k]));
            } else if (map != 0u) {
                atom_add(record.sums + (size_t)(map - 1u) * CAUSTIC_BINS + bin.value[k], (ulong)(flux.value[k] * unit));
                atom_add(record.squares + (map - 1u), (ulong)(flux.value[k] * unit * (radiance.value[k] * unit_radiance)));
            }
        }
    }
    *arrived.count = 0u;
}

// One vertex of each photon in flight.
INLINE void follow_photons(Block block, const SceneView *scene, PhotonRecord record) {
    run_intersect_closest(block, scene);
    run_sort_paths(block, scene);
    block.header->count[QUEUE_ESCAPED] = block.header->count[QUEUE_EMITTED] = 0u;
#if HAS_GLOSSY_LOBES
    record_photons(block, scene, record, QUEUE(block, GLOSSY));
#endif
#if HAS_DIFFUSE_LOBES
    record_photons(block, scene, record, QUEUE(block, DIFFUSE));
#endif
    run_scatter_delta(block, scene);
}

// Each work-item takes batch after batch with the block it owns.
kernel void shoot_photons(global struct BlockHeader *headers, global float *blocks, global const struct CausticTarget *caustic_targets,
                          global uint *caustic_counts, global ulong *caustic_sums, global ulong *caustic_squares,
                          SCENE_PARAMETERS) {
    Block block = block_of(headers, blocks, get_global_id(0));
    SceneView scene = SCENE_VIEW;
    PhotonRecord record = {caustic_grid, caustic_targets, caustic_counts, caustic_sums, caustic_squares};
    for (;;) {
        uint batch = atomic_inc(&caustic_grid->next_batch);
        if (batch >= caustic_grid->batches) break;
        block.header->tile_x = batch * TILE_WIDTH;
        block.header->tile_y = PHOTON_ROW;
        block.header->first_sample = 0u;
        uint next = 0u;
        while (next < PHOTONS_A_BATCH) {
            next = emit_photons(block, &scene, record, next);
            while (block.header->count[QUEUE_RAYS] != 0u) follow_photons(block, &scene, record);
        }
        for (uint i = 0u; i < RADIANCE_AT(PHOTONS_A_BATCH); i++) radiance_channel(block, 0u)[i] = 0.0f;
    }
}

#endif
