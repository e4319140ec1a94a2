// Glossy and diffuse lobes share all but the lobe that proposes the next direction: next-event estimation, BSDF sampling,
// and MIS between them. Both densities are mixtures over all non-delta lobes of the material.
#ifndef WAVELOBE_STAGES_SCATTER_SMOOTH_H
#define WAVELOBE_STAGES_SCATTER_SMOOTH_H

#include "sampling/mis.h"
#include "stages/continue_path.h"
#include "stages/scattering_surface.h"

#if HAS_CAUSTICS
#define GUIDE_PARAMETER , CausticGuide guide
#define GUIDE_ARGUMENT , guide
#define GUIDED_PDF(scene, pdf, direction) guided_pdf((scene)->caustics, guide, pdf, direction)
#else
#define GUIDE_PARAMETER
#define GUIDE_ARGUMENT
#define GUIDED_PDF(scene, pdf, direction) (pdf)
#endif

#if HAS_LIGHTS

// How far a shadow ray may look, as a share of its length: short of the light's own surface by the rounding of a hit's
// distance. GAMMA(16) covers the shear, the three products and sums and the division of the triangle test.
#define SHADOW_REACH (1.0f - 2.0f * GAMMA(16))

#if HAS_LIGHT_TREE
#define RECEIVER_PARAMETER , ReceiverCode receiver
#define RECEIVER_ARGUMENT , receiver
#else
#define RECEIVER_PARAMETER
#define RECEIVER_ARGUMENT
#endif

// Next-event estimation: appends the shadow rays of the lanes to which a light may contribute.
INLINE uint sample_direct_light(uint stage, Block block, uint at, const SceneView *scene, SampleId sample, const TracedPath *path,
                                const Surface *surface, const SmoothLobes *lobes GUIDE_PARAMETER RECEIVER_PARAMETER) {
    LightInput in = scene->lights;
    Float u_light = ZERO, u1, u2;
#if LIGHT_COUNT > 1
    Float u_deep; // for trees
    sample_2d(sample, vertex_pair(path->depth, PAIR_CHOICE), &u_light, &u_deep);
#endif
    sample_2d(sample, vertex_pair(path->depth, PAIR_LIGHT), &u1, &u2);
#if HAS_LIGHT_TREE
    Float choice = choose_light(&in, receiver_of(surface->position, receiver), u_light, u_deep, path->live);
#else
    Float choice = choose_light(&in, u_light);
#endif
    LightSample light = sample_light(in, surface->position, u1, u2);
    Int broken = mark_broken(block, stage, path->id, path->live & !(choice <= 0.0f),
                             finiteness3(light.radiance) + finiteness3(vec3(choice, light.pdf, light.direction.x)));
    Int shines = path->live & !broken & (choice > 0.0f) & (light.pdf > 0.0f) & (max_component(light.radiance) > 0.0f);
    if (!any_lane(shines)) return at;

    LobeValue value = eval_smooth_lobes(lobes, surface->wi, to_local(surface->frame, light.direction));
    value.pdf = GUIDED_PDF(scene, value.pdf, light.direction);
    value.f_cos = scale(value.f_cos, MAPPED_SHARE(surface, light.direction));
    Float pdf = choice * light.pdf;
    Rgb contribution = scale(mul(mul(path->throughput, value.f_cos), light.radiance), light_sample_share(pdf, value.pdf, light.delta));
    broken = mark_broken(block, stage, path->id, shines, finiteness3(contribution));
    Int contributes = shines & !broken & (max_component(contribution) > 0.0f);
    uint bits = lane_bits(contributes);
    if (bits == 0u) return at;

    Queue shadow = QUEUE(block, SHADOW);
    // From beyond the surface's rounding error to before the light's.
    Vec3 origin = offset_ray_origin(surface->position, surface->error, surface->normal, light.direction);
    Vec3 target = offset_ray_origin(light.point, light.error, light.normal, negate(light.direction));
    Vec3 way = sub(target, origin);
    Float distance = sqrt(length_squared(way));
    Vec3 direction = select3(light.at_infinity, light.direction, scale(way, 1.0f / distance));
    append_vec3(shadow, SHADOW_ORIGIN, at, origin, bits);
    append_vec3(shadow, SHADOW_DIRECTION, at, direction, bits);
    append_field(shadow, SHADOW_T, at, SELECT(light.at_infinity, (Float)INFINITY, distance * SHADOW_REACH), bits);
    append_vec3(shadow, SHADOW_CONTRIBUTION, at, contribution, bits);
    append_uint(shadow, SHADOW_ID, at, path->id, bits);
    append_uint(shadow, SHADOW_FROM, at, surface->primitive, bits);
#if HAS_FACETS
    append_uint(shadow, SHADOW_TO, at, as_UInt(light_field(in, triangle)), bits);
#endif
#if HAS_MEDIA
    UInt medium = medium_beyond(scene->media, scene->surfaces, surface, light.direction, path->medium);
    append_uint(shadow, SHADOW_MEDIUM, at, medium, bits);
#endif
    return at + popcount(bits);
}
#endif

