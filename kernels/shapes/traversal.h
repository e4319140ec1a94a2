// Single-ray traversal of the eight-wide hierarchy: closest hit and any hit.
//
// Children of a node (shapes/box_test.h) are visited in order of distance: the two to four that are usually hit are sorted as
// 64-bit keys (distance bits << 32 | child), which a positive float's bits allow.
//
// An instance is a leaf: the ray goes on in the space of its group, from the root of the group's hierarchy on, and comes
// back where the stack says so.
//
// Wants BVH_STACK: entries enough for the deepest path, 7 a level and a sentinel, and one where instances are.
#ifndef WAVELOBE_SHAPES_TRAVERSAL_H
#define WAVELOBE_SHAPES_TRAVERSAL_H

#include "shapes/box_test.h"
#include "shapes/geometry.h"
#include "shapes/ray_group.h"
#if HAS_ANALYTIC
#include "shapes/analytic_geometry.h"
#endif
#if HAS_MASKS
#include "shapes/masks.h"
#endif
#if HAS_INSTANCES
#include "shapes/instance.h"
#endif

#define CHILD_KEY(i) (((ulong)as_uint(entered[i]) << 32) | child[i])
#define SORT_KEYS(a, b) { ulong lesser_ = min(a, b), greater_ = max(a, b); a = lesser_; b = greater_; }

// Pushes all children of the mask but the nearest, farthest first, and returns the nearest. The others are asked for: they will
// be in the cache by the time they are popped.
INLINE uint push_children(Geometry g, uint mask, float8 distance, global const uint *child, ulong *stack, uint *top) {
    POP_LOWEST_BIT(mask, i0);
    if (LIKELY(mask == 0u)) return child[i0];
    float entered[8] __attribute__((aligned(32)));
    *(float8 *)entered = distance;
    POP_LOWEST_BIT(mask, i1);
    ulong k0 = CHILD_KEY(i0), k1 = CHILD_KEY(i1);
    SORT_KEYS(k0, k1);
    uint n = *top;
    fetch_ahead(g, (uint)k1);
    if (LIKELY(mask == 0u)) {
        stack[n] = k1;
        *top = n + 1u;
        return (uint)k0;
    }
    POP_LOWEST_BIT(mask, i2);
    ulong k2 = CHILD_KEY(i2);
    SORT_KEYS(k1, k2);
    SORT_KEYS(k0, k1);
    fetch_ahead(g, (uint)k2);
    if (LIKELY(mask == 0u)) {
        stack[n] = k2, stack[n + 1u] = k1;
        *top = n + 2u;
        return (uint)k0;
    }
    POP_LOWEST_BIT(mask, i3);
    ulong k3 = CHILD_KEY(i3);
    SORT_KEYS(k2, k3);
    SORT_KEYS(k1, k2);
    SORT_KEYS(k0, k1);
    uint base = n;
    stack[n] = k3, stack[n + 1u] = k2, stack[n + 2u] = k1;
    n += 3u;
    while (mask) { // rare: five and more, by insertion
        POP_LOWEST_BIT(mask, i);
        ulong key = CHILD_KEY(i), pushed = max(key, k0);
        k0 = min(key, k0);
        uint j = n++;
        for (; j > base && stack[j - 1u] < pushed; j--) stack[j] = stack[j - 1u];
        stack[j] = pushed;
    }
    *top = n;
    return (uint)k0;
}

#if HAS_MASKS
#define ANALYTIC_ID(entry) ((entry) & ~PRIMITIVE_MASKED)
#else
#define ANALYTIC_ID(entry) (entry)
#endif

#if HAS_ANALYTIC
INLINE void closest_analytic(Geometry g, uint reference, const Ray *r, Hit *hit) {
    uint first = (reference & ~(BVH_LEAF | BVH_ANALYTIC)) >> 4;
    for (uint i = first; i < first + (reference & 15u); i++) {
        uint shape = ANALYTIC_ID(g.analytic_order[i]);
        float t = intersect_analytic(g.analytics + shape, r, 0.0f, hit->t);
#if HAS_MASKS
        t = first_not_passed(g.opacity, g.analytics, g.analytic_order[i], r, t, hit->t);
#endif
        if (t < hit->t) {
            hit->t = t;
            hit->primitive = HIT_ANALYTIC | shape;
        }
    }
}
#endif

// Of triangles at the same distance, that of the lowest number is hit: the order of visits shall not matter. Whether the
// triangle of this number comes before what was hit at its distance; nothing was: the distance is the limit, which is out.
INLINE int precedes(Geometry g, uint number, uint slot) {
    if (slot & HIT_ANALYTIC) return 0; // or HIT_NONE
    global const uchar *block = g.blocks + (size_t)(slot / BVH_WIDTH) * sizeof(struct TriangleBlock);
    return number < ((global const uint *)(block + BLOCK_PRIMITIVE_BYTES))[slot % BVH_WIDTH];
}

