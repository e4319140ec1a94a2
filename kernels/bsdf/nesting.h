// Materials that hold others: normal and bump maps, two sides, blends. A surface goes through them level by level, to the
// material with lobes; on the way its frame is tilted and turned, and of a blend one material is chosen.
#ifndef WAVELOBE_BSDF_NESTING_H
#define WAVELOBE_BSDF_NESTING_H

#include "bsdf/material.h"

#define nesting_word(in, field) \
    gather((global const float *)(in).materials + WORD_OFFSET(Nesting, field), (in).material * RECORD_WORDS(Material))

#if HAS_BLENDS
// The second material with the probability of its weight. The rest of the random number serves the next choice.
INLINE UInt choose_of_blend(MaterialInput in, Int mine, Float *u) {
    Float weight = LESSER(GREATER(load_record_float(in, mine, Nesting, weight), ZERO), ONE);
    Int second = *u < weight;
    // Below 1, which rounding may reach.
    *u = LESSER(SELECT(second, *u / weight, (*u - weight) / (1.0f - weight)), (Float)BELOW_ONE);
    return as_UInt(SELECT(second, nesting_word(in, inner[1]), nesting_word(in, inner[0])));
}
#endif

#if HAS_NESTED_SIDES
// The material of the side that is seen, the frame turned to it.
INLINE UInt choose_of_sides(MaterialInput in, Int mine, Surface *s) {
    Int behind = s->wi.z < 0.0f;
    Int turned = mine & behind;
    s->frame.n = select3(turned, negate(s->frame.n), s->frame.n);
    s->wi.z = SELECT(turned, -s->wi.z, s->wi.z);
    return as_UInt(SELECT(behind, nesting_word(in, inner[1]), nesting_word(in, inner[0])));
}
#endif

#if HAS_NORMAL_MAPS
// The normal of a map in the frame of the tangent along u, of any length.
INLINE Vec3 normal_of_map(MaterialInput in, Int mine) {
    Rgb color = load_record_rgb(in, mine, Nesting, normal);
    Float along = nesting_word(in, scale);
    return vec3(along * madd(color.x, (Float)2.0f, (Float)-1.0f), along * madd(color.y, (Float)2.0f, (Float)-1.0f),
                madd(color.z, (Float)2.0f, (Float)-1.0f));
}

#if HAS_BUMP_MAPS
// Blinn 1978, "Simulation of Wrinkled Surfaces": the normal of the surface raised by heights along its shading normal, on the
// side of the geometric normal; in the given frame, of any length.
INLINE Vec3 normal_of_heights(MaterialInput in, Int mine, const Surface *s, Frame frame) {
    UInt texture = as_UInt(nesting_word(in, height));
    Int textured = mine & (texture != (UInt)WAVELOBE_NONE);
    TextureBuffers b = {in.textures, in.texels};
    Float along_u, along_v;
    texture_gradient(b, SELECT(textured, texture, (UInt)0u), in.u, in.v, &along_u, &along_v);
    Float height = SELECT(textured, nesting_word(in, scale), ZERO);
    Vec3 n = frame.n;
    Vec3 raised_u = scale_add(n, madd(height, along_u, -dot3(n, s->dp_du)), s->dp_du);
    Vec3 raised_v = scale_add(n, madd(height, along_v, -dot3(n, s->dp_dv)), s->dp_dv);
    Vec3 raised = normalize3(cross3(raised_u, raised_v));
    return to_local(frame, scale(raised, SELECT(dot3(s->normal, raised) < 0.0f, (Float)-1.0f, ONE)));
}
#endif

INLINE Frame tilted(Frame outer, Frame inner) {
    Frame f = {to_world(outer, inner.s), to_world(outer, inner.t), to_world(outer, inner.n)};
    return f;
}

