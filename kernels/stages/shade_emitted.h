// Paths that hit a light gain its radiance, weighted against the light sample of the vertex before.
#ifndef WAVELOBE_STAGES_SHADE_EMITTED_H
#define WAVELOBE_STAGES_SHADE_EMITTED_H

#include "sampling/mis.h"
#include "stages/scene_view.h"

#if HAS_UNSAMPLED_EMITTERS
INLINE Int shape_flag(SurfaceView view, const Surface *surface, uint flag) {
    return (GATHER_UINT_FIELD(view.shapes, Shape, surface->shape, flags) & (UInt)flag) != (UInt)0u;
}
#endif

// Hit lights: which light of all, from the shape and the triangle.
INLINE UInt light_of_surface(SurfaceView view, const Surface *surface) {
    UInt first_light = GATHER_UINT_FIELD(view.shapes, Shape, surface->shape, first_light);
    UInt first_primitive = GATHER_UINT_FIELD(view.shapes, Shape, surface->shape, first_primitive);
    UInt per_light = GATHER_UINT_FIELD(view.shapes, Shape, surface->shape, triangles_per_light);
    UInt triangle = surface->primitive - first_primitive;
    Int common = per_light == (UInt)2u;
#if HAS_UNSAMPLED_EMITTERS
    common |= shape_flag(view, surface, SHAPE_UNSAMPLED);
#endif
    return first_light + SELECT(common, (UInt)0u, triangle);
}

// What the hit light emits towards the path, on its emitting side.
INLINE Rgb emitted_radiance(LightInput in, SurfaceView view, const Surface *surface) {
    Float u = surface->u, v = surface->v;
#if HAS_TEXTURED_EMITTERS && HAS_SECOND_UVS
    TextureBuffers buffers = {in.textures, in.texels};
    UInt texture = as_UInt(light_word(in, WORD_OFFSET(Light, radiance) + 3u));
    Int second = uses_second_uvs(buffers, SELECT(texture == (UInt)WAVELOBE_NONE, (UInt)0u, texture));
    u = SELECT(second, surface->second_u, u);
    v = SELECT(second, surface->second_v, v);
#endif
    Rgb radiance = light_radiance(in, u, v);
#if HAS_UNSAMPLED_EMITTERS && HAS_VERTEX_COLORS
    Int colored = shape_flag(view, surface, SHAPE_EMITS_COLORED);
    radiance = select3(colored, mul(radiance, surface->color), radiance);
#endif
    return radiance;
}

INLINE uint run_shade_emitted(Block block, const SceneView *scene) {
    SurfaceView view = scene->surfaces;
    Queue emitted = QUEUE(block, EMITTED);
    uint n = *emitted.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(emitted, i);
        Surface surface = load_surface(view, &path);
        LightInput in = scene->lights;
        in.light = SELECT(path.live, light_of_surface(view, &surface), (UInt)0u);
        Vec3 normal = surface.normal;
        Int facing = path.live & (dot3(normal, path.direction) < 0.0f);
        Rgb radiance = emitted_radiance(in, view, &surface);
        // A path that a delta lobe or the camera sent here could not have been made by light sampling.
        Int sampled = path.pdf >= 0.0f;
#if HAS_UNSAMPLED_EMITTERS
        sampled &= facing & !shape_flag(view, &surface, SHAPE_UNSAMPLED);
        facing |= path.live & shape_flag(view, &surface, SHAPE_EMITS_BEHIND);
#endif
        Float weight = ONE;
        if (any_lane(facing & sampled)) {
            // Where the path came from, to within the rounding of the hit.
#if HAS_ANALYTIC
            Vec3 reference = path.origin;
#else
            Vec3 reference = scale_add(path.direction, -path.t, surface.position);
#endif
#if LIGHT_COUNT == 1
            Float choice = ONE;
#elif HAS_LIGHT_TREE
            Float choice = placed_light_probability(in, receiver_of(reference, path.receiver), facing & sampled);
#else
            Float choice = GATHER_FIELD(in.lights, Light, in.light, selection_probability);
#endif
            Float light_pdf = choice * surface_light_pdf(in, reference, path.direction, path.t, normal);
            weight = SELECT(sampled, bsdf_sample_weight(path.pdf, light_pdf), ONE);
        }
        Rgb gain = scale(mul(path.throughput, radiance), weight);
        Float finite = finiteness3(normal) + SELECT(facing, finiteness3(gain), ZERO);
        Int broken = mark_broken(block, STAGE_SHADE_EMITTED, path.id, path.live, finite);
        add_radiance(block, path.id, gain, lane_bits(facing & !broken));
    }
    *emitted.count = 0u;
    return n;
}

#endif
