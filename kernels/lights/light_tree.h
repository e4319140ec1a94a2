// Chooses among the lights that have a place by walking down a tree of bounds (host/tables/light_tree.h), and tells with what
// probability a walk ends at a given light. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting"; walked by one random number, halved and stretched at each node, so that its stratification survives.
#ifndef WAVELOBE_LIGHTS_LIGHT_TREE_H
#define WAVELOBE_LIGHTS_LIGHT_TREE_H

#include "lights/receiver.h"
#include "shared/lights.h"

// ---- importance of a node ------------------------------------------------------------------------------------

// Cosines reach this far below the horizon: covers the rounding of a receiver's code (6e-5) and that of bounds, so that a
// light that shines is never without a chance.
#define HORIZON_SLACK 0x1p-13f

// Cosine of the angle a - b, or one where b is the larger.
INLINE Float cosine_beyond(Float sin_a, Float cos_a, Float sin_b, Float cos_b) {
    return SELECT(cos_a > cos_b, ONE, madd(cos_a, cos_b, sin_a * sin_b));
}

INLINE Float sine_of(Float cosine) { return sqrt(GREATER((1.0f - cosine) * (1.0f + cosine), ZERO)); }

#define light_node_field(tree, node, name) GATHER_FIELD(tree, LightNode, node, name)
#define light_node_vector(tree, node, name)                                                                   \
    vec3(gather((global const float *)(tree) + WORD_OFFSET(LightNode, name), (node) * RECORD_WORDS(LightNode)),      \
         gather((global const float *)(tree) + WORD_OFFSET(LightNode, name) + 1u, (node) * RECORD_WORDS(LightNode)), \
         gather((global const float *)(tree) + WORD_OFFSET(LightNode, name) + 2u, (node) * RECORD_WORDS(LightNode)))

// Bound on the irradiance from a node's lights, none of them nearer than its sphere is wide; of a glossy receiver on what its lobe
// reflects of it.
INLINE Float light_node_importance(global const struct LightNode *tree, UInt node, Receiver r) {
    Vec3 way = sub(light_node_vector(tree, node, center), r.position);
    Float radius = light_node_field(tree, node, radius);
    Float d2 = length_squared(way), r2 = radius * radius;
    Vec3 direction = scale(way, 1.0f / sqrt(GREATER(d2, (Float)FLOAT_MIN_NORMAL)));
    Int outside = d2 > r2;
    // Half the angle under which the sphere of bounds is seen.
    Float sin2_bound = SELECT(outside, r2 / GREATER(d2, (Float)FLOAT_MIN_NORMAL), ONE);
    Float sin_bound = sqrt(sin2_bound), cos_bound = sqrt(1.0f - sin2_bound);

    Float cos_axis = -dot3(light_node_vector(tree, node, axis), direction);
    Float cos_spread = light_node_field(tree, node, cos_spread), sin_spread = light_node_field(tree, node, sin_spread);
    Float cos_normal = cosine_beyond(sine_of(cos_axis), cos_axis, sin_spread, cos_spread);
    Float cos_emitted = cosine_beyond(sine_of(cos_normal), cos_normal, sin_bound, cos_bound);
    cos_emitted = SELECT(outside, cos_emitted, ONE);
    Int shines = cos_emitted + HORIZON_SLACK > light_node_field(tree, node, cos_emission);

    Float cos_up = dot3(r.normal, direction);
    Float cos_received = SELECT(outside, cosine_beyond(sine_of(cos_up), cos_up, sin_bound, cos_bound), ONE);
    cos_received = GREATER(cos_received + HORIZON_SLACK, ZERO);
    Float received = cos_received;
#if HAS_GLOSSY_RECEIVERS
    Float cos_lobe = dot3(r.axis, direction);
    cos_lobe = SELECT(outside, cosine_beyond(sine_of(cos_lobe), cos_lobe, sin_bound, cos_bound), ONE);
    // What reflects into the lobe knows no cosine.
    received = madd(r.diffuse, cos_received, SELECT(cos_received > 0.0f, lobe_profile(r.peak, cos_lobe), ZERO));
#endif
    received = SELECT(r.any_side, ONE, received);
    Float emitted = GREATER(cos_emitted + HORIZON_SLACK, (Float)HORIZON_SLACK);
    Float distance2 = GREATER(GREATER(d2, r2), (Float)FLOAT_MIN_NORMAL);
    Float importance = light_node_field(tree, node, intensity) * emitted * received / distance2;
    return SELECT(shines, importance, ZERO);
}

