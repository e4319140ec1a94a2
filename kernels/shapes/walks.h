// Rays that have nothing in common, from a node of the hierarchy on: one after the other, or in large meshes WALKS at a time.
//
// What a ray visits next is known only when its last node has been tested, and in a large mesh it is not in the cache then. Of
// several rays each takes one step in turn, which ends by asking for what it visits next: when its turn comes again, that has
// come. Where everything is in the cache, to keep changing the ray costs more than it brings. After Kocberber, Falsafi, Grot
// 2015, "Asynchronous Memory Access Chaining".
#ifndef WAVELOBE_SHAPES_WALKS_H
#define WAVELOBE_SHAPES_WALKS_H

#include "shapes/packet.h"

#if HAS_PACKETS

#ifndef WALKS
#define WALKS 1u
#endif

INLINE Hit group_hit(const GroupHit *hits, uint k) {
    Hit h = {hits->t.value[k], hits->u.value[k], hits->v.value[k], hits->slot[k]};
    return h;
}

INLINE void set_group_hit(GroupHit *hits, uint k, Hit h) {
    hits->t.value[k] = h.t, hits->u.value[k] = h.u, hits->v.value[k] = h.v, hits->slot[k] = h.primitive;
}

#if WALKS > 1

// A ray on its way; as trace_closest_from keeps it.
typedef struct {
    Ray ray;
    BoxTest box;
    RayShear shear;
    Hit hit;
    uint current;
    uint top;
    uint index; // in its group
    ulong stack[BVH_STACK];
} Walk;

INLINE void start_walk(Walk *w, uint start, uint k, const RayGroup *group, const GroupSetup *setup, const GroupHit *hits) {
    w->ray = group_ray(group, k);
    w->box = group_box_test(group, setup, k);
    w->shear = group_shear(setup, k);
    w->hit = group_hit(hits, k);
    w->current = start;
    w->index = k;
    w->stack[0] = BVH_EMPTY;
    w->top = 1u;
}

// Tests one node or one block; 0 at the end of the way.
INLINE int take_step(Geometry g, Walk *w) {
    uint current = w->current;
    if (current & BVH_LEAF) {
        closest_in_block(g, current & ~BVH_LEAF, &w->ray, &w->shear, &w->hit);
    } else {
        global const uchar *node = g.nodes + ((size_t)current << NODE_SHIFT);
        float8 distance;
        uint mask = intersect_children(node, &w->box, REACH(w->hit.t), &distance);
        if (LIKELY(mask != 0u)) {
            w->current = push_children(g, mask, distance, (global const uint *)(node + NODE_CHILD_BYTES), w->stack, &w->top);
            fetch_ahead(g, w->current);
            return 1;
        }
    }
    w->current = pop_nearer(w->stack, &w->top, w->hit.t);
    fetch_ahead(g, w->current);
    return w->current != BVH_EMPTY;
}

INLINE void closest_one_by_one(Geometry g, uint start, uint rays, const RayGroup *group, const GroupSetup *setup, GroupHit *hits) {
    Walk walks[WALKS];
    uint going[WALKS]; // those of the walks that are on their way, first
    uint n = 0u;
    for (; rays && n < WALKS; n++) {
        POP_LOWEST_BIT(rays, k);
        start_walk(walks + n, start, k, group, setup, hits);
        going[n] = n;
    }
    while (n) {
        for (uint i = 0u; i < n; i++) {
            Walk *w = walks + going[i];
            if (LIKELY(take_step(g, w))) continue;
            set_group_hit(hits, w->index, w->hit);
            if (rays) {
                POP_LOWEST_BIT(rays, k);
                start_walk(w, start, k, group, setup, hits);
            } else {
                going[i] = going[--n];
            }
        }
    }
}

#else

INLINE void closest_one_by_one(Geometry g, uint start, uint rays, const RayGroup *group, const GroupSetup *setup, GroupHit *hits) {
    while (rays) {
        POP_LOWEST_BIT(rays, k);
        Ray r = group_ray(group, k);
        Hit h = group_hit(hits, k);
        trace_closest_from(g, start, &r, group_box_test(group, setup, k), group_shear(setup, k), &h);
        set_group_hit(hits, k, h);
    }
}

#endif

#endif
#endif