INLINE Int transmits(SurfaceView view, const Surface *surface) {
    UInt known = SELECT(surface->material == (UInt)WAVELOBE_NONE, (UInt)0u, surface->material);
    return (GATHER_UINT_FIELD(view.materials, Material, known, flags) & (UInt)MATERIAL_TRANSMISSIVE) != (UInt)0u;
}

#if HAS_SMOOTH_TERMINATOR
// Light leaves the curved surface that the normals stand for; what is transmitted leaves the facet, above which there is none.
INLINE void leave_curved_surface(SurfaceView view, Surface *surface) {
    Vec3 rise = select3(transmits(view, surface), vec3_all(ZERO), surface->rise.front);
    raise_point(rise, &surface->position, &surface->error);
}
#endif

#if HAS_CAUSTICS
// What a sample is expected to bring is as much more than its throughput says as the guide has made its direction likelier: roulette
// has to know. (Its measure is the throughput times the square of this.)
INLINE Float guided_gain(Float pdf, Float unguided) {
    return SELECT(pdf > unguided, sqrt(pdf / GREATER(unguided, (Float)FLT_MIN)), ONE);
}
#endif

// A direction from the lobe of the queue's class or, of the share that is guided, from the guide.
INLINE Vec3 sample_direction(uint lobe_class, const SceneView *scene, const SmoothLobes *lobes, SampleId sample, UInt depth,
                             const Surface *surface GUIDE_PARAMETER) {
    Float u1, u2, u3 = ZERO;
    sample_2d(sample, vertex_pair(depth, PAIR_DIRECTION), &u1, &u2);
#if HAS_TRANSMISSION || HAS_LAYERED_LOBES || HAS_LOBE_PRINCIPLED // a lobe on both sides, or of several parts, chooses among them
    Float unused;
    sample_2d(sample, vertex_pair(depth, PAIR_CHOICE), &unused, &u3);
#endif
#if HAS_CAUSTICS
    Int guided = u1 < guide.share;
    Float of_guide = u1 / guide.share;
    u1 = SELECT(guided, ZERO, (u1 - guide.share) / (1.0f - guide.share));
#endif
    Vec3 wo = lobe_class == LOBE_CLASS_GLOSSY ? sample_glossy_lobe(lobes, surface->wi, u1, u2, u3)
                                              : sample_diffuse_lobe(lobes, surface->wi, u1, u2, u3);
#if HAS_CAUSTICS
    if (any_lane(guided)) wo = select3(guided, to_local(surface->frame, caustic_sample(scene->caustics, guide, of_guide, u2)), wo);
#endif
    return wo;
}

#if HAS_LIGHT_TREE
#if HAS_GLOSSY_RECEIVERS
INLINE UInt surface_lobe(const Surface *surface, const SmoothLobes *lobes) {
    Int glossy = has_lobe_of(lobes->lobes, GLOSSY_LOBES);
    if (!any_lane(glossy)) return (UInt)NO_LOBE;
#if HAS_MIXTURE
    Float diffuse = 1.0f - lobes->glossy_share;
#else
    Float diffuse = ZERO;
#endif
    Vec3 mirrored = mirror_direction(surface->wi);
    Float density = eval_smooth_lobes(lobes, surface->wi, mirrored).pdf;
    return SELECT(glossy, lobe_code(to_world(surface->frame, mirrored), density, diffuse), (UInt)NO_LOBE);
}
#endif

