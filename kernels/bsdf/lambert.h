// Ideally diffuse reflection.
#ifndef WAVELOBE_BSDF_LAMBERT_H
#define WAVELOBE_BSDF_LAMBERT_H

#include "bsdf/lobe.h"
#include "sampling/warps.h"

typedef struct {
    Rgb diffuse;
} LambertLobe;

INLINE LambertLobe lambert_load(MaterialInput in) {
    LambertLobe l = {load_rgb(in, diffuse)};
    return l;
}

INLINE Float lambert_weight(LambertLobe l, Vec3 wi) { return max_component(l.diffuse); }

INLINE LobeValue lambert_eval(LambertLobe l, Vec3 wi, Vec3 wo) {
    Float pdf = wo.z * INV_PI;
    return lobe_value_where((wi.z > 0.0f) & (wo.z > 0.0f), scale(l.diffuse, pdf), pdf);
}

INLINE Vec3 lambert_sample(LambertLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    return select3(wi.z > 0.0f, sample_cosine_hemisphere(u1, u2), vec3_all(ZERO));
}

#endif
