// Sorts traced paths by what comes next: each goes into the queue of the escaped, of those that hit a light, and of the
// class of lobes that continues it. Paths with nothing left to do end here. Leaves the ray queue empty.
#ifndef WAVELOBE_STAGES_SORT_PATHS_H
#define WAVELOBE_STAGES_SORT_PATHS_H

#include "stages/scattering_surface.h"

// Copies the lanes of `bits` of the ray queue's group at slot i to the end of another queue.
INLINE uint move_paths(Queue to, uint at, Queue rays, uint i, Rgb throughput, uint bits) {
#pragma unroll
    for (uint f = 0u; f < TRACED_FIELDS; f++) {
        if (f - PATH_THROUGHPUT < 3u) continue;
        append_field(to, f, at, read_field(rays, f, i), bits);
    }
    append_vec3(to, PATH_THROUGHPUT, at, throughput, bits);
    return at + popcount(bits);
}

// Which lanes continue by which class of lobes, and what the choice does to the throughput.
typedef struct {
    Int delta, glossy, diffuse;
    Rgb throughput;
} Continuation;

// Where the queues of the classes end.
typedef struct {
    uint delta, glossy, diffuse;
} ClassEnds;

INLINE void move_to_classes(Block block, ClassEnds *ends, Queue rays, uint i, const Continuation *c) {
#if HAS_DELTA_LOBES
    uint d = lane_bits(c->delta);
    if (d) ends->delta = move_paths(QUEUE(block, DELTA), ends->delta, rays, i, c->throughput, d);
#endif
#if HAS_GLOSSY_LOBES
    uint g = lane_bits(c->glossy);
    if (g) ends->glossy = move_paths(QUEUE(block, GLOSSY), ends->glossy, rays, i, c->throughput, g);
#endif
#if HAS_DIFFUSE_LOBES
    uint f = lane_bits(c->diffuse);
    if (f) ends->diffuse = move_paths(QUEUE(block, DIFFUSE), ends->diffuse, rays, i, c->throughput, f);
#endif
}

// Of shapes all of whose materials are of one class.
INLINE Continuation class_of_shape(UInt flags, Int scattering, Rgb throughput) {
    Continuation c;
    c.delta = scattering & ((flags & (UInt)SHAPE_HAS_DELTA) != (UInt)0u);
    c.glossy = scattering & ((flags & (UInt)SHAPE_HAS_GLOSSY) != (UInt)0u);
    c.diffuse = scattering & ((flags & (UInt)SHAPE_HAS_DIFFUSE) != (UInt)0u);
    c.throughput = throughput;
    return c;
}

#if HAS_LOBE_CHOICE
// Some material has lobes of several classes, or differs between its sides: the surface decides.
INLINE Continuation choose_class(Block block, const SceneView *scene, const TracedPath *path, Int scattering) {
    SampleId sample = path_sample_id(block, path->id, scene->parameters->sequence);
    Surface surface = load_scattering_surface(scene, path, sample);
    MaterialInput in = material_input(&surface, scene->surfaces.materials, scene->textures, scene->texels);
    ClassWeights w = class_weights(material_lobes(&surface, in), in, surface.wi);
    Float unused, u;
    sample_2d(sample, vertex_pair(path->depth, PAIR_SURVIVAL), &unused, &u);
    Float smooth = w.glossy + w.diffuse, all = w.delta + smooth;
    Float at = u * all;
    scattering &= !mark_broken(block, STAGE_SORT_PATHS, path->id, scattering, ZERO * all);
    Int delta = at < w.delta;
    Continuation c;
    scattering &= all > 0.0f;
    c.delta = scattering & delta;
    c.glossy = scattering & !delta & (at < w.delta + w.glossy);
    c.diffuse = scattering & !delta & !c.glossy & (w.diffuse > 0.0f);
    // A sum's last rounding may point past a class of no weight.
    c.glossy |= scattering & !delta & (w.diffuse <= 0.0f);
    c.throughput = scale(path->throughput, SELECT(scattering, all / SELECT(delta, w.delta, smooth), ONE));
    return c;
}
#endif

