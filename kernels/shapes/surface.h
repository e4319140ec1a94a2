// What a stage needs to know of the surface a path has hit.
#ifndef WAVELOBE_SHAPES_SURFACE_H
#define WAVELOBE_SHAPES_SURFACE_H

#include "core/block.h"
#include "core/rounding.h"
#include "core/rows.h"
#include "shared/bvh.h"
#include "shared/scene.h"
#include "shared/materials.h"
#include "shapes/surface_view.h"
#include "shapes/traced_path.h"
#include "shapes/triangle_uvs.h"
#if HAS_TANGENTS
#include "shapes/triangle_tangents.h"
#endif
#if HAS_ANALYTIC
#include "shapes/analytic_geometry.h"
#endif
#if HAS_INSTANCES
#include "shapes/instance.h"
#endif
#if HAS_SMOOTH_TERMINATOR
#include "shapes/smooth_terminator.h"
#endif

#if HAS_NORMAL_MAPS
// A normal or bump map at one level of a nested material: the normal before and after it, turned to the side that is seen.
typedef struct {
    Vec3 outer, inner;
    Float alpha2; // of the shadowing of its terminator; 0: none
    Int mapped;
} MappedNormal;
#endif

typedef struct {
    Vec3 position;
    Vec3 error;    // absolute bound on its rounding error
    Vec3 normal;   // geometric, unit
    Frame frame;   // shading; on an opaque surface turned to the side the path came from
    Vec3 wi;       // where the path came from, in the frame
#if HAS_COAT_NORMALS
    Frame unmapped; // the frame before it was turned and tilted
#endif
#if HAS_SMOOTH_TERMINATOR
    Rise rise;      // front becomes that of the side the path came from
#endif
    Float u, v;    // texture coordinates
#if HAS_SECOND_UVS
    Float second_u, second_v;
#endif
#if HAS_TANGENTS
    Vec3 dp_du, dp_dv; // change of position with them
#if HAS_VERTEX_TANGENTS
    Vec3 tangent; // of the vertices, otherwise the former
#endif
#endif
#if HAS_VERTEX_COLORS
    Rgb color;
#endif
    UInt shape;
    UInt primitive;
    UInt material; // WAVELOBE_NONE: black
#if HAS_NORMAL_MAPS
    MappedNormal maps[MATERIAL_LEVELS]; // that the material's frame has gone through
#endif
} Surface;

INLINE UInt block_word(UInt slot) { return (slot >> 3) * RECORD_WORDS(TriangleBlock) + (slot & (UInt)7u); }

// The ids of primitives carry a bit for rays where scenes have masks.
#if HAS_MASKS
#define PRIMITIVE_ID(word) ((word) & (UInt)~PRIMITIVE_MASKED)
#else
#define PRIMITIVE_ID(word) (word)
#endif

INLINE UInt primitive_of_slot(SurfaceView s, UInt slot) {
    return PRIMITIVE_ID(gather_uint((global const uint *)s.triangle_blocks + 72u, block_word(slot)));
}

INLINE UInt primitive_of_hit(SurfaceView s, UInt hit) {
#if HAS_ANALYTIC
    Int analytic = (hit & (UInt)HIT_ANALYTIC) != (UInt)0u;
    UInt triangle = primitive_of_slot(s, SELECT(analytic, (UInt)0u, hit));
    return SELECT(analytic, (hit & (UInt)~HIT_ANALYTIC) + (UInt)s.triangle_count, triangle);
#else
    return primitive_of_slot(s, hit);
#endif
}

typedef struct {
    Vec3 a, b, c;
} Corners;

// The first nine words of a row.
INLINE Corners row_corners(const Rows *r) {
    Corners t = {vec3(r->word[0], r->word[1], r->word[2]), vec3(r->word[3], r->word[4], r->word[5]), vec3(r->word[6], r->word[7], r->word[8])};
    return t;
}

INLINE Corners gather_corners(global const float *p, UInt i) {
    Rows r;
    gather_rows(p, i, &r);
    return row_corners(&r);
}

