// The contract of a light: what every lights/<name>.h provides.
//
// All of them:
//   LightSample <name>_sample_light(LightInput in, Vec3 reference, Float u1, Float u2)
//         a point or direction of the light as seen from the reference point (world space)
//
// Those that a path can reach (SURFACE: `direction` is the unit direction of the ray from `reference` that hit it at
// distance `t`; ENVIRONMENT: it escaped along `direction`, t is infinite):
//   Float <name>_pdf(LightInput in, Vec3 reference, Vec3 direction, Float t, Vec3 normal)
//         density of <name>_sample_light producing that direction, solid angle, without the choice of the light;
//         `normal` is the unit normal of the light's surface there, on its emitting side
// The radiance of a hit is `light_radiance(in, u, v)` on the emitting side; ENVIRONMENT lights provide
//   Rgb <name>_radiance(LightInput in, Vec3 direction)
#ifndef WAVELOBE_LIGHTS_LIGHT_H
#define WAVELOBE_LIGHTS_LIGHT_H

#include "core/math.h"
#include "core/rows.h"
#include "core/vector.h"
#include "core/rounding.h"
#include "shared/lights.h"
#include "bsdf/lobe.h"

// The light of each lane, and the buffers that describe lights.
typedef struct {
    UInt light;
    global const struct Light *lights;
    global const struct Analytic *analytics;
    global const struct Environment *environment;
    global const float *environment_texels;        // rgb, row 0 at the top
    global const float *environment_sums;              // running sums of probabilities, see lights/envmap.h
    global const float *environment_density;       // a cell: probability over its share of the unit square, that is pdf in (u, v)
    global const struct Texture *textures;
    global const float *texels;
    global const struct LightNode *light_tree;
    uint light_count, finite_light_count; // with a tree: those in it come first
} LightInput;

typedef struct {
    Vec3 direction;  // unit, from the reference point to the light
    Vec3 point;      // on the light, world space (lights at infinity: unused)
    Vec3 error;      // absolute bound on the rounding error of `point`; zero for points
    Vec3 normal;     // of the light at `point`; zero where the light has no surface
    Int at_infinity;
    Rgb radiance;    // towards the reference; zero where the light does not shine. DELTA: incident irradiance on a
                     // surface facing it, W / m^2
    Float pdf;       // solid angle, without the choice of the light; DELTA: 1
    Int delta;
} LightSample;

// A field of the lane's light record.  With one record it is the same for all lanes: no gather.
#if LIGHT_COUNT == 1 && !HAS_UNSAMPLED_EMITTERS
#define light_field(in, name) ((Float)(*((global const float *)(in).lights + WORD_OFFSET(Light, name))))
#define light_word(in, offset) ((Float)(*((global const float *)(in).lights + (offset))))
#else
#define light_field(in, name) GATHER_FIELD((in).lights, Light, (in).light, name)
#define light_word(in, offset) gather((global const float *)(in).lights + (offset), (in).light * RECORD_WORDS(Light))
#endif
#define light_vector(in, name)                                                                             \
    vec3(light_word(in, WORD_OFFSET(Light, name)), light_word(in, WORD_OFFSET(Light, name) + 1u), \
         light_word(in, WORD_OFFSET(Light, name) + 2u))

// Where a triangle, parallelogram or rectangle lies.
typedef struct {
    Vec3 position, edge1, edge2, normal;
    Float inverse_area, inverse_length1, inverse_length2;
} PlanarLight;

INLINE PlanarLight planar_light(LightInput in) {
#if LIGHT_COUNT == 1 && !HAS_UNSAMPLED_EMITTERS
    PlanarLight p = {light_vector(in, position), light_vector(in, edge1), light_vector(in, edge2), light_vector(in, normal),
                     light_field(in, inverse_area), light_field(in, inverse_length1), light_field(in, inverse_length2)};
#else
    Rows r;
    gather_rows((global const float *)in.lights + WORD_OFFSET(Light, position), in.light * RECORD_WORDS(Light), &r);
#define PLANAR_FIELD(name) r.word[WORD_OFFSET(Light, name) - WORD_OFFSET(Light, position)]
#define PLANAR_VECTOR(name) vec3(PLANAR_FIELD(name.x), PLANAR_FIELD(name.y), PLANAR_FIELD(name.z))
    PlanarLight p = {PLANAR_VECTOR(position), PLANAR_VECTOR(edge1), PLANAR_VECTOR(edge2), PLANAR_VECTOR(normal),
                     PLANAR_FIELD(inverse_area), PLANAR_FIELD(inverse_length1), PLANAR_FIELD(inverse_length2)};
#undef PLANAR_VECTOR
#undef PLANAR_FIELD
#endif
    return p;
}

#endif
