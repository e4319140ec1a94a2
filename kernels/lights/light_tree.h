// Chooses among the lights that have a place by walking down a tree of bounds (host/tables/light_tree.h), and tells with what
// probability a walk ends at a given light. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting", with eight children a node, all of them weighed at once; walked by one random number, stretched at each
// node, so that its stratification survives. Receivers go one by one: gathers of all lanes' nodes would cost more.
#ifndef WAVELOBE_LIGHTS_LIGHT_TREE_H
#define WAVELOBE_LIGHTS_LIGHT_TREE_H

#include "lights/receiver.h"
#include "shared/lights.h"

#define MOST_LIGHT_LEVELS 32u // as the host builds them

// ---- importance of a node's children -------------------------------------------------------------------------

// Cosines reach this far below the horizon: covers the rounding of a receiver's code (6e-5) and that of bounds, so that a
// light that shines is never without a chance.
#define HORIZON_SLACK 0x1p-13f
// Squares of distances below this one are as good as none, and keep eight importances and their sum finite.
#define LEAST_DISTANCE2 0x1p-100f

#define child_row(node, name) (*(global const float8 *)(node)->name)

#if HAS_GLOSSY_RECEIVERS
// The lobe towards the nearest direction of each sphere; `along` is how far its centre lies along the axis.
INLINE float8 lobe_towards(float peak, float8 along, float8 d2, float8 radius, float8 distance2, float8 distance, float8 inverse) {
    float8 aside = sqrt(GREATER(d2 - along * along, (float8)0.0f)), touching = sqrt(distance2 - radius * radius);
    // Cosine and sine of the difference of two angles.
    float8 scale = distance * inverse;
    float8 cosine = LESSER(madd8(along, touching, aside * radius) * scale, distance);
    float8 sine = (aside * touching - along * radius) * scale;
    int8 meets = (along >= touching) | (touching <= 0.0f); // or the receiver is in the sphere
    return lobe_profile8(peak, SELECT(meets, (float8)0.0f, sine), distance + SELECT(meets, distance, cosine) + HORIZON_SLACK * distance);
}
#endif