// A triangle that was hit.
typedef struct {
    Corners corners;
    Vec3 normal; // unit
    UInt primitive, shape;
    UInt material; // of the front
} SlotTriangle;

#if HAS_FEW_TRIANGLES
INLINE SlotTriangle triangle_of_slot(SurfaceView s, UInt slot) {
    Rows r;
    gather_rows((global const float *)s.few_slots, slot * ROW_WORDS, &r);
#define SLOT_WORD(name) r.word[WORD_OFFSET(FewSlot, name)]
    SlotTriangle t = {row_corners(&r), vec3(SLOT_WORD(normal.x), SLOT_WORD(normal.y), SLOT_WORD(normal.z)), as_UInt(SLOT_WORD(primitive)),
                      as_UInt(SLOT_WORD(shape)), as_UInt(SLOT_WORD(front_material))};
#undef SLOT_WORD
    return t;
}

INLINE Corners triangle_corners(SurfaceView s, UInt slot) { return triangle_of_slot(s, slot).corners; }
#else
INLINE Vec3 block_vertex(SurfaceView s, UInt word, uint vertex) {
    global const float *row = s.triangle_blocks + vertex * 24u;
    return vec3(gather(row, word), gather(row + 8u, word), gather(row + 16u, word));
}

INLINE Corners triangle_corners(SurfaceView s, UInt slot) {
    UInt word = block_word(slot);
    Corners t = {block_vertex(s, word, 0u), block_vertex(s, word, 1u), block_vertex(s, word, 2u)};
    return t;
}

INLINE SlotTriangle triangle_of_slot(SurfaceView s, UInt slot) {
    SlotTriangle t;
    t.corners = triangle_corners(s, slot);
    t.normal = normalize_any_scale(cross3(sub(t.corners.b, t.corners.a), sub(t.corners.c, t.corners.a)));
    t.primitive = primitive_of_slot(s, slot);
    t.shape = gather_uint(s.primitive_shapes, t.primitive);
    t.material = GATHER_UINT_FIELD(s.shapes, Shape, t.shape, front_material);
    return t;
}
#endif

INLINE Vec3 interpolate(Vec3 a, Vec3 b, Vec3 c, Float wa, Float wb, Float wc) {
    return vec3(madd(a.x, wa, madd(b.x, wb, c.x * wc)), madd(a.y, wa, madd(b.y, wb, c.y * wc)),
                madd(a.z, wa, madd(b.z, wb, c.z * wc)));
}

INLINE Vec3 gather_vec3(global const float *p, UInt i) { return vec3(gather(p, i), gather(p + 1, i), gather(p + 2, i)); }

#if HAS_VERTEX_TANGENTS
#define SURFACE_TANGENT(surface) (surface).tangent

INLINE Int has_tangents(SurfaceView s, UInt shape) {
    return (GATHER_UINT_FIELD(s.shapes, Shape, shape, flags) & (UInt)SHAPE_HAS_TANGENTS) != (UInt)0u;
}
#define NORMAL_WORDS SELECT(has_tangents(s, out->shape), (UInt)18u, (UInt)9u)

// `first` is the offset of the normals of the triangle.
INLINE void load_tangent(SurfaceView s, UInt first, Float wa, Float wb, Float wc, Surface *out) {
    Int there = has_tangents(s, out->shape);
    UInt at = SELECT(there, first + (UInt)9u, (UInt)0u);
    Corners corners = gather_corners(s.normals, at);
    Vec3 t = interpolate(corners.a, corners.b, corners.c, wa, wb, wc);
    out->tangent = select3(there & (length_squared(t) > 0.0f), t, out->dp_du);
}
#else
#define SURFACE_TANGENT(surface) (surface).dp_du
#define NORMAL_WORDS 9u
#endif

