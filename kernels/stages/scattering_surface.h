// The surface as lobes see it: where materials nest, gone through to the one with lobes. Every stage that asks finds the same.
#ifndef WAVELOBE_STAGES_SCATTERING_SURFACE_H
#define WAVELOBE_STAGES_SCATTERING_SURFACE_H

#include "stages/dimensions.h"
#include "stages/scene_view.h"
#if HAS_NESTING
#include "bsdf/nesting.h"
#endif

INLINE Surface load_scattering_surface(const SceneView *scene, const TracedPath *path, SampleId sample) {
    Surface surface = load_surface(scene->surfaces, path);
#if HAS_NESTING
    Float u = ZERO;
#if HAS_BLENDS
    Float unused;
    sample_2d(sample, vertex_pair(path->depth, PAIR_BLEND), &u, &unused);
#endif
    enter_nested_materials(&surface, scene->surfaces.materials, scene->textures, scene->texels, u);
#endif
    return surface;
}

// What normal maps leave of light that goes along a direction.
#if HAS_NORMAL_MAPS
#define MAPPED_SHARE(surface, direction) mapped_share(surface, direction)
#else
#define MAPPED_SHARE(surface, direction) ONE
#endif

#endif
