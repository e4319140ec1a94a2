// A pane so thin that the two refractions cancel: light is reflected or goes straight on, by the sum over all internal
// reflections.
#ifndef WAVELOBE_BSDF_THIN_DIELECTRIC_H
#define WAVELOBE_BSDF_THIN_DIELECTRIC_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

typedef struct {
    Rgb specular, transmission;
    Float eta;
} ThinDielectricLobe;

INLINE ThinDielectricLobe thin_dielectric_load(MaterialInput in) {
    ThinDielectricLobe l = {load_rgb(in, specular), load_rgb(in, transmission), load_constant(in, eta.x)};
    return l;
}

INLINE Float thin_dielectric_weight(ThinDielectricLobe l, Vec3 wi) { return ONE; }

INLINE DeltaSample thin_dielectric_sample(ThinDielectricLobe l, Vec3 wi, Float u) {
    Float r = fresnel_dielectric(fabs(wi.z), l.eta).reflectance;
    // r + t r t + t r^3 t + ... with t = 1 - r
    Int reflects = u < 2.0f * r / (1.0f + r);
    DeltaSample s;
    s.wo = select3(reflects, mirror_direction(wi), negate(wi));
    s.weight = select3(reflects, l.specular, l.transmission);
    s.eta = ONE;
    return s;
}

#endif
