// One light of all, and a sample of it. The host defines SCENE_LIGHTS(X), SCENE_SURFACE_LIGHTS(X) and
// SCENE_ENVIRONMENT_LIGHTS(X) from lights.def and the scene, and includes the headers of these lights before this one.
#ifndef WAVELOBE_LIGHTS_CHOOSE_H
#define WAVELOBE_LIGHTS_CHOOSE_H

#include "lights/light.h"
#include "shared/scene.h"
#include "bsdf/material.h"
#if HAS_LIGHT_TREE
#include "lights/light_tree.h"
#endif

#if HAS_ENVIRONMENT
#define ENVIRONMENT_PARAMETERS , global const struct Environment *environment
#define ENVIRONMENT_ARGUMENT environment
#else
#define ENVIRONMENT_PARAMETERS
#define ENVIRONMENT_ARGUMENT 0
#endif
#if HAS_LIGHT_ENVMAP
#define ENVMAP_PARAMETERS \
    , global const float *environment_texels, global const float *environment_sums, global const float *environment_density
#define ENVMAP_ARGUMENTS environment_texels, environment_sums, environment_density
#else
#define ENVMAP_PARAMETERS
#define ENVMAP_ARGUMENTS 0, 0, 0
#endif
#if HAS_ANALYTIC
#define LIGHT_ANALYTICS analytics
#else
#define LIGHT_ANALYTICS 0
#endif

#if HAS_LIGHT_TREE
#define LIGHT_TREE_PARAMETER , global const struct LightNode *light_tree
#define LIGHT_TREE_ARGUMENT light_tree
#else
#define LIGHT_TREE_PARAMETER
#define LIGHT_TREE_ARGUMENT 0
#endif

// For kernels that already take SURFACE_PARAMETERS and TEXTURE_PARAMETERS.
#define LIGHT_PARAMETERS , global const struct Light *lights ENVIRONMENT_PARAMETERS ENVMAP_PARAMETERS LIGHT_TREE_PARAMETER
#define LIGHT_VIEW                                                                                            \
    {(UInt)0u, lights, LIGHT_ANALYTICS, ENVIRONMENT_ARGUMENT, ENVMAP_ARGUMENTS, TEXTURE_ARGUMENTS, LIGHT_TREE_ARGUMENT, \
     parameters->light_count, parameters->finite_light_count}

#if HAS_LIGHT_TREE
// In the wanted lanes: lights at infinity by their share, the others by the tree. `in->light` is the light; the result its
// probability, zero where none shines. `u_deep` is a second number for trees deeper than the digits of the first.
INLINE Float choose_light(LightInput *in, Receiver receiver, Float u, Float u_deep, Int wanted) {
    Float below = ZERO;
    UInt at_infinity = (UInt)in->finite_light_count;
    Float probability = ONE;
    Int chosen = !TRUE_MASK;
    for (uint i = in->finite_light_count; i < in->light_count; i++) {
        Float share = (Float)in->lights[i].selection_probability;
        Int here = !chosen & (u < below + share);
        at_infinity = SELECT(here, (UInt)i, at_infinity);
        probability = SELECT(here, share, probability);
        chosen |= here;
        below += share;
    }
    Float rest = (u - below) / (1.0f - below);
    UInt light;
    Float walked = walk_light_tree(in->light_tree, receiver, LESSER(rest, (Float)BELOW_ONE), u_deep, wanted & !chosen, &light);
    in->light = SELECT(chosen, at_infinity, light);
    return SELECT(chosen, probability, (1.0f - below) * walked);
}

// Probability of the lane's light, which has a place, being chosen for the receiver in the wanted lanes.
INLINE Float placed_light_probability(LightInput in, Receiver receiver, Int wanted) {
    Float below = ZERO;
    for (uint i = in.finite_light_count; i < in.light_count; i++) below += (Float)in.lights[i].selection_probability;
    UInt place = as_UInt(light_field(in, place));
    return (1.0f - below) * light_tree_probability(in.light_tree, receiver, place, wanted);
}
#else
// Any light is as good as another. `in->light` is the light; the result its probability.
INLINE Float choose_light(LightInput *in, Float u) {
#if LIGHT_COUNT == 1
    in->light = (UInt)0u;
    return ONE;
#else
    UInt light = as_UInt(convert_Int(u * (float)in->light_count));
    in->light = SELECT(light < (UInt)in->light_count, light, (UInt)(in->light_count - 1u)); // u * count may round up to count
    return GATHER_FIELD(in->lights, Light, in->light, selection_probability);
#endif
}
#endif

INLINE LightSample select_sample(Int mask, LightSample a, LightSample b) {
    LightSample s;
    s.direction = select3(mask, a.direction, b.direction);
    s.point = select3(mask, a.point, b.point);
    s.error = select3(mask, a.error, b.error);
    s.normal = select3(mask, a.normal, b.normal);
    s.at_infinity = SELECT(mask, a.at_infinity, b.at_infinity);
    s.radiance = select3(mask, a.radiance, b.radiance);
    s.pdf = SELECT(mask, a.pdf, b.pdf);
    s.delta = SELECT(mask, a.delta, b.delta);
    return s;
}

INLINE LightSample no_light_sample(void) {
    LightSample s;
    s.direction = s.point = s.error = s.normal = s.radiance = vec3_all(ZERO);
    s.pdf = ZERO;
    s.at_infinity = s.delta = !TRUE_MASK;
    return s;
}

// A sample of the light chosen in `in`.
INLINE LightSample sample_light(LightInput in, Vec3 reference, Float u1, Float u2) {
    LightSample s = no_light_sample();
    UInt kind = as_UInt(light_field(in, kind));
#define SAMPLE_LIGHT(name, NAME)                                                                              \
    {                                                                                                         \
        Int mine = kind == (UInt)LIGHT_##NAME;                                                                \
        if (any_lane(mine)) s = select_sample(mine, name##_sample_light(in, reference, u1, u2), s);           \
    }
    SCENE_LIGHTS(SAMPLE_LIGHT)
#undef SAMPLE_LIGHT
    return s;
}

#if HAS_SURFACE_LIGHTS
// Density of `sample_light` producing a direction in which a surface light was hit.
INLINE Float surface_light_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal) {
    Float pdf = ZERO;
    UInt kind = as_UInt(light_field(in, kind));
#define PDF_LIGHT(name, NAME)                                                                                 \
    {                                                                                                         \
        Int mine = kind == (UInt)LIGHT_##NAME;                                                                \
        if (any_lane(mine)) pdf = SELECT(mine, name##_pdf(in, reference, direction, t, normal), pdf);         \
    }
    SCENE_SURFACE_LIGHTS(PDF_LIGHT)
#undef PDF_LIGHT
    return pdf;
}
#endif

#endif
