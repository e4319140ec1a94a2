// A smooth conductor.
#ifndef WAVELOBE_BSDF_MIRROR_H
#define WAVELOBE_BSDF_MIRROR_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

typedef struct {
    Rgb specular, eta, k;
} MirrorLobe;

INLINE MirrorLobe mirror_load(MaterialInput in) {
    MirrorLobe l = {load_rgb(in, specular), constant_rgb(in, WORD_OFFSET(Material, eta)),
                    constant_rgb(in, WORD_OFFSET(Material, k))};
    return l;
}

INLINE Float mirror_weight(MirrorLobe l, Vec3 wi) { return ONE; }

INLINE DeltaSample mirror_sample(MirrorLobe l, Vec3 wi, Float u) {
    Rgb weight = mul(l.specular, fresnel_conductor_rgb(fabs(wi.z), l.eta, l.k));
    DeltaSample s = {mirror_direction(wi), select3(wi.z > 0.0f, weight, vec3_all(ZERO)), ONE};
    return s;
}

#endif
