// What every stage reads of the scene besides geometry, materials and lights.
#ifndef WAVELOBE_SHARED_SCENE_H
#define WAVELOBE_SHARED_SCENE_H

#include "shared/bvh.h"
#include "shared/types.h"

// A surface: the triangles of one mesh, or one analytic shape.
struct Shape {
    Uint32 front_material; // WAVELOBE_NONE: black
    Uint32 back_material;
    Uint32 first_primitive; // triangle id of its first triangle
    Uint32 first_normal;    // offset into `normals`, in floats, of its first triangle; WAVELOBE_NONE: faceted
    Uint32 first_uv;        // offset into `uvs`; WAVELOBE_NONE: barycentric coordinates serve
    Uint32 first_color;     // offset into `colors`; WAVELOBE_NONE: white
    Uint32 first_light;     // light of its first triangle; WAVELOBE_NONE: does not emit
    Uint32 triangles_per_light; // 1, or 2 for a parallelogram lit as one
    Uint32 flags;           // SHAPE_x bits
};
WAVELOBE_CHECK_SIZE(Shape, 36);

// Classes of lobes that either side of it has, and whether it is a light.
#define SHAPE_HAS_DELTA 1u
#define SHAPE_HAS_GLOSSY 2u
#define SHAPE_HAS_DIFFUSE 4u
#define SHAPE_EMITS 8u
#define SHAPE_MASKED 16u // rays ask for its opacity
#define SHAPE_VEILED 32u // emits on each hit whatever its opacity, which only says how many paths go on behind it
#define SHAPE_PARTS_MEDIA 64u // says which media are on its two sides
#define SHAPE_CLEAR 128u // parts media and is not there otherwise: rays go on behind it

// Perspective camera, film window, and the integrator's limits.
struct RenderParameters {
    struct Affine camera_to_world;
    // Film coordinates in pixels (y down) to the plane z = 1 of the camera: x = x_scale * px + x_offset ...
    float x_scale, x_offset, y_scale, y_offset;
    float near_clip, far_clip;
    Uint32 window_x, window_y, window_width, window_height; // of the film that is rendered
    Uint32 seed;
    Uint32 max_depth; // vertices a path may have; at least 1
    Uint32 rr_depth;  // Russian roulette from this many vertices on
    Uint32 light_count;
    Uint32 finite_light_count; // with a light tree: these are in it, the rest is at infinity
    Uint32 triangle_count;
    struct FewSummary few; // of scenes without a hierarchy
    Uint32 camera_medium; // that the camera is in
};
WAVELOBE_CHECK_SIZE(RenderParameters, 144);

// What a pixel holds. Sums are in double: the mean of ten million samples is as good as each of them.
struct FilmPixel {
    double sum[3];
    Uint32 samples;   // finite ones
    Uint32 nonfinite; // NaN or infinite: left out of the sums
};
WAVELOBE_CHECK_SIZE(FilmPixel, 32);

#endif
