// Groups of LANES rays through the hierarchy. What goes together of a group is a packet (shapes/packet.h): a node is tested once
// for all its rays by intervals, leaves then for each ray; a triangle is tested for all rays at once. What has at most
// SINGLE_RAYS rays left goes on ray by ray (shapes/walks.h), and so do groups that never agreed. Shadow rays to one lamp may
// differ in their signs and are a packet all the same; of closest hits such packets made the first bounce 10 % faster, and
// the third 15 % slower.
// Reshetov, Soupikov, Hurley 2005, "Multi-Level Ray Tracing Algorithm" (intervals); Benthin, Wald, Woop, Ernst, Mark 2012,
// "Combining Single and Packet-Ray Tracing for Arbitrary Ray Distributions on the Intel MIC Architecture" (the way down to
// single rays).
//
// A ray meets the same triangles with the same rounding in a packet and alone, and of equally near ones the same is taken
// (precedes), so that how rays are grouped changes no bit.
#ifndef WAVELOBE_SHAPES_TRACE_GROUPS_H
#define WAVELOBE_SHAPES_TRACE_GROUPS_H

#include "shapes/walks.h"

#if HAS_PACKETS

#define SINGLE_RAYS 3u // so many are cheaper one by one

// ---- closest hits --------------------------------------------------------------------------------------------

typedef struct {
    ulong key[BVH_STACK];
    ushort rays[BVH_STACK];
    uint top;
} PacketStack;

// Pushes the children of a node that rays of the packet meet, farthest first, and returns the nearest, or BVH_EMPTY.
INLINE uint push_packet_children(Geometry g, uint index, const Packet *p, Float reach, float farthest, uint *rays, PacketStack *stack) {
    global const uchar *node = g.nodes + ((size_t)index << NODE_SHIFT);
    float8 distance;
    uint mask = intersect_children(node, &p->all, farthest, &distance);
    float entered[8] __attribute__((aligned(32)));
    *(float8 *)entered = distance;
    global const uint *child = (global const uint *)(node + NODE_CHILD_BYTES);
    ulong nearest = ~0ul;
    uint nearest_rays = 0u, base = stack->top, n = base;
    while (mask) {
        POP_LOWEST_BIT(mask, i);
        // The intervals are enough for inner nodes: what few rays meet is found out below.
        uint in = *rays & ((child[i] & BVH_LEAF) ? rays_in_child(node, i, p, reach) : ~0u);
        if (in == 0u) continue;
        ulong key = CHILD_KEY(i);
        if (nearest_rays == 0u) { // the first
            nearest = key, nearest_rays = in;
            continue;
        }
        if (key < nearest) {
            ulong other = nearest;
            uint others = nearest_rays;
            nearest = key, nearest_rays = in;
            key = other, in = others;
        }
        fetch_ahead(g, (uint)key);
        uint j = n++;
        for (; j > base && stack->key[j - 1u] < key; j--) stack->key[j] = stack->key[j - 1u], stack->rays[j] = stack->rays[j - 1u];
        stack->key[j] = key, stack->rays[j] = (ushort)in;
    }
    stack->top = n;
    *rays = nearest_rays;
    return nearest_rays ? (uint)nearest : BVH_EMPTY;
}

// What the packet's `rays` hit in block `index`.
INLINE void closest_for_packet(Geometry g, uint index, uint rays, const Packet *p, const RayGroup *group, GroupHit *hit) {
    global const uchar *block = g.blocks + (size_t)index * sizeof(struct TriangleBlock);
    global const uint *numbers = (global const uint *)(block + BLOCK_PRIMITIVE_BYTES);
    for (uint i = 0u; i < BVH_WIDTH && numbers[i] != HIT_NONE; i++) {
        Float nearest = LANES_OF(hit->t), t, u, v;
        uint met = rays_at_triangle(block, i, numbers[i], rays, p, group, nearest, &t, &u, &v);
        if (met == 0u) continue;
        uint equal = met & lane_bits(t == nearest);
        while (UNLIKELY(equal)) {
            POP_LOWEST_BIT(equal, k);
            if (!precedes(g, numbers[i], hit->slot[k])) met &= ~(1u << k);
        }
        Int taken = mask_of_bits(met);
        *(Float *)hit->t.value = SELECT(taken, t, nearest);
        *(Float *)hit->u.value = SELECT(taken, u, LANES_OF(hit->u));
        *(Float *)hit->v.value = SELECT(taken, v, LANES_OF(hit->v));
        *(UInt *)hit->slot = SELECT(taken, (UInt)(index * BVH_WIDTH + i), *(const UInt *)hit->slot);
    }
}