// Tilts the frame of `mine` to a normal and a tangent given in it. `frame` is the same without the turns that sides have made.
INLINE void apply_map(Surface *s, Frame *frame, MappedNormal *map, Vec3 n, Vec3 tangent, UInt flags, Int mine) {
    Int flips = ((flags & (UInt)MATERIAL_FLIPS_NORMALS) != (UInt)0u) & (s->wi.z * dot3(s->wi, n) <= 0.0f);
    n.x = SELECT(flips, -n.x, n.x);
    n.y = SELECT(flips, -n.y, n.y);
    Float square = length_squared(n);
    // A normal without a direction changes nothing.
    mine &= (square > 0.0f) & (square < INFINITY);
    n = select3(mine, scale(n, 1.0f / sqrt(square)), vec3(ZERO, ZERO, ONE));
    Float tan2 = GREATER(madd(-n.z, n.z, ONE), ZERO) / (n.z * n.z);
    map->mapped = mine;
    map->alpha2 = SELECT((flags & (UInt)MATERIAL_SHADES_TERMINATOR) != (UInt)0u, LESSER(0.125f * tan2, ONE), ZERO);
    map->outer = s->frame.n;
    Frame tilt = frame_along(n, tangent);
    Frame turned = tilted(s->frame, tilt);
    Frame unturned = tilted(*frame, tilt);
    map->inner = turned.n;
    s->wi = select3(mine, to_local(tilt, s->wi), s->wi);
    s->frame.s = select3(mine, turned.s, s->frame.s);
    s->frame.t = select3(mine, turned.t, s->frame.t);
    s->frame.n = select3(mine, turned.n, s->frame.n);
    frame->s = select3(mine, unturned.s, frame->s);
    frame->t = select3(mine, unturned.t, frame->t);
    frame->n = select3(mine, unturned.n, frame->n);
}

// What maps leave of light along a direction: nothing where one normal sees it and the other does not, and less towards the
// horizon of the surface. Conty Estevez, Lecocq, Stein 2019, "A Microfacet-Based Shadowing Function to Solve the Bump
// Terminator Problem".
INLINE Float mapped_share(const Surface *s, Vec3 direction) {
    Float share = ONE;
    for (uint level = 0u; level < MATERIAL_LEVELS; level++) {
        const MappedNormal *map = &s->maps[level];
        if (!any_lane(map->mapped)) continue;
        Float outer = dot3(map->outer, direction);
        Float tan2 = GREATER(madd(-outer, outer, ONE), ZERO) / (outer * outer);
        Float shadowed = SELECT(map->alpha2 > 0.0f, 2.0f / (1.0f + sqrt(madd(map->alpha2, tan2, ONE))), ONE);
        Float here = SELECT(outer * dot3(map->inner, direction) > 0.0f, shadowed, ZERO);
        share = SELECT(map->mapped, share * here, share);
    }
    return share;
}
#endif

// The surface with the material of the last level, which nests no more.
INLINE void enter_nested_materials(Surface *s, global const struct Material *materials, global const struct Texture *textures,
                                   global const float *texels, Float u) {
#if HAS_NORMAL_MAPS
    Frame frame = s->frame;
#endif
    for (uint level = 0u; level < MATERIAL_LEVELS; level++) {
        MaterialInput in = material_input(s, materials, textures, texels);
        UInt flags = load_flags(in);
        Int there = s->material != (UInt)WAVELOBE_NONE;
        UInt next = as_UInt(nesting_word(in, inner[0]));
#define IS_KIND(kinds) (there & ((flags & (UInt)(kinds)) != (UInt)0u))
#if HAS_BLENDS
        Int blend = IS_KIND(MATERIAL_BLEND);
        if (any_lane(blend)) {
            Float rest = u;
            next = SELECT(blend, choose_of_blend(in, blend, &rest), next);
            u = SELECT(blend, rest, u);
        }
#endif
#if HAS_NESTED_SIDES
        Int sides = IS_KIND(MATERIAL_SIDES);
        if (any_lane(sides)) next = SELECT(sides, choose_of_sides(in, sides, s), next);
#endif
#if HAS_NORMAL_MAPS
        Int mapped = IS_KIND(MATERIAL_NORMAL_MAP | MATERIAL_BUMP_MAP);
        s->maps[level].mapped = mapped;
        if (any_lane(mapped)) {
            Vec3 n = normal_of_map(in, mapped), tangent = vec3(ONE, ZERO, ZERO);
#if HAS_BUMP_MAPS
            Int bump = IS_KIND(MATERIAL_BUMP_MAP);
            if (any_lane(bump)) {
                n = select3(bump, normal_of_heights(in, bump, s, frame), n);
                // Mitsuba 3 takes the world's coordinates of the tangent for the frame's, and so do its scenes' highlights.
                tangent = select3(bump, s->dp_du, tangent);
            }
#endif
            apply_map(s, &frame, &s->maps[level], n, tangent, flags, mapped);
        }
#endif
        s->material = SELECT(IS_KIND(MATERIAL_NESTS), next, s->material);
#undef IS_KIND
    }
}

#endif
