// LANES rays, and what traversal needs of each, made for all of them at once.
#ifndef WAVELOBE_SHAPES_RAY_GROUP_H
#define WAVELOBE_SHAPES_RAY_GROUP_H

#include "core/vector.h"
#include "shapes/triangle_block.h"

typedef struct {
    LaneFloats ox, oy, oz, dx, dy, dz, limit; // unit directions; what lies at the limit or beyond is not seen
    uint from[LANES] __attribute__((aligned(64)));
#if HAS_MASKS
    uint key[LANES] __attribute__((aligned(64)));
#endif
} RayGroup;

INLINE Ray group_ray(const RayGroup *g, uint i) {
    Ray r = {
        g->ox.value[i], g->oy.value[i], g->oz.value[i], g->dx.value[i], g->dy.value[i], g->dz.value[i], g->limit.value[i], g->from[i],
#if HAS_MASKS
        g->key[i],
#endif
    };
    return r;
}

// Rays that are not numbers, or have no room for a hit, stay out.
INLINE uint sound_rays(const RayGroup *g, uint live) {
    Float sum = ZERO;
    const LaneFloats *parts[6] = {&g->ox, &g->oy, &g->oz, &g->dx, &g->dy, &g->dz};
#pragma unroll
    for (uint i = 0u; i < 6u; i++) sum += LANES_OF(*parts[i]) - LANES_OF(*parts[i]);
    return live & lane_bits((sum == 0.0f) & (LANES_OF(g->limit) > 0.0f));
}

// What box_test and ray_shear make of each ray.
typedef struct {
    LaneFloats reciprocal_x, reciprocal_y, reciprocal_z;
    LaneFloats ox, oy, oz; // axes permuted
    LaneFloats sx, sy, sz;
    uint kx[LANES] __attribute__((aligned(64)));
    uint ky[LANES] __attribute__((aligned(64)));
    uint kz[LANES] __attribute__((aligned(64)));
    KeptMask x_major, y_major;
} GroupSetup;

// Returns which of the `live` rays can hit anything.
INLINE uint set_up_group(const RayGroup *g, uint live, GroupSetup *s) {
    Vec3 o = vec3(LANES_OF(g->ox), LANES_OF(g->oy), LANES_OF(g->oz));
    Vec3 d = vec3(LANES_OF(g->dx), LANES_OF(g->dy), LANES_OF(g->dz));
    *(Float *)s->reciprocal_x.value = reciprocal_lanes(d.x);
    *(Float *)s->reciprocal_y.value = reciprocal_lanes(d.y);
    *(Float *)s->reciprocal_z.value = reciprocal_lanes(d.z);
    Vec3 size = absolute(d);
    Int x = (size.x > size.y) & (size.x > size.z), y = !x & (size.y > size.z);
#define LANES_BY_AXIS(if_x, if_y, if_z) SELECT(x, if_x, SELECT(y, if_y, if_z))
    *(Float *)s->ox.value = LANES_BY_AXIS(o.y, o.z, o.x);
    *(Float *)s->oy.value = LANES_BY_AXIS(o.z, o.x, o.y);
    *(Float *)s->oz.value = LANES_BY_AXIS(o.x, o.y, o.z);
    Float inverse = 1.0f / LANES_BY_AXIS(d.x, d.y, d.z);
    *(Float *)s->sx.value = LANES_BY_AXIS(d.y, d.z, d.x) * inverse;
    *(Float *)s->sy.value = LANES_BY_AXIS(d.z, d.x, d.y) * inverse;
    *(Float *)s->sz.value = inverse;
    *(UInt *)s->kx = LANES_BY_AXIS((UInt)(1u * BLOCK_ROW_BYTES), (UInt)(2u * BLOCK_ROW_BYTES), (UInt)0u);
    *(UInt *)s->ky = LANES_BY_AXIS((UInt)(2u * BLOCK_ROW_BYTES), (UInt)0u, (UInt)(1u * BLOCK_ROW_BYTES));
    *(UInt *)s->kz = LANES_BY_AXIS((UInt)0u, (UInt)(1u * BLOCK_ROW_BYTES), (UInt)(2u * BLOCK_ROW_BYTES));
#undef LANES_BY_AXIS
    s->x_major = keep_mask(x);
    s->y_major = keep_mask(y);
    return sound_rays(g, live);
}

INLINE BoxTest group_box_test(const RayGroup *g, const GroupSetup *s, uint i) {
    return box_test_of(g->ox.value[i], g->oy.value[i], g->oz.value[i], s->reciprocal_x.value[i], s->reciprocal_y.value[i],
                       s->reciprocal_z.value[i]);
}

INLINE RayShear group_shear(const GroupSetup *s, uint i) {
    RayShear r = {s->sx.value[i], s->sy.value[i], s->sz.value[i], s->kx[i], s->ky[i], s->kz[i], s->ox.value[i], s->oy.value[i], s->oz.value[i]};
    return r;
}

#endif