INLINE void closest_in_block(Geometry g, uint index, const Ray *r, const RayShear *shear, Hit *hit) {
    global const uchar *block = g.blocks + (size_t)index * sizeof(struct TriangleBlock);
    float8 t, u, v;
    uint mask = intersect_triangle_block(block, shear, r, hit->t, &t, &u, &v);
    if (LIKELY(mask == 0u)) return;
#if HAS_MASKS
    mask = not_passed(g.opacity, block, mask, r, u, v);
    if (mask == 0u) return;
#endif
    float ts[8] __attribute__((aligned(32))), us[8] __attribute__((aligned(32))), vs[8] __attribute__((aligned(32)));
    *(float8 *)ts = t;
    global const uint *numbers = (global const uint *)(block + BLOCK_PRIMITIVE_BYTES);
    POP_LOWEST_BIT(mask, nearest);
    while (mask) {
        POP_LOWEST_BIT(mask, i);
        int nearer = (ts[i] < ts[nearest]) | ((ts[i] == ts[nearest]) & (numbers[i] < numbers[nearest]));
        nearest = nearer ? i : nearest;
    }
    if (UNLIKELY(ts[nearest] == hit->t) && !precedes(g, numbers[nearest], hit->primitive)) return;
    *(float8 *)us = u;
    *(float8 *)vs = v;
    hit->t = ts[nearest];
    hit->u = us[nearest];
    hit->v = vs[nearest];
    hit->primitive = index * BVH_WIDTH + nearest;
}

#if HAS_INSTANCES
// Turns the traversal to the space of an instance; 0 if the ray gets lost on the way.
INLINE int enter_instance(Geometry g, uint index, const Ray *world, Ray *inner, float *stretch, BoxTest *box,
                          RayShear *shear) {
    *inner = instance_ray(g.instances, index, world, stretch);
    *box = box_test(inner);
    *shear = ray_shear(inner);
    return is_finite_ray(inner);
}
#endif

// Pops what is not behind a hit at distance t. The sentinel's distance of 0 is below any limit: every hit has t > 0.
INLINE uint pop_nearer(const ulong *stack, uint *top, float t) {
    ulong limit_key = (ulong)as_uint(REACH(t)) << 32, key;
    uint n = *top;
    do key = stack[--n];
    while (UNLIKELY(key >= limit_key));
    *top = n;
    return (uint)key;
}

// What of the subtree `current` is nearer than *hit.
INLINE void trace_closest_from(Geometry g, uint current, const Ray *r, BoxTest box, RayShear shear, Hit *found_hit) {
    Hit hit = *found_hit;
    ulong stack[BVH_STACK];
    stack[0] = BVH_EMPTY;
    uint top = 1u;
#if HAS_INSTANCES
    const Ray *world = r;
    Ray inner;
    uint instance = INSTANCE_NONE;
    float found = hit.t; // the nearest hit of which it is known in what instance it is
    float outside = hit.t, entered = hit.t, stretch; // the limit before the instance, the same in its space
#endif
    for (;;) {
        while (!(current & BVH_LEAF)) {
            global const uchar *node = g.nodes + ((size_t)current << NODE_SHIFT);
            float8 distance;
            uint mask = intersect_children(node, &box, REACH(hit.t), &distance);
            if (UNLIKELY(mask == 0u)) goto pop;
            current = push_children(g, mask, distance, (global const uint *)(node + NODE_CHILD_BYTES), stack, &top);
        }
#if HAS_ANALYTIC
        if (current & BVH_ANALYTIC) {
            closest_analytic(g, current, r, &hit);
            goto pop;
        }
#endif
#if HAS_INSTANCES
        if (current & BVH_INSTANCE) {
            instance = current & ~(BVH_LEAF | BVH_INSTANCE);
            if (!enter_instance(g, instance, world, &inner, &stretch, &box, &shear)) goto leave;
            r = &inner;
            outside = hit.t;
            hit.t = entered = found = outside * stretch;
            stack[top++] = BVH_RETURN;
            current = g.instances[instance].root;
            continue;
        }
#endif
        closest_in_block(g, current & ~BVH_LEAF, r, &shear, &hit);
    pop:;
#if HAS_INSTANCES
        if (hit.t < found) hit.instance = instance;
        found = hit.t;
#endif
        current = pop_nearer(stack, &top, hit.t);
        if (current == BVH_EMPTY) break;
#if HAS_INSTANCES
        if (current == BVH_RETURN) {
            hit.t = found = hit.t < entered ? min(hit.t / stretch, outside) : outside;
        leave:
            r = world;
            instance = INSTANCE_NONE;
            box = box_test(r);
            shear = ray_shear(r);
            goto pop;
        }
#endif
    }
    *found_hit = hit;
}

// Nothing yet.
INLINE Hit no_hit(const Ray *r) {
    Hit hit = {
        r->limit, 0.0f, 0.0f, HIT_NONE,
#if HAS_INSTANCES
        INSTANCE_NONE,
#endif
    };
    return hit;
}