#if HAS_VEILED_EMITTERS
#define PASSES_BEHIND 1

// Lanes of `veiled`, which have hit an emitter that is only partly there, whose paths go on behind it.
INLINE Int passes_veil(OpacityView o, Block block, SurfaceView view, Queue rays, uint i, Int veiled) {
    TracedPath path = read_traced_path(rays, i);
    path.hit = SELECT(veiled, path.hit, (UInt)0u);
    Surface surface = load_surface(view, &path);
    // A path may meet both sides of a sphere.
    Int entering = dot3(surface.normal, path.direction) < 0.0f;
    UInt event = surface.primitive | SELECT(entering, (UInt)0u, (UInt)0x80000000u);
    Float opacity = opacity_at(o, surface.shape, surface.u, surface.v, ONE);
    return veiled & passes(ray_key(o, block, path.id, path.direction), event, opacity);
}
#else
#define PASSES_BEHIND (HIDE_EMITTERS && HAS_SURFACE_LIGHTS)
#endif

#if HAS_MEDIA
#define MEDIA_VIEW_PARAMETER , MediaView media
#define MEDIA_VIEW_ARGUMENT(scene) , (scene)->media
#else
#define MEDIA_VIEW_PARAMETER
#define MEDIA_VIEW_ARGUMENT(scene)
#endif

#if PASSES_BEHIND
// Paths that pass a light are traced on from behind it. No light sample sees through it: the next light they find is all
// theirs.
INLINE uint pass_through(Queue rays, uint at, uint i, SurfaceView view, Int passing MEDIA_VIEW_PARAMETER) {
    uint bits = lane_bits(passing);
    TracedPath path = read_traced_path(rays, i);
    path.hit = SELECT(passing, path.hit, (UInt)0u);
    Surface surface = load_surface(view, &path);
    at = move_paths(rays, at, rays, i, path.throughput, bits);
    uint first = at - popcount(bits);
    append_vec3(rays, PATH_ORIGIN, first,
                offset_ray_origin(surface.position, surface.error, surface.normal, path.direction), bits);
    append_field(rays, PATH_T, first, (Float)INFINITY, bits);
    append_uint(rays, PATH_HIT, first, surface.primitive, bits);
    append_field(rays, PATH_PDF, first, (Float)-1.0f, bits);
#if HAS_MEDIA
    append_uint(rays, PATH_MEDIUM, first, medium_beyond(media, view, &surface, path.direction, path.medium), bits);
#endif
    return at;
}
#endif

#if HAS_LOBE_CHOICE && !PASSES_BEHIND
// Paths on surfaces that decide wait at the start of the ray queue until there is a vector full of them. So they come to the ends of
// their queues, too, and do not hold up the simple ones there.
#define CHOOSES_LATER 1

INLINE Int is_undecided(UInt flags) {
    UInt classes = flags & (UInt)(SHAPE_HAS_DELTA | SHAPE_HAS_GLOSSY | SHAPE_HAS_DIFFUSE);
    return (classes & (classes - (UInt)1u)) != (UInt)0u;
}

INLINE void sort_undecided(Block block, const SceneView *scene, Queue rays, uint waiting, ClassEnds *ends) {
    *rays.count = waiting;
    for (uint i = 0u; i < waiting; i += LANES) {
        TracedPath path = read_traced_path(rays, i);
        Continuation c = choose_class(block, scene, &path, path.live);
        move_to_classes(block, ends, rays, i, &c);
    }
}
#else
#define CHOOSES_LATER 0
#endif

