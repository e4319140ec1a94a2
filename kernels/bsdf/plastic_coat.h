// The smooth surface of plastic: what of it reflects. Its lower part is plastic_base.
#ifndef WAVELOBE_BSDF_PLASTIC_COAT_H
#define WAVELOBE_BSDF_PLASTIC_COAT_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

typedef struct {
    Rgb specular;
    Float eta, specular_weight;
} PlasticCoatLobe;

INLINE PlasticCoatLobe plastic_coat_load(MaterialInput in) {
    PlasticCoatLobe l = {load_rgb(in, specular), load_constant(in, eta.x), load_constant(in, specular_weight)};
    return l;
}

INLINE Float plastic_coat_weight(PlasticCoatLobe l, Vec3 wi) {
    return fresnel_dielectric(fabs(wi.z), l.eta).reflectance * l.specular_weight;
}

INLINE DeltaSample plastic_coat_sample(PlasticCoatLobe l, Vec3 wi, Float u) {
    Rgb weight = scale(l.specular, fresnel_dielectric(fabs(wi.z), l.eta).reflectance);
    DeltaSample s = {mirror_direction(wi), select3(wi.z > 0.0f, weight, vec3_all(ZERO)), ONE};
    return s;
}

#endif
