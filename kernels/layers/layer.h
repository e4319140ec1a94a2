// What each layer holds of a surface that the camera sees: `void layer_<name>(LayerInput, Float *out)` fills the layer's channels
// for LANES camera rays. Where nothing is hit all of them are zero.
#ifndef WAVELOBE_LAYERS_LAYER_H
#define WAVELOBE_LAYERS_LAYER_H

#include "bsdf/material.h"
#include "layers/uv_partials.h"
#include "stages/camera.h"
#include "stages/scattering_surface.h"

typedef struct {
    Block block;
    const SceneView *scene;
    const TracedPath *path;
    const Surface *surface; // its frame not turned to the side that is seen
    UvPartials partials;    // of layers that ask for them
} LayerInput;

INLINE SampleId layer_sample(LayerInput in) { return path_sample_id(in.block, in.path->id, in.scene->parameters->sequence); }

INLINE void put_vec3(Float *out, Vec3 v) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

INLINE void layer_coverage(LayerInput in, Float *out) { out[0] = ONE; }
INLINE void layer_depth(LayerInput in, Float *out) { out[0] = in.path->t; }
INLINE void layer_position(LayerInput in, Float *out) { put_vec3(out, in.surface->position); }
INLINE void layer_geo_normal(LayerInput in, Float *out) { put_vec3(out, in.surface->normal); }
INLINE void layer_dp_du(LayerInput in, Float *out) { put_vec3(out, in.partials.dp_du); }
INLINE void layer_dp_dv(LayerInput in, Float *out) { put_vec3(out, in.partials.dp_dv); }

// After the normal maps of the material, on the side of the surface's own.
INLINE void layer_sh_normal(LayerInput in, Float *out) {
    Vec3 n = in.surface->frame.n;
#if HAS_NORMAL_MAPS
    Vec3 mapped = load_scattering_surface(in.scene, in.path, layer_sample(in)).frame.n;
    n = select3(dot3(mapped, n) < 0.0f, negate(mapped), mapped);
#endif
    put_vec3(out, n);
}

INLINE void layer_uv(LayerInput in, Float *out) {
    out[0] = in.surface->u;
    out[1] = in.surface->v;
}

// The reflectance of a base under a coat, else what the lobes send along the normal: pi times the BSDF there. A side that is black
// only because the material has one has its albedo.
INLINE void layer_albedo(LayerInput in, Float *out) {
    Surface seen = load_scattering_surface(in.scene, in.path, layer_sample(in));
    UInt front = GATHER_UINT_FIELD(in.scene->surfaces.shapes, Shape, seen.shape, front_material);
    seen.material = SELECT(seen.material == (UInt)WAVELOBE_NONE, front, seen.material);
    MaterialInput material = material_input(&seen, in.scene->surfaces.materials, in.scene->textures, in.scene->texels);
    UInt lobes = material_lobes(&seen, material);
    SmoothLobes smooth = load_smooth_lobes(lobes, material, seen.wi);
    Rgb albedo = scale(eval_smooth_lobes(&smooth, seen.wi, vec3(ZERO, ZERO, ONE)).f_cos, (Float)PI_F);
    Int coated = has_lobe(lobes, LOBE_PLASTIC_BASE) | has_lobe(lobes, LOBE_ROUGH_PLASTIC_BASE);
    if (any_lane(coated)) albedo = select3(coated, load_rgb(material, diffuse), albedo);
    put_vec3(out, albedo);
}

// Solves for the texture coordinates of the point where the ray of a neighbouring place of the film meets the tangent plane, in
// the sense of least squares.
INLINE void uv_step(LayerInput in, Float dx, Float dy, Float *out) {
    global const struct RenderParameters *p = in.scene->parameters;
    FilmSample at = film_sample(in.block, in.scene, in.path->id);
    Float step = (Float)p->layer_film_step;
    CameraRay ray = camera_ray(p, at.id, madd(dx, step, at.x), madd(dy, step, at.y));
    Vec3 n = in.surface->normal;
    Float t = dot3(n, sub(in.surface->position, ray.origin)) / dot3(n, ray.direction);
    Vec3 moved = sub(scale_add(ray.direction, t, ray.origin), in.surface->position);
    Vec3 du = in.partials.dp_du, dv = in.partials.dp_dv;
    Float a00 = length_squared(du), a01 = dot3(du, dv), a11 = length_squared(dv);
    Float b0 = dot3(du, moved), b1 = dot3(dv, moved);
    Float det = difference_of_products(a00, a11, a01, a01);
    out[0] = SELECT(det != 0.0f, difference_of_products(a11, b0, a01, b1) / det, ZERO);
    out[1] = SELECT(det != 0.0f, difference_of_products(a00, b1, a01, b0) / det, ZERO);
}

INLINE void layer_duv_dx(LayerInput in, Float *out) { uv_step(in, ONE, ZERO, out); }
INLINE void layer_duv_dy(LayerInput in, Float *out) { uv_step(in, ZERO, ONE, out); }

INLINE void layer_prim_index(LayerInput in, Float *out) {
    UInt first = GATHER_UINT_FIELD(in.scene->surfaces.shapes, Shape, in.surface->shape, first_primitive);
    out[0] = convert_Float(as_Int(in.surface->primitive - first));
}

INLINE void layer_shape_index(LayerInput in, Float *out) {
    UInt number = gather_uint(in.scene->layer_shapes, in.surface->shape);
#if HAS_INSTANCES
    Int placed = in.path->instance != (UInt)INSTANCE_NONE;
    number = SELECT(placed, in.path->instance + (UInt)in.scene->parameters->layer_first_instance, number);
#endif
    out[0] = convert_Float(as_Int(number));
}

#endif
