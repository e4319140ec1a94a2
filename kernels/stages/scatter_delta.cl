// Delta lobes: the one direction they allow is followed. No light sample, no MIS.
#include "bsdf/material.h"
#include "stages/continue_path.h"

kernel void scatter_delta(global struct BlockHeader *headers, global float *blocks,
                          SURFACE_PARAMETERS TEXTURE_PARAMETERS) {
    Block block = block_of(headers, blocks, get_global_id(0));
    SurfaceView view = SURFACE_VIEW;
    Queue delta = QUEUE(block, DELTA), rays = QUEUE(block, RAYS);
    uint n = *delta.count, appended = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(delta, i);
        Surface surface = load_surface(view, &path);
        MaterialInput in = material_input(&surface, view.materials, TEXTURE_ARGUMENTS);
        SampleId sample = path_sample_id(block, path.id, parameters->seed);
        Float unused, u;
        sample_2d(sample, vertex_pair(path.depth, PAIR_CHOICE), &unused, &u);
        DeltaSample s = sample_delta_lobe(material_lobes(&surface, in), in, surface.wi, u);
        Rgb throughput = mul(path.throughput, s.weight);
        Float eta = PATH_ETA_OF(path) * s.eta;
        Int alive = roulette(sample, path.depth, eta, parameters->rr_depth, &throughput,
                             path.live & (max_component(throughput) > 0.0f));
        Vec3 direction = normalize3(to_world(surface.frame, s.wo));
        appended = append_rays(rays, appended, &path, &surface, direction, throughput, (Float)-1.0f, eta, alive);
    }
    *rays.count = appended;
    *delta.count = 0u;
}