// How the surface receives light. One that transmits does from both sides, wherever its lobes point.
INLINE ReceiverCode surface_receiver(SurfaceView view, const Surface *surface, const SmoothLobes *lobes) {
    ReceiverCode code;
    code.normal = normal_code(surface->frame.n);
#if HAS_GLOSSY_RECEIVERS
    code.lobe = surface_lobe(surface, lobes);
#endif
#if HAS_TRANSMISSION
    code.normal = SELECT(transmits(view, surface), (UInt)RECEIVER_ANY, code.normal);
#endif
    return code;
}
#endif

// The body of both stages: `lobe_class` is a constant.
INLINE uint scatter_smooth(uint lobe_class, Block block, Queue paths, const SceneView *scene) {
    global const struct RenderParameters *parameters = scene->parameters;
    const uint stage = lobe_class == LOBE_CLASS_GLOSSY ? STAGE_SCATTER_GLOSSY : STAGE_SCATTER_DIFFUSE;
    Queue rays = QUEUE(block, RAYS);
    uint n = *paths.count, appended = *rays.count, shadows = block.header->count[QUEUE_SHADOW];
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(paths, i);
        SampleId sample = path_sample_id(block, path.id, parameters->sequence);
        Surface surface = load_scattering_surface(scene, &path, sample);
        MaterialInput in = material_input(&surface, scene->surfaces.materials, scene->textures, scene->texels);
        SmoothLobes lobes = load_smooth_lobes(material_lobes(&surface, in), in, surface.wi);
#if HAS_SMOOTH_TERMINATOR
        leave_curved_surface(scene->surfaces, &surface);
#endif
#if HAS_LIGHT_TREE
        ReceiverCode receiver = surface_receiver(scene->surfaces, &surface, &lobes);
#endif
#if HAS_CAUSTICS
        CausticGuide guide = caustic_guide(scene->caustics, surface.position, has_lobe_of(lobes.lobes, DIFFUSE_LOBES));
#endif
#if HAS_LIGHTS
        shadows = sample_direct_light(stage, block, shadows, scene, sample, &path, &surface, &lobes GUIDE_ARGUMENT RECEIVER_ARGUMENT);
#endif
        Vec3 wo = sample_direction(lobe_class, scene, &lobes, sample, path.depth, &surface GUIDE_ARGUMENT);
        LobeValue value = eval_smooth_lobes(&lobes, surface.wi, wo);
#if HAS_CAUSTICS
        Float unguided = value.pdf;
        value.pdf = guided_pdf(scene->caustics, guide, unguided, to_world(surface.frame, wo));
#endif
        Int alive = path.live & (value.pdf > 0.0f);
        Vec3 direction = normalize3(to_world(surface.frame, wo));
        Float share = MAPPED_SHARE(&surface, direction) / SELECT(alive, value.pdf, ONE);
        Rgb throughput = mul(path.throughput, scale(value.f_cos, share));
        Float finite = finiteness3(wo) + finiteness3(surface.position) + finiteness3(surface.wi) + finiteness3(value.f_cos) +
                       ZERO * value.pdf + SELECT(alive, finiteness3(throughput), ZERO);
        alive &= !mark_broken(block, stage, path.id, path.live, finite) & (max_component(throughput) > 0.0f);
        Float eta = PATH_ETA_OF(path) * crossed_index(in, surface.wi, wo);
#if HAS_CAUSTICS
        eta *= guided_gain(value.pdf, unguided);
#endif
        alive = roulette(sample, path.depth, eta, parameters->rr_depth, (Float)(1.0f / ROULETTE_THRESHOLD), &throughput, alive);
#if HAS_LIGHT_TREE
        append_uint(rays, PATH_RECEIVER, appended, receiver.normal, lane_bits(alive));
#if HAS_GLOSSY_RECEIVERS
        append_uint(rays, PATH_RECEIVER + 1u, appended, receiver.lobe, lane_bits(alive));
#endif
#endif
#if HAS_MEDIA
        UInt medium = medium_beyond(scene->media, scene->surfaces, &surface, direction, path.medium);
        append_uint(rays, PATH_MEDIUM, appended, medium, lane_bits(alive));
#endif
        appended = append_rays(rays, appended, &path, &surface, direction, throughput, value.pdf, eta, alive);
    }
    *rays.count = appended;
    *paths.count = 0u;
    block.header->count[QUEUE_SHADOW] = shadows;
    return n;
}

#endif
