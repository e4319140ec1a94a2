// Chooses among the lights that have a place by walking down a tree of bounds (host/tables/light_tree.h), and tells with what
// probability a walk ends at a given light. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting", with eight children a node; walked by one random number, stretched at each node, so that its stratification
// survives.
//
// Of a tree the children of a node are weighed side by side, for one receiver after the other: gathers of all lanes' nodes would
// cost more. Where PLACED_LIGHTS says that a node holds them all, they are weighed one by one, for all receivers side by side.
#ifndef WAVELOBE_LIGHTS_LIGHT_TREE_H
#define WAVELOBE_LIGHTS_LIGHT_TREE_H

#include "lights/receiver.h"
#include "shared/lights.h"

#define MOST_LIGHT_LEVELS 32u // as the host builds them

// Cosines reach this far below the horizon: covers the rounding of a receiver's code (6e-5) and that of bounds, so that a
// light that shines is never without a chance.
#define HORIZON_SLACK 0x1p-13f
// Squares of distances below this one are as good as none, and keep eight importances and their sum finite.
#define LEAST_DISTANCE2 0x1p-100f

#if PLACED_LIGHTS
#define VALUES Float
#define MASK Int
#define FUSED madd
#define NAMED(name) name##_lanes
#else
#define VALUES float8
#define MASK int8
#define FUSED madd8
#define NAMED(name) name##_eight
#endif
#include "lights/light_importance.def"
#undef VALUES
#undef MASK
#undef FUSED
#undef NAMED

#if PLACED_LIGHTS
// ---- a few lights: the children of the only node -----------------------------------------------------------------

INLINE Receiver_lanes receiver_lanes(Receiver r) {
    Receiver_lanes lanes = {
        r.position.x, r.position.y, r.position.z, r.normal.x, r.normal.y, r.normal.z, r.any_side,
#if HAS_GLOSSY_RECEIVERS
        r.axis.x, r.axis.y, r.axis.z, r.peak, r.diffuse,
#endif
    };
    return lanes;
}

// importance[i] of light i for each lane; returns their sum.
INLINE Float few_importances(global const struct LightNode *node, Receiver receiver, Float *importance) {
    Receiver_lanes r = receiver_lanes(receiver);
    Float total = ZERO;
    for (uint i = 0u; i < PLACED_LIGHTS; i++) {
        LightBounds_lanes b = {node->center_x[i], node->center_y[i], node->center_z[i], node->radius[i],
                               node->axis_x[i], node->axis_y[i], node->axis_z[i],
                               node->cos_spread[i], node->sin_spread[i], node->cos_emission[i], node->intensity[i]};
        importance[i] = light_importance_lanes(&b, &r);
        total += importance[i];
    }
    return total;
}

INLINE Float walk_light_tree(global const struct LightNode *tree, Receiver receiver, Float u, Float u_deep, Int wanted, UInt *light) {
    Float importance[PLACED_LIGHTS];
    Float total = few_importances(tree, receiver, importance), target = u * total, sum = ZERO, mine = ZERO;
    Int before = TRUE_MASK; // of the light that is looked for
    *light = (UInt)0u;
    for (uint i = 0u; i < PLACED_LIGHTS; i++) {
        sum += importance[i];
        Int here = before & (target < sum);
        mine = SELECT(here, importance[i], mine);
        *light = SELECT(here, (UInt)(tree->child[i] & ~LIGHT_LEAF), *light);
        before &= !here;
    }
    return SELECT(wanted & (mine > 0.0f), mine / total, ZERO);
}

INLINE Float light_tree_probability(global const struct LightNode *tree, Receiver receiver, UInt leaf, Int wanted) {
    Float importance[PLACED_LIGHTS];
    Float total = few_importances(tree, receiver, importance), mine = ZERO;
    for (uint i = 0u; i < PLACED_LIGHTS; i++) mine = SELECT(leaf == (UInt)i, importance[i], mine);
    return SELECT(wanted & (mine > 0.0f), mine / total, ZERO);
}

#else
// ---- the children of a node ------------------------------------------------------------------------------------

typedef struct {
    LaneFloats x, y, z, nx, ny, nz;
#if HAS_GLOSSY_RECEIVERS
    LaneFloats axis_x, axis_y, axis_z, peak, diffuse;
#endif
    uint any_side; // bits
} Receivers;

INLINE Receivers receivers_of(Receiver r) {
    Receivers lanes = {
        lane_floats(r.position.x), lane_floats(r.position.y), lane_floats(r.position.z),
        lane_floats(r.normal.x), lane_floats(r.normal.y), lane_floats(r.normal.z),
#if HAS_GLOSSY_RECEIVERS
        lane_floats(r.axis.x), lane_floats(r.axis.y), lane_floats(r.axis.z), lane_floats(r.peak), lane_floats(r.diffuse),
#endif
        lane_bits(r.any_side)};
    return lanes;
}

#define child_row(name) (*(global const float8 *)node->name)

// For each child; of receiver i.
INLINE float8 light_importances(global const struct LightNode *node, const Receivers *lanes, uint i) {
    Receiver_eight r = {
        lanes->x.value[i], lanes->y.value[i], lanes->z.value[i], lanes->nx.value[i], lanes->ny.value[i], lanes->nz.value[i],
        (int8)(-(int)(lanes->any_side >> i & 1u)),
#if HAS_GLOSSY_RECEIVERS
        lanes->axis_x.value[i], lanes->axis_y.value[i], lanes->axis_z.value[i], lanes->peak.value[i], lanes->diffuse.value[i],
#endif
    };
    LightBounds_eight b = {child_row(center_x), child_row(center_y), child_row(center_z), child_row(radius),
                           child_row(axis_x), child_row(axis_y), child_row(axis_z),
                           child_row(cos_spread), child_row(sin_spread), child_row(cos_emission), child_row(intensity)};
    return light_importance_eight(&b, &r);
}

