// What a dielectric surface does to diffuse light: table entries, not paths, and so in double.
#pragma once

#include <array>

#include "scene/scene.h"
#include "shared/materials.h"

namespace wavelobe {

// Reflectance of a smooth surface for diffuse light that arrives from the side of index 1 (`eta`: the other side's).
double diffuse_fresnel(double eta);

struct RoughSurface {
    std::array<float, ROUGH_TRANSMITTANCE_STEPS> transmittance;  // from outside, at cosines from 0 to 1 in equal steps
    float internal_reflectance;                                  // for diffuse light from inside
};

// A surface of microfacets of index `eta` (inside over outside), by single scattering. The internal reflectance is the mean
// over ROUGH_TRANSMITTANCE_STEPS cosines, both ends included, by which Mitsuba defines its rough plastic.
RoughSurface rough_surface(double eta, double alpha, Distribution distribution);

}  // namespace wavelobe
