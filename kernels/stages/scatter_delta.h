// Delta lobes: the one direction they allow is followed. No light sample, no MIS.
#ifndef WAVELOBE_STAGES_SCATTER_DELTA_H
#define WAVELOBE_STAGES_SCATTER_DELTA_H

#include "stages/continue_path.h"
#include "stages/scattering_surface.h"

INLINE uint run_scatter_delta(Block block, const SceneView *scene) {
    global const struct RenderParameters *parameters = scene->parameters;
    Queue delta = QUEUE(block, DELTA), rays = QUEUE(block, RAYS);
    uint n = *delta.count, appended = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(delta, i);
        SampleId sample = path_sample_id(block, path.id, parameters->sequence);
        Surface surface = load_scattering_surface(scene, &path, sample);
        MaterialInput in = material_input(&surface, scene->surfaces.materials, scene->textures, scene->texels);
        Float unused, u;
        sample_2d(sample, vertex_pair(path.depth, PAIR_CHOICE), &unused, &u);
        DeltaSample s = sample_delta_lobe(material_lobes(&surface, in), in, surface.wi, u);
        Vec3 direction = normalize3(to_world(surface.frame, s.wo));
        Rgb throughput = scale(mul(path.throughput, s.weight), MAPPED_SHARE(&surface, direction));
        Float eta = PATH_ETA_OF(path) * s.eta;
        // No direction goes with a weight of zero.
        Int goes = path.live & !(max_component(s.weight) <= 0.0f);
        Float finite = finiteness3(s.weight) + finiteness3(s.wo) + finiteness3(surface.position) + finiteness3(surface.wi) +
                       SELECT(goes, finiteness3(throughput), ZERO);
        Int broken = mark_broken(block, STAGE_SCATTER_DELTA, path.id, path.live, finite);
        // Only delta lobes so far, or again.
        Float inverse_threshold = SELECT(path.pdf < 0.0f, (Float)(1.0f / ROULETTE_DELTA_THRESHOLD), (Float)(1.0f / ROULETTE_THRESHOLD));
        Int alive = roulette(sample, path.depth, eta, parameters->rr_depth, inverse_threshold, &throughput,
                             path.live & !broken & (max_component(throughput) > 0.0f));
#if HAS_MEDIA
        UInt medium = medium_beyond(scene->media, scene->surfaces, &surface, direction, path.medium);
        append_uint(rays, PATH_MEDIUM, appended, medium, lane_bits(alive));
#endif
        appended = append_rays(rays, appended, &path, &surface, direction, throughput, (Float)-1.0f, eta, alive);
    }
    *rays.count = appended;
    *delta.count = 0u;
    return n;
}

#endif