// Probability of going to the first of two neighbouring nodes; *alive ends where neither can shine.
INLINE Float first_child_probability(global const struct LightNode *tree, UInt first, Receiver r, Int *alive) {
    Float a = light_node_importance(tree, first, r), b = light_node_importance(tree, first + 1u, r);
    // Sums of the largest floats would overflow.
    Float most = GREATER(a, b);
    *alive &= (most > 0.0f) & (most < INFINITY);
    a = a / most;
    b = b / most;
    return SELECT(*alive, a / (a + b), ONE);
}

// ---- walks -----------------------------------------------------------------------------------------------------

// The light that `u` leads to, and the probability of getting there: zero where no light shines. A number of 24 bits is used
// up on the way to one of many lights, so `u_deep` takes over below a probability of 2^-12.
INLINE Float walk_light_tree(global const struct LightNode *tree, Receiver r, Float u, Float u_deep, UInt *light) {
    UInt node = (UInt)0u, child;
    Float probability = ONE;
    Int alive = TRUE_MASK, shallow = TRUE_MASK;
    for (;;) {
        child = GATHER_UINT_FIELD(tree, LightNode, node, child);
        Int inner = alive & ((child & (UInt)LIGHT_LEAF) == (UInt)0u);
        if (!any_lane(inner)) break;
        UInt first = SELECT(inner, child, (UInt)1u);
        Int shining = inner;
        Float p = first_child_probability(tree, first, r, &shining);
        alive &= shining | !inner;
        UInt second = (UInt)1u - (as_UInt(u - p) >> 31); // by the sign: see scripts/memcheck
        Int to_second = second != (UInt)0u;
        Float share = SELECT(to_second, 1.0f - p, p);
        Float rest = SELECT(to_second, u - p, u) / share;
        probability = SELECT(inner, probability * share, probability);
        Int switched = shallow & (probability < 0x1p-12f);
        u = SELECT(inner, LESSER(SELECT(switched, u_deep, rest), (Float)BELOW_ONE), u);
        shallow &= !switched;
        node = SELECT(inner, first + second, node);
    }
    *light = SELECT(alive, child & (UInt)~LIGHT_LEAF, (UInt)0u);
    return SELECT(alive, probability, ZERO);
}

// Probability that a walk ends at the light with this trail.
INLINE Float light_tree_probability(global const struct LightNode *tree, Receiver r, UInt trail, Int wanted) {
    UInt node = (UInt)0u;
    Float probability = ONE;
    Int alive = wanted;
    for (;;) {
        UInt child = GATHER_UINT_FIELD(tree, LightNode, node, child);
        Int inner = alive & ((child & (UInt)LIGHT_LEAF) == (UInt)0u);
        if (!any_lane(inner)) break;
        UInt first = SELECT(inner, child, (UInt)1u);
        Int shining = inner;
        Float p = first_child_probability(tree, first, r, &shining);
        alive &= shining | !inner;
        UInt second = trail & (UInt)1u;
        Int to_first = second == (UInt)0u;
        probability = SELECT(inner, probability * SELECT(to_first, p, 1.0f - p), probability);
        node = SELECT(inner, first + second, node);
        trail = SELECT(inner, trail >> 1, trail);
    }
    return SELECT(alive, probability, ZERO);
}

#endif
