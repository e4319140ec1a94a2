// A smooth interface between two dielectrics.
#ifndef WAVELOBE_BSDF_DIELECTRIC_H
#define WAVELOBE_BSDF_DIELECTRIC_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

typedef struct {
    Rgb specular, transmission;
    Float eta;
} DielectricLobe;

INLINE DielectricLobe dielectric_load(MaterialInput in) {
    DielectricLobe l = {load_rgb(in, specular), load_rgb(in, transmission), load_constant(in, eta.x)};
    return l;
}

INLINE Float dielectric_weight(DielectricLobe l, Vec3 wi) { return ONE; }

// Reflects with the probability of the reflectance, so that it drops out of the weights.
INLINE DeltaSample dielectric_sample(DielectricLobe l, Vec3 wi, Float u) {
    DielectricFresnel f = fresnel_dielectric(wi.z, l.eta);
    Int reflects = u < f.reflectance;
    Vec3 refracted = vec3(-f.eta_ti * wi.x, -f.eta_ti * wi.y, f.cos_t);
    // Radiance is divided by the squared index of its medium along a refracted ray: Veach 1997, section 5.2.
    Rgb transmitted = scale(l.transmission, f.eta_ti * f.eta_ti);
    DeltaSample s;
    s.wo = select3(reflects, mirror_direction(wi), refracted);
    s.weight = select3(reflects, l.specular, transmitted);
    s.eta = SELECT(reflects, ONE, f.eta_it);
    return s;
}

#endif
