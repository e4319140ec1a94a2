// The lobes of a material together. The host defines, from lobes.def and the scene's materials,
//   SCENE_DELTA_LOBES(X), SCENE_GLOSSY_LOBES(X), SCENE_DIFFUSE_LOBES(X)
// each a list of X(name, NAME), and includes the headers of these lobes before this one.
#ifndef WAVELOBE_BSDF_MATERIAL_H
#define WAVELOBE_BSDF_MATERIAL_H

#include "bsdf/lobe.h"
#include "shapes/surface.h"

// The parameter record of lobe `name`.
#define LOBE_RECORD(name) __typeof__(name##_load((MaterialInput){}))
#define SCENE_SMOOTH_LOBES(X) SCENE_GLOSSY_LOBES(X) SCENE_DIFFUSE_LOBES(X)

#if HAS_TEXTURES
#define TEXTURE_PARAMETERS , global const struct Texture *textures, global const float *texels
#define TEXTURE_ARGUMENTS textures, texels
#else
#define TEXTURE_PARAMETERS
#define TEXTURE_ARGUMENTS 0, 0
#endif

INLINE MaterialInput material_input(const Surface *surface, global const struct Material *materials,
                                    global const struct Texture *textures, global const float *texels) {
    MaterialInput in;
    in.material = SELECT(surface->material == (UInt)WAVELOBE_NONE, (UInt)0u, surface->material);
    in.u = surface->u;
    in.v = surface->v;
#if HAS_SECOND_UVS
    in.second_u = surface->second_u;
    in.second_v = surface->second_v;
#endif
#if HAS_VERTEX_COLORS
    in.color = surface->color;
#endif
    in.materials = materials;
    in.textures = textures;
    in.texels = texels;
#if HAS_COAT_NORMALS
    // Where the frame has been turned to the back, all of the map's normal is.
    Frame f = surface->unmapped;
    Float side = SELECT(dot3(f.n, surface->frame.n) < 0.0f, (Float)-1.0f, ONE);
    in.unmapped.s = scale(to_local(surface->frame, f.s), side);
    in.unmapped.t = scale(to_local(surface->frame, f.t), side);
    in.unmapped.n = scale(to_local(surface->frame, f.n), side);
#endif
    return in;
}

// Which lobes each lane has; none where the surface is black.
INLINE UInt material_lobes(const Surface *surface, MaterialInput in) {
    UInt lobes = GATHER_UINT_FIELD(in.materials, Material, in.material, lobes);
    return SELECT(surface->material == (UInt)WAVELOBE_NONE, (UInt)0u, lobes);
}

INLINE Int has_lobe(UInt lobes, uint lobe) { return (lobes & (UInt)(1u << lobe)) != (UInt)0u; }

// The bits of all lobes of a class, and whether a lane has any of them.
#define LOBE_BIT(name, NAME) | (1u << LOBE_##NAME)
#define GLOSSY_LOBES (0u SCENE_GLOSSY_LOBES(LOBE_BIT))
#define DIFFUSE_LOBES (0u SCENE_DIFFUSE_LOBES(LOBE_BIT))
INLINE Int has_lobe_of(UInt lobes, uint set) { return (lobes & (UInt)set) != (UInt)0u; }

// ---- evaluation: all glossy and diffuse lobes at once ---------------------------------------------------

// The non-delta lobes of a group, loaded once and evaluated for each direction of interest.
typedef struct {
    UInt lobes;
    Float glossy_share; // chance of the glossy lobe among the non-delta ones
#define LOBE_MEMBER(name, NAME) LOBE_RECORD(name) name;
    SCENE_SMOOTH_LOBES(LOBE_MEMBER)
#undef LOBE_MEMBER
} SmoothLobes;

#if HAS_MIXTURE
// Some material has both a glossy and a diffuse lobe.
INLINE Float glossy_share(const SmoothLobes *l, Vec3 wi) {
    Float glossy = ZERO, diffuse = ZERO;
#define LOBE_SHARE(name, NAME, sum) sum += SELECT(has_lobe(l->lobes, LOBE_##NAME), name##_weight(l->name, wi), ZERO);
#define GLOSSY_SHARE(name, NAME) LOBE_SHARE(name, NAME, glossy)
#define DIFFUSE_SHARE(name, NAME) LOBE_SHARE(name, NAME, diffuse)
    SCENE_GLOSSY_LOBES(GLOSSY_SHARE)
    SCENE_DIFFUSE_LOBES(DIFFUSE_SHARE)
#undef GLOSSY_SHARE
#undef DIFFUSE_SHARE
#undef LOBE_SHARE
    Float all = glossy + diffuse;
    return SELECT(all > 0.0f, glossy / all, ZERO);
}
#endif

INLINE SmoothLobes load_smooth_lobes(UInt lobes, MaterialInput in, Vec3 wi) {
    SmoothLobes l;
    l.lobes = lobes;
#define LOBE_LOAD(name, NAME) l.name = name##_load(in);
    SCENE_SMOOTH_LOBES(LOBE_LOAD)
#undef LOBE_LOAD
#if HAS_MIXTURE
    l.glossy_share = glossy_share(&l, wi);
#endif
    return l;
}

