// The buffers that describe surfaces, as kernels are given them.
#ifndef WAVELOBE_SHAPES_SURFACE_VIEW_H
#define WAVELOBE_SHAPES_SURFACE_VIEW_H

#include "core/lanes.h"
#include "shared/lights.h"
#include "shared/materials.h"
#include "shared/scene.h"

// Kernels take SURFACE_PARAMETERS and write SURFACE_VIEW.
typedef struct {
    global const float *triangle_blocks;  // TriangleBlock
#if HAS_FEW_TRIANGLES
    global const struct FewSlot *few_slots; // of the triangle in each slot
#endif
    global const uint *primitive_shapes;  // shape of each triangle, then of each analytic shape
    global const struct Shape *shapes;
    global const struct Material *materials;
#if HAS_SMOOTH_NORMALS
    global const float *normals; // 9 a triangle
#endif
#if HAS_UVS
    global const float *uvs; // 6 a triangle
#endif
#if HAS_VERTEX_COLORS
    global const float *colors; // 9 a triangle
#endif
#if HAS_ANALYTIC
    global const struct Analytic *analytics;
    uint triangle_count;
#endif
#if HAS_INSTANCES
    global const struct Instance *instances;
#endif
} SurfaceView;

#if HAS_FEW_TRIANGLES
#define FEW_SLOTS_PARAMETER , global const struct FewSlot *few_slots
#define FEW_SLOTS_ARGUMENT , few_slots
#else
#define FEW_SLOTS_PARAMETER
#define FEW_SLOTS_ARGUMENT
#endif
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
#if HAS_VERTEX_COLORS
#define COLORS_PARAMETER , global const float *colors
#define COLORS_ARGUMENT , colors
#else
#define COLORS_PARAMETER
#define COLORS_ARGUMENT
#endif
#if HAS_ANALYTIC
#define ANALYTIC_PARAMETER , global const struct Analytic *analytics
#define ANALYTIC_ARGUMENT , analytics, parameters->triangle_count
#else
#define ANALYTIC_PARAMETER
#define ANALYTIC_ARGUMENT
#endif
#if HAS_INSTANCES
#define INSTANCES_PARAMETER , global const struct Instance *instances
#define INSTANCES_ARGUMENT , instances
#else
#define INSTANCES_PARAMETER
#define INSTANCES_ARGUMENT
#endif

#define SURFACE_PARAMETERS                                                                                  \
    global const struct RenderParameters *parameters, global const float *triangle_blocks FEW_SLOTS_PARAMETER, \
        global const uint *primitive_shapes, global const struct Shape *shapes,                             \
        global const struct Material *materials NORMALS_PARAMETER UVS_PARAMETER COLORS_PARAMETER ANALYTIC_PARAMETER \
            INSTANCES_PARAMETER
#define SURFACE_VIEW                                                                                               \
    {triangle_blocks FEW_SLOTS_ARGUMENT, primitive_shapes, shapes, materials NORMALS_ARGUMENT UVS_ARGUMENT COLORS_ARGUMENT            \
         ANALYTIC_ARGUMENT INSTANCES_ARGUMENT}

#endif
