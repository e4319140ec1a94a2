// Everything a stage may read of the scene and write of the picture: each buffer that the scene has, as a kernel parameter
// of its name, and all of them as one struct. What a stage does not read costs it nothing.
#ifndef WAVELOBE_STAGES_SCENE_VIEW_H
#define WAVELOBE_STAGES_SCENE_VIEW_H

#if HAS_LAYERS || HAS_MOMENTS
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif
#include "bsdf/material.h"
#include "shapes/geometry_parameters.h"
#if HAS_CAUSTICS
#include "caustics/guide.h"
#endif
#if HAS_LIGHTS
#include "lights/choose.h"
#endif
#if HAS_MEDIA
#include "shapes/media.h"
#endif

typedef struct {
    global const struct RenderParameters *parameters;
    SurfaceView surfaces;
    Geometry geometry;
    global const struct Texture *textures;
    global const float *texels;
#if HAS_LIGHTS
    LightInput lights;
#endif
#if HAS_MEDIA
    MediaView media;
#endif
    global const float *filter_table;
    global struct FilmPixel *film;
#if HAS_CAUSTICS
    CausticView caustics;
#endif
#if HAS_LAYERS
    global double *layer_film;
    global const uint *layer_shapes; // number of each shape
#endif
#if HAS_MOMENTS
    global double *moment_film;
#endif
} SceneView;

#if HAS_CAUSTICS
#define CAUSTIC_PARAMETERS , global struct CausticGrid *caustic_grid, global const uint *caustic_cells, global const float *caustic_maps
#define CAUSTIC_ARGUMENTS , {caustic_grid, caustic_cells, caustic_maps}
#else
#define CAUSTIC_PARAMETERS
#define CAUSTIC_ARGUMENTS
#endif
#if HAS_LAYERS
#define LAYER_PARAMETERS , global double *layer_film, global const uint *layer_shapes
#define LAYER_ARGUMENTS , layer_film, layer_shapes
#else
#define LAYER_PARAMETERS
#define LAYER_ARGUMENTS
#endif
#if HAS_MOMENTS
#define MOMENT_PARAMETER , global double *moment_film
#define MOMENT_ARGUMENT , moment_film
#else
#define MOMENT_PARAMETER
#define MOMENT_ARGUMENT
#endif

#if HAS_LIGHTS
#define SCENE_LIGHT_PARAMETERS LIGHT_PARAMETERS
#define SCENE_LIGHT_VIEW LIGHT_VIEW,
#else
#define SCENE_LIGHT_PARAMETERS
#define SCENE_LIGHT_VIEW
#endif
#if HAS_MEDIA
#define MEDIA_PARAMETERS , global const struct Medium *media, global const struct ShapeMedia *shape_media
#define MEDIA_VIEW {media, shape_media},
#else
#define MEDIA_PARAMETERS
#define MEDIA_VIEW
#endif

#define SCENE_PARAMETERS                                                                          \
    SURFACE_PARAMETERS TEXTURE_PARAMETERS SCENE_LIGHT_PARAMETERS MEDIA_PARAMETERS, GEOMETRY_PARAMETERS, \
        global const float *filter_table, global struct FilmPixel *film CAUSTIC_PARAMETERS LAYER_PARAMETERS MOMENT_PARAMETER
#define SCENE_VIEW                                                                                \
    {parameters, SURFACE_VIEW, GEOMETRY_VIEW, TEXTURE_ARGUMENTS, SCENE_LIGHT_VIEW MEDIA_VIEW filter_table, film CAUSTIC_ARGUMENTS LAYER_ARGUMENTS \
     MOMENT_ARGUMENT}

#endif