// The nearest hit in (0, limit); `primitive` is HIT_NONE and `t` the limit when there is none.
INLINE Hit trace_closest(Geometry g, const Ray *r) {
    Hit hit = no_hit(r);
    // Also a limit that is not a number has no room for a hit.
    if (LIKELY(r->limit > 0.0f && is_finite_ray(r))) trace_closest_from(g, 0u, r, box_test(r), ray_shear(r), &hit);
    return hit;
}

// The same of ray i of a group, of which the `sound` ones can hit something.
INLINE Hit trace_closest_of_group(Geometry g, const RayGroup *group, const GroupSetup *setup, uint sound, uint i) {
    Ray r = group_ray(group, i);
    Hit hit = no_hit(&r);
    if (LIKELY(sound >> i & 1u)) trace_closest_from(g, 0u, &r, group_box_test(group, setup, i), group_shear(setup, i), &hit);
    return hit;
}

#if HAS_ANALYTIC
INLINE uint any_analytic(Geometry g, uint reference, const Ray *r) {
    uint first = (reference & ~(BVH_LEAF | BVH_ANALYTIC)) >> 4;
    for (uint i = first; i < first + (reference & 15u); i++) {
        uint shape = ANALYTIC_ID(g.analytic_order[i]);
        float t = intersect_analytic(g.analytics + shape, r, 0.0f, r->limit);
#if HAS_MASKS
        t = first_not_passed(g.opacity, g.analytics, g.analytic_order[i], r, t, r->limit);
#endif
        if (t < r->limit) return 1u;
    }
    return 0u;
}
#endif

// Hits at the limit itself do not count.
INLINE float just_below(float limit) { return as_float(as_uint(limit) - 1u); }

// 1 if anything of the subtree `current` is hit in (0, limit).
INLINE uint trace_any_from(Geometry g, uint current, const Ray *r, BoxTest box, RayShear shear) {
    uint stack[BVH_STACK];
    stack[0] = BVH_EMPTY;
    uint top = 1u;
#if HAS_INSTANCES
    const Ray *world = r;
    Ray inner;
    float stretch;
#endif
    for (;;) {
        while (!(current & BVH_LEAF)) {
            global const uchar *node = g.nodes + ((size_t)current << NODE_SHIFT);
            global const uint *child = (global const uint *)(node + NODE_CHILD_BYTES);
            float8 distance;
            uint mask = intersect_children(node, &box, REACH(r->limit), &distance);
            if (UNLIKELY(mask == 0u)) {
                current = stack[--top];
                continue;
            }
            POP_LOWEST_BIT(mask, i0);
            current = child[i0];
            while (mask) {
                POP_LOWEST_BIT(mask, i);
                fetch_ahead(g, current);
                stack[top++] = current;
                current = child[i];
            }
        }
        if (current == BVH_EMPTY) return 0u;
#if HAS_INSTANCES
        if (current == BVH_RETURN) {
        leave:
            r = world;
            box = box_test(r);
            shear = ray_shear(r);
            current = stack[--top];
            continue;
        }
#endif
#if HAS_ANALYTIC
        if (current & BVH_ANALYTIC) {
            if (any_analytic(g, current, r)) return 1u;
            current = stack[--top];
            continue;
        }
#endif
#if HAS_INSTANCES
        if (current & BVH_INSTANCE) {
            uint instance = current & ~(BVH_LEAF | BVH_INSTANCE);
            if (!enter_instance(g, instance, world, &inner, &stretch, &box, &shear)) goto leave;
            r = &inner;
            stack[top++] = BVH_RETURN;
            current = g.instances[instance].root;
            continue;
        }
#endif
        uint block = current & ~BVH_LEAF;
        global const uchar *triangles = g.blocks + (size_t)block * sizeof(struct TriangleBlock);
        float8 t, u, v;
        uint mask = intersect_triangle_block(triangles, &shear, r, just_below(r->limit), &t, &u, &v);
#if HAS_MASKS
        if (UNLIKELY(mask)) mask = not_passed(g.opacity, triangles, mask, r, u, v);
#endif
        if (UNLIKELY(mask)) return 1u;
        current = stack[--top];
    }
}

// 1 if anything is hit in (0, limit).
INLINE uint trace_any(Geometry g, const Ray *r) {
    return LIKELY(r->limit > 0.0f && is_finite_ray(r)) ? trace_any_from(g, 0u, r, box_test(r), ray_shear(r)) : 0u;
}

// Bits of the `rays` that hit anything of the subtree `start`.
INLINE uint any_one_by_one(Geometry g, uint start, uint rays, const RayGroup *group, const GroupSetup *setup) {
    uint blocked = 0u;
    while (rays) {
        POP_LOWEST_BIT(rays, k);
        Ray r = group_ray(group, k);
        blocked |= trace_any_from(g, start, &r, group_box_test(group, setup, k), group_shear(setup, k)) << k;
    }
    return blocked;
}

#endif