INLINE void load_triangle(SurfaceView s, const TracedPath *p, UInt slot, Surface *out) {
    SlotTriangle hit = triangle_of_slot(s, slot);
    Vec3 a = hit.corners.a, b = hit.corners.b, c = hit.corners.c;
    out->primitive = hit.primitive;
    out->shape = hit.shape;
    out->material = hit.material;
    Float wb = p->u, wc = p->v, wa = 1.0f - wb - wc;
    out->position = interpolate(a, b, c, wa, wb, wc);
    out->error = scale(interpolate(absolute(a), absolute(b), absolute(c), fabs(wa), fabs(wb), fabs(wc)), (Float)GAMMA(7));
    out->normal = hit.normal;
    out->frame.n = out->normal;
#if HAS_SMOOTH_TERMINATOR
    out->rise = no_rise();
#endif
#if HAS_SMOOTH_NORMALS || HAS_UVS || HAS_VERTEX_COLORS
    UInt triangle = out->primitive - GATHER_UINT_FIELD(s.shapes, Shape, out->shape, first_primitive);
#endif
#if HAS_SMOOTH_NORMALS
    UInt first_normal = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, first_normal);
    Int smooth = first_normal != (UInt)WAVELOBE_NONE;
    if (any_lane(smooth)) {
        UInt at = SELECT(smooth, first_normal + triangle * NORMAL_WORDS, (UInt)0u);
        Corners n = gather_corners(s.normals, at);
        Vec3 shading = interpolate(n.a, n.b, n.c, wa, wb, wc);
        Float square = length_squared(shading);
        out->frame.n = select3(smooth & (square > 0.0f), scale(shading, 1.0f / sqrt(square)), out->normal);
#if HAS_SMOOTH_TERMINATOR
        add_corner_rise(&out->rise, out->position, a, n.a, SELECT(smooth, wa, ZERO));
        add_corner_rise(&out->rise, out->position, b, n.b, SELECT(smooth, wb, ZERO));
        add_corner_rise(&out->rise, out->position, c, n.c, SELECT(smooth, wc, ZERO));
        out->rise = rise_above(out->rise, out->normal, out->frame.n);
#endif
    }
#endif
#if HAS_VERTEX_COLORS
    UInt first_color = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, first_color);
    Int colored = first_color != (UInt)WAVELOBE_NONE;
    out->color = vec3_all(ONE);
    if (any_lane(colored)) {
        UInt at = SELECT(colored, first_color + triangle * 9u, (UInt)0u);
        Corners of_corners = gather_corners(s.colors, at);
        Rgb color = interpolate(of_corners.a, of_corners.b, of_corners.c, wa, wb, wc);
        out->color = select3(colored, color, out->color);
    }
#endif
    out->u = wb, out->v = wc;
#if HAS_UVS
    UInt first_uv = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, first_uv);
    triangle_uvs(s.uvs, first_uv, triangle, wa, wb, wc, &out->u, &out->v);
#endif
#if HAS_SECOND_UVS
    UInt second = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, first_second_uv);
    second = SELECT(second == (UInt)WAVELOBE_NONE, first_uv, second);
    triangle_uvs(s.uvs, second, triangle, wa, wb, wc, &out->second_u, &out->second_v);
#endif
#if HAS_TANGENTS
    out->dp_du = sub(b, a);
    out->dp_dv = sub(c, a);
#if HAS_UVS
    triangle_tangents(s.uvs, first_uv, triangle, out->normal, &out->dp_du, &out->dp_dv);
#endif
#if HAS_VERTEX_TANGENTS
    load_tangent(s, first_normal + triangle * NORMAL_WORDS, wa, wb, wc, out);
#endif
#endif
}

#if HAS_ANALYTIC
INLINE void load_analytic(SurfaceView s, const TracedPath *p, Int analytic, Surface *out) {
    UInt index = SELECT(analytic, p->hit & (UInt)~HIT_ANALYTIC, (UInt)0u);
    Vec3 origin = p->origin, direction = p->direction;
#if HAS_INSTANCES
    InstanceMap m = instance_map(s.instances, p->instance);
    origin = select3(m.placed, point_to_instance(&m, origin), origin);
    direction = select3(m.placed, vector_to_instance(&m, direction), direction);
#endif
    AnalyticHit h = analytic_hit(s.analytics, index, origin, direction, p->t);
    out->primitive = SELECT(analytic, index + (UInt)s.triangle_count, out->primitive);
    out->shape = gather_uint(s.primitive_shapes, out->primitive);
    out->material = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, front_material);
    out->position = select3(analytic, h.position, out->position);
    out->error = select3(analytic, h.error, out->error);
    out->normal = select3(analytic, h.normal, out->normal);
    out->u = SELECT(analytic, h.u, out->u);
    out->v = SELECT(analytic, h.v, out->v);
