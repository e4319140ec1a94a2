// What a stage needs to know of the surface a path has hit.
#ifndef WAVELOBE_SHAPES_SURFACE_H
#define WAVELOBE_SHAPES_SURFACE_H

#include "core/block.h"
#include "core/rounding.h"
#include "shared/bvh.h"
#include "shared/scene.h"
#include "shared/materials.h"
#include "shapes/triangle_uvs.h"
#if HAS_ANALYTIC
#include "shapes/analytic_geometry.h"
#endif

// The buffers that describe surfaces. Kernels take SURFACE_PARAMETERS and write SURFACE_VIEW.
typedef struct {
    global const float *triangle_blocks;  // TriangleBlock
    global const uint *primitive_shapes;  // shape of each triangle, then of each analytic shape
    global const struct Shape *shapes;
    global const struct Material *materials;
#if HAS_SMOOTH_NORMALS
    global const float *normals; // 9 a triangle
#endif
#if HAS_UVS
    global const float *uvs; // 6 a triangle
#endif
#if HAS_ANALYTIC
    global const struct Analytic *analytics;
    uint triangle_count;
#endif
} SurfaceView;

#if HAS_SMOOTH_NORMALS
#define NORMALS_PARAMETER , global const float *normals
#define NORMALS_ARGUMENT , normals
#else
#define NORMALS_PARAMETER
#define NORMALS_ARGUMENT
#endif
#if HAS_UVS
#define UVS_PARAMETER , global const float *uvs
#define UVS_ARGUMENT , uvs
#else
#define UVS_PARAMETER
#define UVS_ARGUMENT
#endif
#if HAS_ANALYTIC
#define ANALYTIC_PARAMETER , global const struct Analytic *analytics
#define ANALYTIC_ARGUMENT , analytics, parameters->triangle_count
#else
#define ANALYTIC_PARAMETER
#define ANALYTIC_ARGUMENT
#endif

#define SURFACE_PARAMETERS                                                                                  \
    global const struct RenderParameters *parameters, global const float *triangle_blocks,                  \
        global const uint *primitive_shapes, global const struct Shape *shapes,                             \
        global const struct Material *materials NORMALS_PARAMETER UVS_PARAMETER ANALYTIC_PARAMETER
#define SURFACE_VIEW \
    {triangle_blocks, primitive_shapes, shapes, materials NORMALS_ARGUMENT UVS_ARGUMENT ANALYTIC_ARGUMENT}

// A traced path as its queue holds it.
typedef struct {
    Float t, u, v;
    UInt hit, id, depth;
    Vec3 direction;
    Rgb throughput;
    Float pdf;
#if HAS_ANALYTIC
    Vec3 origin;
#endif
#if HAS_TRANSMISSION
    Float eta;
#endif
#if HAS_LIGHT_TREE
    UInt receiver;
#endif
    Int live; // lanes that hold a path
} TracedPath;

typedef struct {
    Vec3 position;
    Vec3 error;    // absolute bound on its rounding error
    Vec3 normal;   // geometric, unit
    Frame frame;   // shading; on an opaque surface turned to the side the path came from
    Vec3 wi;       // where the path came from, in the frame
    Float u, v;    // texture coordinates
    UInt shape;
    UInt primitive;
    UInt material; // WAVELOBE_NONE: black
} Surface;

// Slots of a group beyond the queue's end are read as hits of triangle 0 with no weight.
INLINE TracedPath read_traced_path(Queue q, uint i) {
    TracedPath p;
    p.live = lanes_below(i, *q.count);
    p.t = read_field(q, PATH_T, i);
    p.hit = SELECT(p.live, read_uint(q, PATH_HIT, i), (UInt)0u);
    p.u = read_field(q, PATH_U, i);
    p.v = read_field(q, PATH_V, i);
    p.direction = read_vec3(q, PATH_DIRECTION, i);
    p.throughput = read_vec3(q, PATH_THROUGHPUT, i);
    p.pdf = read_field(q, PATH_PDF, i);
    p.id = SELECT(p.live, read_uint(q, PATH_ID, i), (UInt)0u);
    p.depth = read_uint(q, PATH_DEPTH, i);
#if HAS_ANALYTIC
    p.origin = read_vec3(q, PATH_ORIGIN, i);
#endif
#if HAS_TRANSMISSION
    p.eta = read_field(q, PATH_ETA, i);
#endif
#if HAS_LIGHT_TREE
    p.receiver = read_uint(q, PATH_RECEIVER, i);
#endif
    return p;
}