// For each child a bound on the irradiance from its lights, none of them nearer than its sphere is wide; of a glossy receiver on
// what its lobe reflects of it. Cosines are bounded as lengths over the distance: nothing in the sphere lies higher above a
// plane than its centre does by more than its radius. (Too loose a bound for the axes of narrow lobes.)
INLINE float8 light_importances(global const struct LightNode *node, const LaneReceiver *r) {
    float8 x = child_row(node, center_x) - r->x, y = child_row(node, center_y) - r->y, z = child_row(node, center_z) - r->z;
    float8 radius = child_row(node, radius);
    float8 d2 = madd8(x, x, madd8(y, y, z * z));
    float8 distance2 = GREATER(GREATER(d2, radius * radius), (float8)LEAST_DISTANCE2);
    float8 distance = sqrt(distance2), inverse = 1.0f / distance2, slack = HORIZON_SLACK * distance;

    float8 along = -madd8(child_row(node, axis_x), x, madd8(child_row(node, axis_y), y, child_row(node, axis_z) * z));
    float8 aside = sqrt(GREATER(d2 - along * along, (float8)0.0f));
    float8 cos_spread = child_row(node, cos_spread), cos_emission = child_row(node, cos_emission);
    float8 turned = madd8(along, cos_spread, aside * child_row(node, sin_spread));
    float8 emitted = SELECT(along >= cos_spread * distance, distance, turned) + radius + slack;
    // The places of the sphere are as near as the distance less the radius, or as far as with it.
    int8 shines = madd8(fabs(cos_emission), radius, emitted) > cos_emission * distance;
    emitted = GREATER(LESSER(emitted, distance), slack);

    float8 height = madd8((float8)r->nx, x, madd8((float8)r->ny, y, r->nz * z));
    float8 received = GREATER(LESSER(height + radius + slack, distance), (float8)0.0f);
#if HAS_GLOSSY_RECEIVERS
    float8 mirrored = madd8((float8)r->axis_x, x, madd8((float8)r->axis_y, y, r->axis_z * z));
    float8 lobe = lobe_towards(r->peak, mirrored, d2, radius, distance2, distance, inverse);
    // What reflects into the lobe knows no cosine.
    received = madd8((float8)r->diffuse, received, SELECT(received > 0.0f, lobe * distance, (float8)0.0f));
#endif
    received = r->any_side ? distance : received;
    float8 importance = (child_row(node, intensity) * emitted * inverse) * (received * inverse);
    return SELECT(shines, importance, (float8)0.0f);
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
// All lanes take a step before any takes the next: what a step waits for, the others' steps fill.

typedef struct {
    ReceiverLanes receivers;
    LaneFloats u, u_deep, probability;
    LaneUints child; // where the walk stands: a node, or LIGHT_LEAF | light
} LightWalks;

// One lane's step down. 1 if the walk goes on, 0 if it is at a light, or where none shines: then its probability is zero.
// A number of 24 bits is used up on the way to one of many lights, so `u_deep` takes over below a probability of 2^-12.
INLINE uint walk_down(global const struct LightNode *tree, LightWalks *w, uint i) {
    LaneReceiver r = receiver_of_lane(&w->receivers, i);
    global const struct LightNode *node = tree + w->child.value[i];
    float8 importances = light_importances(node, &r), sums = running_sums(importances);
    ChildFloats importance = child_floats(importances), sum = child_floats(sums);
    float total = sums.s7, u = w->u.value[i], target = u * total;
    uint chosen = popcount(lane_bits8(sums <= target));
    chosen = chosen < LIGHT_CHILDREN ? chosen : LIGHT_CHILDREN - 1u; // u * total may round up to it
    float mine = importance.value[chosen], below = chosen ? sum.value[chosen - 1u] : 0.0f;
    uint shines = mine > 0.0f;
    float before = w->probability.value[i], after = shines ? before * (mine / total) : 0.0f;
    float rest = LESSER(GREATER((target - below) / mine, 0.0f), BELOW_ONE);
    w->u.value[i] = (before >= 0x1p-12f) & (after < 0x1p-12f) ? w->u_deep.value[i] : rest;
    w->probability.value[i] = after;
    uint child = node->child[chosen];
    w->child.value[i] = child;
    return shines & !(child & LIGHT_LEAF);
}

// In the wanted lanes the light that `u` leads to, and the probability of getting there: zero where no light shines.
INLINE Float walk_light_tree(global const struct LightNode *tree, Receiver receiver, Float u, Float u_deep, Int wanted, UInt *light) {
    LightWalks w = {receiver_lanes(receiver), lane_floats(u), lane_floats(u_deep), lane_floats(ONE), lane_uints((UInt)0u)};
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

// Probability that the importances of a node choose this child.
INLINE float child_probability(global const struct LightNode *node, const LaneReceiver *r, uint child) {
    float8 importances = light_importances(node, r);
    ChildFloats importance = child_floats(importances);
    float mine = importance.value[child];
    return mine > 0.0f ? mine / running_sums(importances).s7 : 0.0f;
}

// Probability that a walk ends at the lane's leaf. Found on the way up; multiplied in the order of the way down.
INLINE Float light_tree_probability(global const struct LightNode *tree, Receiver receiver, UInt leaf, Int wanted) {
    ReceiverLanes receivers = receiver_lanes(receiver);
    LaneUints place = lane_uints(leaf);
    LaneFloats steps[MOST_LIGHT_LEVELS];
    uint level = 0u, climbing = lane_bits(wanted);
    for (; climbing; level++) {
        steps[level] = lane_floats(ONE);
        uint left = climbing;
        do {
            POP_LOWEST_BIT(left, i);
            LaneReceiver r = receiver_of_lane(&receivers, i);
            global const struct LightNode *node = tree + place.value[i] / LIGHT_CHILDREN;
            steps[level].value[i] = child_probability(node, &r, place.value[i] % LIGHT_CHILDREN);
            place.value[i] = node->place;
            climbing ^= (uint)(node->place == LIGHT_ROOT) << i;
        } while (left);
    }
    Float probability = ONE;
    while (level) probability *= LANES_OF(steps[--level]);
    return SELECT(wanted, probability, ZERO);
}

#endif