#if HAS_SECOND_UVS
    out->second_u = SELECT(analytic, h.u, out->second_u);
    out->second_v = SELECT(analytic, h.v, out->second_v);
#endif
#if HAS_VERTEX_COLORS
    out->color = select3(analytic, vec3_all(ONE), out->color);
#endif
    out->frame.n = select3(analytic, h.normal, out->frame.n);
#if HAS_SMOOTH_TERMINATOR
    out->rise.front = select3(analytic, vec3_all(ZERO), out->rise.front);
    out->rise.behind = select3(analytic, vec3_all(ZERO), out->rise.behind);
#endif
#if HAS_TANGENTS
    out->dp_du = select3(analytic, h.dp_du, out->dp_du);
    out->dp_dv = select3(analytic, h.dp_dv, out->dp_dv);
#if HAS_VERTEX_TANGENTS
    out->tangent = select3(analytic, h.dp_du, out->tangent);
#endif
#endif
}
#endif

#if HAS_INSTANCES
#include "shapes/placed_surface.h"
#endif

// The material of the side that is seen, and the frame turned to that side unless the material keeps it.
INLINE void choose_side(SurfaceView s, const TracedPath *p, Surface *out) {
#if HAS_COAT_NORMALS
    out->unmapped = out->frame;
#endif
    Vec3 back_along = negate(p->direction);
    out->wi = to_local(out->frame, back_along);
    Int behind = out->wi.z < 0.0f;
#if HAS_SMOOTH_TERMINATOR
    out->rise.front = select3(behind, out->rise.behind, out->rise.front);
#endif
#if HAS_UNLIKE_SIDES
    UInt back = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, back_material);
    Int from_back = behind;
#if HAS_CULLED_BACKS
    // Culling is the eye's: what lights the scene finds the surface on both sides, as light samples do.
    Int culled = (GATHER_UINT_FIELD(s.shapes, Shape, out->shape, flags) & (UInt)SHAPE_CULLED_BEHIND) != (UInt)0u;
    from_back = SELECT(culled, (p->pdf < 0.0f) & (dot3(out->normal, p->direction) > 0.0f), behind);
#endif
    out->material = SELECT(from_back, back, out->material);
#endif
#if HAS_TRANSMISSION || HAS_NESTING
    UInt known = SELECT(out->material == (UInt)WAVELOBE_NONE, (UInt)0u, out->material);
    UInt flags = GATHER_UINT_FIELD(s.materials, Material, known, flags);
    Int turned = behind & ((flags & (UInt)MATERIAL_KEEPS_FRAME) == (UInt)0u);
#else
    Int turned = behind;
#endif
    out->frame.n = select3(turned, negate(out->frame.n), out->frame.n);
    out->wi.z = SELECT(turned, -out->wi.z, out->wi.z);
}

// All but the side that is seen: the material is that of the front, and the frame as the surface has it.
INLINE Surface load_geometry(SurfaceView s, const TracedPath *p) {
    Surface out;
#if HAS_ANALYTIC
    Int analytic = (p->hit & (UInt)HIT_ANALYTIC) != (UInt)0u;
    load_triangle(s, p, SELECT(analytic, (UInt)0u, p->hit), &out);
    if (any_lane(analytic)) load_analytic(s, p, analytic, &out);
#else
    load_triangle(s, p, p->hit, &out);
#endif
#if HAS_INSTANCES
    place_surface(s, p->instance, &out);
#endif
#if HAS_TANGENTS
    out.frame = frame_along(out.frame.n, SURFACE_TANGENT(out));
#else
    out.frame = frame_of_normal(out.frame.n);
#endif
    return out;
}

INLINE Surface load_surface(SurfaceView s, const TracedPath *p) {
    Surface out = load_geometry(s, p);
    choose_side(s, p, &out);
    return out;
}

#endif