// Value and mixture density of all non-delta lobes.
INLINE LobeValue eval_smooth_lobes(const SmoothLobes *l, Vec3 wi, Vec3 wo) {
    LobeValue sum = lobe_value(vec3_all(ZERO), ZERO);
#if HAS_MIXTURE
#define SHARE(share) (share)
#else
#define SHARE(share) ONE
#endif
#define LOBE_EVAL(name, NAME, share)                                                       \
    {                                                                                      \
        Int mine = has_lobe(l->lobes, LOBE_##NAME);                                        \
        if (any_lane(mine)) {                                                              \
            LobeValue v = name##_eval(l->name, wi, wo);                                    \
            sum.f_cos = add(sum.f_cos, select3(mine, v.f_cos, vec3_all(ZERO)));            \
            sum.pdf += SELECT(mine, v.pdf * SHARE(share), ZERO);                           \
        }                                                                                  \
    }
#define GLOSSY_EVAL(name, NAME) LOBE_EVAL(name, NAME, l->glossy_share)
#define DIFFUSE_EVAL(name, NAME) LOBE_EVAL(name, NAME, 1.0f - l->glossy_share)
    SCENE_GLOSSY_LOBES(GLOSSY_EVAL)
    SCENE_DIFFUSE_LOBES(DIFFUSE_EVAL)
#undef GLOSSY_EVAL
#undef DIFFUSE_EVAL
#undef LOBE_EVAL
#undef SHARE
    return sum;
}

// A direction from the lobe of the class whose queue this is.
#define LOBE_SAMPLE(name, NAME)                                                 \
    {                                                                           \
        Int mine = has_lobe(l->lobes, LOBE_##NAME);                             \
        if (any_lane(mine)) wo = select3(mine, name##_sample(l->name, wi, u1, u2, u3), wo); \
    }

INLINE Vec3 sample_glossy_lobe(const SmoothLobes *l, Vec3 wi, Float u1, Float u2, Float u3) {
    Vec3 wo = vec3_all(ZERO);
    SCENE_GLOSSY_LOBES(LOBE_SAMPLE)
    return wo;
}

INLINE Vec3 sample_diffuse_lobe(const SmoothLobes *l, Vec3 wi, Float u1, Float u2, Float u3) {
    Vec3 wo = vec3_all(ZERO);
    SCENE_DIFFUSE_LOBES(LOBE_SAMPLE)
    return wo;
}
#undef LOBE_SAMPLE

// The relative index a direction crosses into: 1 on the side it came from.
INLINE Float crossed_index(MaterialInput in, Vec3 wi, Vec3 wo) {
#if HAS_TRANSMISSION
    Int crosses = wi.z * wo.z < 0.0f;
    if (any_lane(crosses)) {
        Float eta = load_constant(in, eta.x);
        return SELECT(crosses, SELECT(wi.z > 0.0f, eta, 1.0f / eta), ONE);
    }
#endif
    return ONE;
}

// ---- delta lobes: followed, never evaluated ---------------------------------------------------------------

// A material has at most one delta lobe.
INLINE DeltaSample sample_delta_lobe(UInt lobes, MaterialInput in, Vec3 wi, Float u) {
    DeltaSample s = {vec3_all(ZERO), vec3_all(ZERO), ONE};
#define DELTA_SAMPLE(name, NAME)                             \
    {                                                        \
        Int mine = has_lobe(lobes, LOBE_##NAME);             \
        if (any_lane(mine)) {                                \
            DeltaSample one = name##_sample(name##_load(in), wi, u); \
            s.wo = select3(mine, one.wo, s.wo);              \
            s.weight = select3(mine, one.weight, s.weight);  \
            s.eta = SELECT(mine, one.eta, s.eta);            \
        }                                                    \
    }
    SCENE_DELTA_LOBES(DELTA_SAMPLE)
#undef DELTA_SAMPLE
    return s;
}

// ---- choice of a class of lobes ------------------------------------------------------------------------

// Relative chances of the three classes at a surface.
typedef struct {
    Float delta, glossy, diffuse;
} ClassWeights;

INLINE ClassWeights class_weights(UInt lobes, MaterialInput in, Vec3 wi) {
    ClassWeights w = {ZERO, ZERO, ZERO};
#define LOBE_WEIGHT(name, NAME, sum) \
    sum += SELECT(has_lobe(lobes, LOBE_##NAME), name##_weight(name##_load(in), wi), ZERO);
#define DELTA_WEIGHT(name, NAME) LOBE_WEIGHT(name, NAME, w.delta)
#define GLOSSY_WEIGHT(name, NAME) LOBE_WEIGHT(name, NAME, w.glossy)
#define DIFFUSE_WEIGHT(name, NAME) LOBE_WEIGHT(name, NAME, w.diffuse)
    SCENE_DELTA_LOBES(DELTA_WEIGHT)
    SCENE_GLOSSY_LOBES(GLOSSY_WEIGHT)
    SCENE_DIFFUSE_LOBES(DIFFUSE_WEIGHT)
#undef DELTA_WEIGHT
#undef GLOSSY_WEIGHT
#undef DIFFUSE_WEIGHT
#undef LOBE_WEIGHT
    return w;
}

#endif