// Unit vector, also of vectors so short that their squares underflow.
INLINE Vec3 normalize_any_scale(Vec3 a) {
    Vec3 m = absolute(a);
    Float most = max_component(m);
    return normalize3(scale(a, 1.0f / most));
}

INLINE UInt block_word(UInt slot) { return (slot >> 3) * RECORD_WORDS(TriangleBlock) + (slot & (UInt)7u); }

// The ids of primitives carry a bit for rays where scenes have masks.
#if HAS_MASKS
#define PRIMITIVE_ID(word) ((word) & (UInt)~PRIMITIVE_MASKED)
#else
#define PRIMITIVE_ID(word) (word)
#endif

INLINE UInt primitive_of_hit(SurfaceView s, UInt hit) {
#if HAS_ANALYTIC
    Int analytic = (hit & (UInt)HIT_ANALYTIC) != (UInt)0u;
    UInt slot = SELECT(analytic, (UInt)0u, hit);
    UInt triangle = PRIMITIVE_ID(gather_uint((global const uint *)s.triangle_blocks + 72u, block_word(slot)));
    return SELECT(analytic, (hit & (UInt)~HIT_ANALYTIC) + (UInt)s.triangle_count, triangle);
#else
    return PRIMITIVE_ID(gather_uint((global const uint *)s.triangle_blocks + 72u, block_word(hit)));
#endif
}

INLINE Vec3 block_vertex(SurfaceView s, UInt word, uint vertex) {
    global const float *row = s.triangle_blocks + vertex * 24u;
    return vec3(gather(row, word), gather(row + 8u, word), gather(row + 16u, word));
}

INLINE Vec3 interpolate(Vec3 a, Vec3 b, Vec3 c, Float wa, Float wb, Float wc) {
    return vec3(madd(a.x, wa, madd(b.x, wb, c.x * wc)), madd(a.y, wa, madd(b.y, wb, c.y * wc)),
                madd(a.z, wa, madd(b.z, wb, c.z * wc)));
}

INLINE Vec3 gather_vec3(global const float *p, UInt i) { return vec3(gather(p, i), gather(p + 1, i), gather(p + 2, i)); }

#if HAS_UVS
// The tangent along u of a triangle with texture coordinates.
INLINE Vec3 triangle_tangent(SurfaceView s, UInt first_uv, UInt triangle, Vec3 e1, Vec3 e2, Vec3 fallback) {
    Int textured = first_uv != (UInt)WAVELOBE_NONE;
    UInt at = SELECT(textured, first_uv + triangle * 6u, (UInt)0u);
    Float u0 = gather(s.uvs, at), v0 = gather(s.uvs + 1, at);
    Float du1 = gather(s.uvs + 2, at) - u0, dv1 = gather(s.uvs + 3, at) - v0;
    Float du2 = gather(s.uvs + 4, at) - u0, dv2 = gather(s.uvs + 5, at) - v0;
    Float det = difference_of_products(du1, dv2, dv1, du2);
    Vec3 tangent = scale(sub(scale(e1, dv2), scale(e2, dv1)), 1.0f / det);
    return select3(textured & (det != 0.0f), tangent, fallback);
}
#endif

// Turns the frame's tangent to `along` as far as the normal allows.
INLINE Frame frame_along(Vec3 n, Vec3 along) {
    Vec3 s = scale_add(n, -dot3(n, along), along);
    Float square = length_squared(s);
    Frame fallback = frame_of_normal(n);
    Frame f;
    f.n = n;
    f.s = select3(square > 0.0f, scale(s, 1.0f / sqrt(square)), fallback.s);
    f.t = cross3(n, f.s);
    return f;
}