// Sums of the first one, two, ... values.
INLINE float8 running_sums(float8 v) {
    v += (float8)(0.0f, v.s0, v.s1, v.s2, v.s3, v.s4, v.s5, v.s6);
    v += (float8)(0.0f, 0.0f, v.s0, v.s1, v.s2, v.s3, v.s4, v.s5);
    return v + (float8)(0.0f, 0.0f, 0.0f, 0.0f, v.s0, v.s1, v.s2, v.s3);
}

typedef struct {
    float value[LIGHT_CHILDREN] __attribute__((aligned(32)));
} ChildFloats;

INLINE ChildFloats child_floats(float8 v) {
    ChildFloats a;
    *(float8 *)a.value = v;
    return a;
}

// ---- walks -----------------------------------------------------------------------------------------------------
// All lanes take a step before any takes the next: what a step has asked for comes while the others take theirs.

#define CACHE_LINE 64u

INLINE void fetch_light_node(global const struct LightNode *node) {
    for (uint byte = 0u; byte < sizeof(struct LightNode); byte += CACHE_LINE) fetch_line((ulong)node + byte);
}

typedef struct {
    Receivers receivers;
    LaneFloats u, u_deep, probability;
    LaneUints child; // where the walk stands: a node, or LIGHT_LEAF | light
} LightWalks;

// A number of 24 bits is used up on the way to one of many lights: below this probability a second one takes over.
#define LEAST_SHALLOW 0x1p-12f

// One lane's step down. 1 if the walk goes on, 0 if it is at a light, or where none shines: then its probability is zero.
INLINE uint walk_down(global const struct LightNode *tree, LightWalks *w, uint i) {
    global const struct LightNode *node = tree + w->child.value[i];
    float8 importances = light_importances(node, &w->receivers, i), sums = running_sums(importances);
    ChildFloats importance = child_floats(importances), sum = child_floats(sums);
    float total = sums.s7, u = w->u.value[i], target = u * total;
    uint chosen = popcount(lane_bits8(sums <= target));
    chosen = chosen < LIGHT_CHILDREN ? chosen : LIGHT_CHILDREN - 1u; // u * total may round up to it
    float mine = importance.value[chosen], below = chosen ? sum.value[chosen - 1u] : 0.0f;
    uint shines = mine > 0.0f;
    float before = w->probability.value[i], after = shines ? before * (mine / total) : 0.0f;
    float rest = LESSER(GREATER((target - below) / mine, 0.0f), BELOW_ONE);
    w->u.value[i] = ((before >= LEAST_SHALLOW) & (after < LEAST_SHALLOW)) ? w->u_deep.value[i] : rest;
    w->probability.value[i] = after;
    uint child = node->child[chosen];
    w->child.value[i] = child;
    uint goes_on = shines & !(child & LIGHT_LEAF);
    if (goes_on) fetch_light_node(tree + child);
    return goes_on;
}

// In the wanted lanes the light that `u` leads to, and the probability of getting there: zero where no light shines.
INLINE Float walk_light_tree(global const struct LightNode *tree, Receiver receiver, Float u, Float u_deep, Int wanted, UInt *light) {
    LightWalks w = {receivers_of(receiver), lane_floats(u), lane_floats(u_deep), lane_floats(ONE), lane_uints((UInt)0u)};
    uint walking = lane_bits(wanted);
    while (walking) {
        uint left = walking;
        do {
            POP_LOWEST_BIT(left, i);
            walking ^= (walk_down(tree, &w, i) ^ 1u) << i;
        } while (left);
    }
    Float probability = SELECT(wanted, LANES_OF(w.probability), ZERO);
    *light = SELECT(probability > 0.0f, UINTS_OF(w.child) & (UInt)~LIGHT_LEAF, (UInt)0u);
    return probability;
}

// Probability that the importances of a node choose this child for receiver i.
INLINE float child_probability(global const struct LightNode *node, const Receivers *receivers, uint i, uint child) {
    float8 importances = light_importances(node, receivers, i);
    ChildFloats importance = child_floats(importances);
    float mine = importance.value[child];
    return mine > 0.0f ? mine / running_sums(importances).s7 : 0.0f;
}

// Probability that a walk ends at the lane's leaf. Found on the way up; multiplied in the order of the way down.
INLINE Float light_tree_probability(global const struct LightNode *tree, Receiver receiver, UInt leaf, Int wanted) {
    Receivers receivers = receivers_of(receiver);
    LaneUints place = lane_uints(leaf);
    LaneFloats steps[MOST_LIGHT_LEVELS];
    uint level = 0u, climbing = lane_bits(wanted);
    for (; climbing; level++) {
        steps[level] = lane_floats(ONE);
        uint left = climbing;
        do {
            POP_LOWEST_BIT(left, i);
            global const struct LightNode *node = tree + place.value[i] / LIGHT_CHILDREN;
            steps[level].value[i] = child_probability(node, &receivers, i, place.value[i] % LIGHT_CHILDREN);
            uint up = place.value[i] = node->place;
            if (up != LIGHT_ROOT) fetch_light_node(tree + up / LIGHT_CHILDREN);
            climbing ^= (uint)(up == LIGHT_ROOT) << i;
        } while (left);
    }
    Float probability = ONE;
    while (level) probability *= LANES_OF(steps[--level]);
    return SELECT(wanted, probability, ZERO);
}

#endif

#endif
