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
    Uint32 first_normal;    // offset into `normals`, in floats, of its first triangle; WAVELOBE_NONE: faceted. 9 a triangle, and
                            // of shapes with tangents another 9 for these
    Uint32 first_uv;        // offset into `uvs`; WAVELOBE_NONE: barycentric coordinates serve
    Uint32 first_second_uv; // the same of the second set; WAVELOBE_NONE: the first serves
    Uint32 first_color;     // offset into `colors`; WAVELOBE_NONE: white
    Uint32 first_light;     // light of its first triangle; WAVELOBE_NONE: does not emit
    Uint32 triangles_per_light; // 1, or 2 for a parallelogram lit as one
    Uint32 flags;           // SHAPE_x bits
};
WAVELOBE_CHECK_SIZE(Shape, 40);

// Classes of lobes that either side of it has, and whether it is a light.
#define SHAPE_HAS_DELTA 1u
#define SHAPE_HAS_GLOSSY 2u
#define SHAPE_HAS_DIFFUSE 4u
#define SHAPE_EMITS 8u
#define SHAPE_MASKED 16u // rays ask for its opacity
#define SHAPE_VEILED 32u // emits on each hit whatever its opacity, which only says how many paths go on behind it
#define SHAPE_UNSAMPLED 64u      // emits, and is no light: one record of radiance for all of it
#define SHAPE_EMITS_BEHIND 128u  // on both sides; the back is never sampled
#define SHAPE_CULLED_BEHIND 512u // its back, told by the geometric normal, is seen by the camera and beyond delta lobes alone; other paths see the front
#define SHAPE_EMITS_COLORED 256u // scaled by the colours of its vertices
#define SHAPE_PARTS_MEDIA 1024u     // says which media are on its two sides
#define SHAPE_HAS_TANGENTS 4096u    // of its vertices
#define SHAPE_CLEAR 2048u           // parts media and is not there otherwise: rays go on behind it

// Where the sample values of a picture come from: which of the sequences (another seed, other noise), and how it is shared out among the
// pixels (sampling/sampler.h).
struct SampleSequence {
    Uint32 seed;
    Uint32 digits; // binary, that number the samples of a pixel; SEQUENCE_A_PIXEL where their number is open
};
WAVELOBE_CHECK_SIZE(SampleSequence, 8);

// Of `digits`: no two pixels share a sequence.
#define SEQUENCE_A_PIXEL 31u

// Camera, film window, and the integrator's limits.
struct RenderParameters {
    struct Affine camera_to_world;
    // Film coordinates in pixels (y down) to the plane z = 1 of a perspective camera, the plane z = 0 of an orthographic one: x = x_scale * px + x_offset ...
    float x_scale, x_offset, y_scale, y_offset;
    float near_clip, far_clip;
    float aperture_radius, focus_distance; // of a thin lens
    Uint32 window_x, window_y, window_width, window_height; // of the film that is rendered
    struct SampleSequence sequence;
    Uint32 max_depth; // vertices a path may have; at least 1
    Uint32 rr_depth;  // Russian roulette from this many vertices on
    Uint32 light_count;
    Uint32 finite_light_count; // with a light tree: these are in it, the rest is at infinity
    Uint32 triangle_count;
    struct FewSummary few; // of scenes without a hierarchy
    Uint32 layer_first_instance; // number of the first instance among the shapes that layers name
    float layer_film_step;       // pixels between samples, for layers that ask how fast something varies
    Uint32 camera_medium; // that the camera is in
};
WAVELOBE_CHECK_SIZE(RenderParameters, 180);

// Squares of red, green and blue, and of X, Y and Z, that a pixel holds where they are asked for.
#define MOMENT_CHANNELS 6u

// What a pixel holds. Sums are in double: the mean of ten million samples is as good as each of them.
struct FilmPixel {
    double sum[3];
    Uint32 samples;   // finite ones
    Uint32 nonfinite; // NaN or infinite: left out of the sums
};
WAVELOBE_CHECK_SIZE(FilmPixel, 32);

#endif