INLINE void load_triangle(SurfaceView s, const TracedPath *p, UInt slot, UInt first_primitive, Surface *out) {
    UInt word = block_word(slot);
    Vec3 a = block_vertex(s, word, 0u), b = block_vertex(s, word, 1u), c = block_vertex(s, word, 2u);
    Float wb = p->u, wc = p->v, wa = 1.0f - wb - wc;
    out->position = interpolate(a, b, c, wa, wb, wc);
    out->error = scale(interpolate(absolute(a), absolute(b), absolute(c), fabs(wa), fabs(wb), fabs(wc)), (Float)GAMMA(7));
    Vec3 e1 = sub(b, a), e2 = sub(c, a);
    out->normal = normalize_any_scale(cross3(e1, e2));
    Vec3 n = out->normal;
#if HAS_SMOOTH_NORMALS || HAS_UVS
    UInt triangle = out->primitive - first_primitive;
#endif
#if HAS_SMOOTH_NORMALS
    UInt first_normal = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, first_normal);
    Int smooth = first_normal != (UInt)WAVELOBE_NONE;
    if (any_lane(smooth)) {
        UInt at = SELECT(smooth, first_normal + triangle * 9u, (UInt)0u);
        Vec3 shading = interpolate(gather_vec3(s.normals, at), gather_vec3(s.normals + 3, at),
                                   gather_vec3(s.normals + 6, at), wa, wb, wc);
        Float square = length_squared(shading);
        n = select3(smooth & (square > 0.0f), scale(shading, 1.0f / sqrt(square)), n);
    }
#endif
    out->u = wb;
    out->v = wc;
#if HAS_UVS
    UInt first_uv = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, first_uv);
    triangle_uvs(s.uvs, first_uv, triangle, wa, wb, wc, &out->u, &out->v);
#endif
#if HAS_ANISOTROPY && HAS_UVS
    out->frame = frame_along(n, triangle_tangent(s, first_uv, triangle, e1, e2, frame_of_normal(n).s));
#else
    out->frame = frame_of_normal(n);
#endif
}

#if HAS_ANALYTIC
INLINE void load_analytic(SurfaceView s, const TracedPath *p, Int analytic, Surface *out) {
    UInt index = SELECT(analytic, p->hit & (UInt)~HIT_ANALYTIC, (UInt)0u);
    AnalyticHit h = analytic_hit(s.analytics, index, p->origin, p->direction, p->t);
    out->position = select3(analytic, h.position, out->position);
    out->error = select3(analytic, h.error, out->error);
    out->normal = select3(analytic, h.normal, out->normal);
    out->u = SELECT(analytic, h.u, out->u);
    out->v = SELECT(analytic, h.v, out->v);
#if HAS_ANISOTROPY
    Frame frame = frame_along(h.normal, h.tangent);
#else
    Frame frame = frame_of_normal(h.normal);
#endif
    out->frame.s = select3(analytic, frame.s, out->frame.s);
    out->frame.t = select3(analytic, frame.t, out->frame.t);
    out->frame.n = select3(analytic, frame.n, out->frame.n);
}
#endif

// The material of the side that is seen, and the frame turned to that side unless light passes through.
INLINE void choose_side(SurfaceView s, const TracedPath *p, Surface *out) {
    Vec3 back_along = negate(p->direction);
    out->wi = to_local(out->frame, back_along);
    Int behind = out->wi.z < 0.0f;
    UInt front = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, front_material);
#if HAS_UNLIKE_SIDES
    UInt back = GATHER_UINT_FIELD(s.shapes, Shape, out->shape, back_material);
    out->material = SELECT(behind, back, front);
#else
    out->material = front;
#endif
#if HAS_TRANSMISSION
    UInt known = SELECT(out->material == (UInt)WAVELOBE_NONE, (UInt)0u, out->material);
    UInt flags = GATHER_UINT_FIELD(s.materials, Material, known, flags);
    Int turned = behind & ((flags & (UInt)MATERIAL_TRANSMISSIVE) == (UInt)0u);
#else
    Int turned = behind;
#endif
    out->frame.n = select3(turned, negate(out->frame.n), out->frame.n);
    out->wi.z = SELECT(turned, -out->wi.z, out->wi.z);
}

INLINE Surface load_surface(SurfaceView s, const TracedPath *p) {
    Surface out;
    out.primitive = primitive_of_hit(s, p->hit);
    out.shape = gather_uint(s.primitive_shapes, out.primitive);
    UInt first_primitive = GATHER_UINT_FIELD(s.shapes, Shape, out.shape, first_primitive);
#if HAS_ANALYTIC
    Int analytic = (p->hit & (UInt)HIT_ANALYTIC) != (UInt)0u;
    load_triangle(s, p, SELECT(analytic, (UInt)0u, p->hit), first_primitive, &out);
    if (any_lane(analytic)) load_analytic(s, p, analytic, &out);
#else
    load_triangle(s, p, p->hit, first_primitive, &out);
#endif
    choose_side(s, p, &out);
    return out;
}

#endif