// The nearest hits of the `live` rays in (0, limit).
INLINE void trace_closest_group(Geometry g, const RayGroup *group, uint live, GroupHit *hit) {
    hit->t = group->limit;
    *(Float *)hit->u.value = ZERO;
    *(Float *)hit->v.value = ZERO;
    *(UInt *)hit->slot = (UInt)HIT_NONE;
    GroupSetup setup;
    uint left = set_up_group(group, live, &setup);
    PacketStack stack;
    while (left) {
        Packet p = make_packet(group, &setup, left, 0);
        // A ray alone is a packet that is already at its end: so both ways share the code.
        int together = popcount(p.rays) >= LEAST_PACKET;
        uint current = 0u, rays = together ? p.rays : left;
        left &= ~rays;
        stack.key[0] = BVH_EMPTY; // at distance 0: always popped
        stack.rays[0] = (ushort)rays;
        stack.top = 1u;
        Float reach = REACH(LANES_OF(hit->t));
        float farthest = greatest_of(rays, reach);
        for (;;) {
            if (!together || popcount(rays) <= SINGLE_RAYS) {
                closest_one_by_one(g, current, rays, group, &setup, hit);
            } else if (current & BVH_LEAF) {
                closest_for_packet(g, current & ~BVH_LEAF, rays, &p, group, hit);
            } else {
                current = push_packet_children(g, current, &p, reach, farthest, &rays, &stack);
                if (current != BVH_EMPTY) continue;
                goto pop;
            }
            reach = REACH(LANES_OF(hit->t));
        pop:
            do { // passing by what lies behind the hits
                stack.top--;
                ulong key = stack.key[stack.top];
                current = (uint)key;
                rays = stack.rays[stack.top] & lane_bits(reach > (Float)as_float((uint)(key >> 32)));
            } while (rays == 0u);
            if (current == BVH_EMPTY) break;
        }
    }
}

// ---- any hit -------------------------------------------------------------------------------------------------

// Bits of the packet's `rays` that hit anything in block `index` up to `limit`.
INLINE uint any_for_packet(Geometry g, uint index, uint rays, const Packet *p, const RayGroup *group, Float limit) {
    global const uchar *block = g.blocks + (size_t)index * sizeof(struct TriangleBlock);
    global const uint *numbers = (global const uint *)(block + BLOCK_PRIMITIVE_BYTES);
    uint blocked = 0u;
    for (uint i = 0u; i < BVH_WIDTH && numbers[i] != HIT_NONE; i++) {
        Float t, u, v;
        blocked |= rays_at_triangle(block, i, numbers[i], rays & ~blocked, p, group, limit, &t, &u, &v);
    }
    return blocked;
}

// Pushes the children of a node that rays of the packet meet within their reach, the farthest of which is `farthest`.
INLINE void push_any_children(Geometry g, uint index, uint rays, const Packet *p, Float reach, float farthest, PacketStack *stack) {
    global const uchar *node = g.nodes + ((size_t)index << NODE_SHIFT);
    global const uint *child = (global const uint *)(node + NODE_CHILD_BYTES);
    float8 distance;
    uint mask = intersect_packet_children(node, p, farthest, &distance);
    while (mask) {
        POP_LOWEST_BIT(mask, i);
        uint in = rays & rays_in_child(node, i, p, reach);
        fetch_ahead(g, child[i]);
        stack->key[stack->top] = child[i], stack->rays[stack->top] = (ushort)in;
        stack->top += in != 0u;
    }
}

// Bits of the `live` rays that hit anything in (0, limit).
INLINE uint trace_any_group(Geometry g, const RayGroup *group, uint live) {
    GroupSetup setup;
    uint left = set_up_group(group, live, &setup), blocked = 0u;
    Float limit = LANES_OF(group->limit);
    // Hits at the limit itself do not count.
    Float below = as_Float(as_UInt(limit) - (UInt)1u), reach = REACH(limit);
    PacketStack stack;
    while (left) {
        Packet p = make_packet(group, &setup, left, 1);
        int together = popcount(p.rays) >= LEAST_PACKET;
        uint current = 0u, rays = together ? p.rays : left;
        left &= ~rays;
        float farthest = greatest_of(rays, reach);
        stack.key[0] = BVH_EMPTY;
        stack.top = 1u;
        while (current != BVH_EMPTY) {
            if (!together || popcount(rays) <= SINGLE_RAYS) {
                blocked |= any_one_by_one(g, current, rays, group, &setup);
            } else if (current & BVH_LEAF) {
                blocked |= any_for_packet(g, current & ~BVH_LEAF, rays, &p, group, below);
            } else {
                push_any_children(g, current, rays, &p, reach, farthest, &stack);
            }
            do { // passing by what only blocked rays had left
                stack.top--;
                current = (uint)stack.key[stack.top];
                rays = stack.rays[stack.top] & ~blocked;
            } while (current != BVH_EMPTY && rays == 0u);
        }
    }
    return blocked;
}

#endif
#endif
