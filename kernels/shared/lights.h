// A light as the kernels see it, and the tree by which lights are chosen.
#ifndef WAVELOBE_SHARED_LIGHTS_H
#define WAVELOBE_SHARED_LIGHTS_H

#include "shared/materials.h"

// Which fields a kind uses is said in its lights/<name>.h.
struct Light {
    Uint32 kind;                  // LIGHT_x of lights/lights.def
    float selection_probability;  // of this light among all; not of those in a tree
    struct TexturedRgb radiance;  // W / (m^2 sr); point and spot: intensity, W / sr; directional: irradiance, W / m^2; projector: a picture
    struct Packed3 position;      // first vertex; point, spot: where it is
    struct Packed3 edge1;         // to the second vertex; spot, directional: direction the light travels, unit
    struct Packed3 edge2;         // to the third vertex
    struct Packed3 normal;        // unit, on the emitting side
    float inverse_area;           // 1 / m^2
    float inverse_length1, inverse_length2; // of the edges, 1 / m
    float uv[6];                  // of the three vertices (texture coordinates of a textured emitter)
    Uint32 analytic;              // index of its analytic shape
    float cos_cutoff, cos_beam;   // spot
    Uint32 smooth_cone;           // spot: 1: between the angles the square of what is linear in the cosine; 0: linear in the angle
    float inverse_range;          // point, spot: over the distance from which on there is no light, 1 / m; 0: none
    Uint32 place;                 // of its leaf in the light tree: LIGHT_PLACE
    Uint32 triangle;              // number of its triangle or the first of two; WAVELOBE_NONE: of another kind
};
WAVELOBE_CHECK_SIZE(Light, 136);

#define LIGHT_CHILDREN 8

// A node of the light tree: bounds on the lights below each of its children.
struct LightNode {
    float center_x[LIGHT_CHILDREN], center_y[LIGHT_CHILDREN], center_z[LIGHT_CHILDREN]; // of a sphere about them
    float radius[LIGHT_CHILDREN];
    float axis_x[LIGHT_CHILDREN], axis_y[LIGHT_CHILDREN], axis_z[LIGHT_CHILDREN]; // unit, of the cone that holds their normals
    float cos_spread[LIGHT_CHILDREN], sin_spread[LIGHT_CHILDREN]; // of its half angle
    float cos_emission[LIGHT_CHILDREN]; // of the angle off a normal up to which they shine
    float intensity[LIGHT_CHILDREN];    // the greatest of all together by luminance, as a share of the tree's; 0: no child
    Uint32 child[LIGHT_CHILDREN];       // a node, or LIGHT_LEAF | light
    Uint32 place;                       // of this node: LIGHT_PLACE(parent, which child), or LIGHT_ROOT
    Uint32 padding[7];
};
WAVELOBE_CHECK_SIZE(LightNode, 416);

#define LIGHT_LEAF 0x80000000u
#define LIGHT_ROOT 0xffffffffu
#define LIGHT_PLACE(node, child) ((node) * LIGHT_CHILDREN + (child))

// An analytic shape: unit sphere, unit disk in z = 0, or unit cylinder along z in [0, 1], under an affine map.
struct Analytic {
    struct Affine to_world;
    struct Affine to_object;
    Uint32 kind;      // ANALYTIC_x
    float flip;       // -1: normals point the other way, otherwise 1
    float area;       // world space
    float radius;     // sphere: world-space radius
};
WAVELOBE_CHECK_SIZE(Analytic, 112);

#define ANALYTIC_SPHERE 0u
#define ANALYTIC_DISK 1u
#define ANALYTIC_CYLINDER 2u

// The environment: a latitude-longitude picture, bilinear between texel centres, wrapping in longitude. It is sampled
// by cells, the squares between four neighbouring texel centres, with a constant density inside each cell in (u, v).
struct Environment {
    struct Affine to_world;
    struct Affine to_object;
    Uint32 width, height; // texels; a constant environment is 0 x 0
    Uint32 cell_columns, cell_rows;
    struct Packed3 radiance; // of a constant environment; scale of a picture otherwise
    Uint32 light;            // index of its light record
};
WAVELOBE_CHECK_SIZE(Environment, 128);

#endif