INLINE uint run_sort_paths(Block block, const SceneView *scene) {
    global const struct RenderParameters *parameters = scene->parameters;
    Queue rays = QUEUE(block, RAYS);
    uint n = *rays.count;
    uint passed = 0u, escaped = 0u, emitted = 0u;
    ClassEnds ends = {0u, 0u, 0u};
#if CHOOSES_LATER
    uint waiting = 0u;
#endif
    for (uint i = 0u; i < n; i += LANES) {
        Int live = lanes_below(i, n);
        UInt hit = read_uint(rays, PATH_HIT, i);
        Int found = live & (hit != (UInt)HIT_NONE);
        Rgb throughput = read_vec3(rays, PATH_THROUGHPUT, i);
        UInt depth = read_uint(rays, PATH_DEPTH, i);
#if HAS_ENVIRONMENT
        Int leaving = live & !found;
#if EMISSION_RAYS
        leaving &= depth != (UInt)EMISSION_DEPTH;
#endif
        uint out = lane_bits(leaving);
        if (out) escaped = move_paths(QUEUE(block, ESCAPED), escaped, rays, i, throughput, out);
#endif
#if HAS_SURFACE_LIGHTS || !HAS_LOBE_CHOICE || CHOOSES_LATER
        UInt shape = gather_uint(scene->surfaces.primitive_shapes, primitive_of_hit(scene->surfaces, SELECT(found, hit, (UInt)0u)));
        UInt flags = GATHER_UINT_FIELD(scene->surfaces.shapes, Shape, shape, flags);
#endif
#if HIDE_EMITTERS && HAS_SURFACE_LIGHTS
        Int passing = found & ((flags & (UInt)SHAPE_EMITS) != (UInt)0u) & (depth == (UInt)0u);
        found &= !passing;
#elif PASSES_BEHIND
        Int passing = !TRUE_MASK;
#endif
#if HAS_SURFACE_LIGHTS
        Int emits = found & ((flags & (UInt)SHAPE_EMITS) != (UInt)0u);
#if EMISSION_RAYS
        emits &= depth != (UInt)0u; // what the camera sees is for rays of its own
#endif
        uint lit = lane_bits(emits);
        if (lit) emitted = move_paths(QUEUE(block, EMITTED), emitted, rays, i, throughput, lit);
#endif
#if HAS_VEILED_EMITTERS
        Int veiled = found & ((flags & (UInt)SHAPE_VEILED) != (UInt)0u);
        if (any_lane(veiled)) {
            Int behind = passes_veil(scene->geometry.opacity, block, scene->surfaces, rays, i, veiled);
            found &= !behind;
            passing |= behind;
        }
#endif
        Int scattering = found & (depth + (UInt)1u < (UInt)parameters->max_depth);
#if HAS_LOBE_CHOICE && !CHOOSES_LATER
        TracedPath path = read_traced_path(rays, i);
        path.hit = SELECT(found, path.hit, (UInt)0u);
        Continuation c = choose_class(block, scene, &path, scattering);
#elif CHOOSES_LATER
        Int undecided = scattering & is_undecided(flags);
        Continuation c = class_of_shape(flags, scattering & !undecided, throughput);
#else
        Continuation c = class_of_shape(flags, scattering, throughput);
#endif
        move_to_classes(block, &ends, rays, i, &c);
        // Last, because it writes over slots of this group and earlier ones.
#if CHOOSES_LATER
        uint later = lane_bits(undecided);
        if (later) waiting = move_paths(rays, waiting, rays, i, throughput, later);
#elif PASSES_BEHIND
        if (any_lane(passing)) passed = pass_through(rays, passed, i, scene->surfaces, passing MEDIA_VIEW_ARGUMENT(scene));
#endif
    }
#if CHOOSES_LATER
    sort_undecided(block, scene, rays, waiting, &ends);
#endif
    block.header->traced = n;
    global uint *count = block.header->count;
    count[QUEUE_RAYS] = passed;
    count[QUEUE_ESCAPED] = escaped;
    count[QUEUE_EMITTED] = emitted;
    count[QUEUE_DELTA] = ends.delta;
    count[QUEUE_GLOSSY] = ends.glossy;
    count[QUEUE_DIFFUSE] = ends.diffuse;
    return n;
}

#endif
