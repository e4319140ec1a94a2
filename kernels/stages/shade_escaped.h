// Paths that left the scene gain the environment's radiance, weighted against the light sample of the vertex before.
#ifndef WAVELOBE_STAGES_SHADE_ESCAPED_H
#define WAVELOBE_STAGES_SHADE_ESCAPED_H

#include "sampling/mis.h"
#include "stages/scene_view.h"

INLINE uint run_shade_escaped(Block block, const SceneView *scene) {
    Queue escaped = QUEUE(block, ESCAPED);
    uint n = *escaped.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(escaped, i);
        LightInput in = scene->lights;
        in.light = (UInt)in.environment->light;
        Rgb radiance = vec3_all(ZERO);
        Float pdf = ZERO;
        // A scene has one environment.
#define ENVIRONMENT_LIGHT(name, NAME)                                                                     \
        radiance = name##_radiance(in, path.direction);                                                   \
        pdf = name##_pdf(in, vec3_all(ZERO), path.direction, (Float)INFINITY, vec3_all(ZERO));
        SCENE_ENVIRONMENT_LIGHTS(ENVIRONMENT_LIGHT)
#undef ENVIRONMENT_LIGHT
#if LIGHT_COUNT == 1
        Float choice = ONE;
#else
        Float choice = GATHER_FIELD(in.lights, Light, in.light, selection_probability);
#endif
        Float weight = SELECT(path.pdf >= 0.0f, bsdf_sample_weight(path.pdf, choice * pdf), ONE);
#if HIDE_EMITTERS
        weight = SELECT(path.depth == (UInt)0u, ZERO, weight);
#endif
        Rgb gain = scale(mul(path.throughput, radiance), weight);
        Int broken = mark_broken(block, STAGE_SHADE_ESCAPED, path.id, path.live, finiteness3(gain));
        add_radiance(block, path.id, gain, lane_bits(path.live & !broken));
    }
    *escaped.count = 0u;
    return n;
}

#endif
