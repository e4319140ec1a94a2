// Where on the film a sample lies, and the camera's ray through there.
#ifndef WAVELOBE_STAGES_CAMERA_H
#define WAVELOBE_STAGES_CAMERA_H

#include "core/math.h"
#include "sampling/warps.h"
#include "stages/dimensions.h"
#include "stages/scene_view.h"

typedef struct {
    SampleId id;
    Float x, y;   // film coordinates in pixels
    Float weight; // in the mean over the pixel's samples; 1 unless the filter is negative somewhere
} FilmSample;

// Of a path's pixel by sample `id`.
INLINE FilmSample film_sample_of(Block block, const SceneView *scene, UInt path, SampleId id) {
    FilmSample s;
    s.id = id;
    Float u1, u2;
    sample_2d(s.id, (UInt)PAIR_FILM, &u1, &u2);
    s.x = convert_Float(as_Int(path_pixel_x(block, path))) + 0.5f + sample_filter(scene->filter_table, u1);
    s.y = convert_Float(as_Int(path_pixel_y(block, path))) + 0.5f + sample_filter(scene->filter_table, u2);
#if HAS_SIGNED_FILTER
    s.weight = filter_weight(scene->filter_table, u1) * filter_weight(scene->filter_table, u2);
#else
    s.weight = ONE;
#endif
    return s;
}

INLINE FilmSample film_sample(Block block, const SceneView *scene, UInt path) {
    return film_sample_of(block, scene, path, path_sample_id(block, path, scene->parameters->sequence));
}

// A ray of the camera in world space, from its near to its far plane.
typedef struct {
    Vec3 origin;
    Vec3 direction; // unit
    Float length;
} CameraRay;

INLINE Vec3 transform_vector(global const struct Affine *a, Vec3 v) {
    return vec3(madd(v.x, (Float)a->m[0], madd(v.y, (Float)a->m[1], v.z * a->m[2])),
                madd(v.x, (Float)a->m[4], madd(v.y, (Float)a->m[5], v.z * a->m[6])),
                madd(v.x, (Float)a->m[8], madd(v.y, (Float)a->m[9], v.z * a->m[10])));
}

INLINE CameraRay camera_ray(global const struct RenderParameters *p, SampleId sample, Float film_x, Float film_y) {
    Float x = madd(film_x, (Float)p->x_scale, (Float)p->x_offset), y = madd(film_y, (Float)p->y_scale, (Float)p->y_offset);
    global const float *m = p->camera_to_world.m;
    Vec3 eye = vec3((Float)m[3], (Float)m[7], (Float)m[11]);
    CameraRay r;
#if HAS_ORTHOGRAPHIC
    r.direction = normalize3(transform_vector(&p->camera_to_world, vec3(ZERO, ZERO, ONE)));
    r.origin = add(eye, transform_vector(&p->camera_to_world, vec3(x, y, (Float)p->near_clip)));
    r.length = (Float)(p->far_clip - p->near_clip);
#else
    Vec3 on_plane = vec3(x, y, ONE);
#if HAS_THIN_LENS
    // Every point of the lens looks at the same point of the plane that is sharp.
    Float u1, u2;
    sample_2d(sample, (UInt)PAIR_LENS, &u1, &u2);
    Vec2 disk = square_to_disk(u1, u2);
    Vec3 lens = vec3(disk.x * p->aperture_radius, disk.y * p->aperture_radius, ZERO);
    on_plane = sub(on_plane, scale(lens, (Float)(1.0f / p->focus_distance)));
    eye = add(eye, transform_vector(&p->camera_to_world, lens));
#endif
    Float stretch = sqrt(length_squared(on_plane)); // distance along the ray a unit of depth
    r.direction = normalize3(transform_vector(&p->camera_to_world, on_plane));
    r.origin = scale_add(r.direction, stretch * p->near_clip, eye);
    r.length = stretch * (p->far_clip - p->near_clip);
#endif
    return r;
}

#endif
