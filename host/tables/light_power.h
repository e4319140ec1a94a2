// Emitted power of lights, W, weighted by luminance.
// Lights at infinity count with what passes through the scene's bounding sphere (Pharr, Jakob, Humphreys, "Physically
// Based Rendering", "Light Sources").
#pragma once

#include "scene/scene.h"

namespace wavelobe {

// Rec. 709 luminance.
double luminance(const Rgb& color);

// Mean luminance of a texture's source, or the luminance of a constant.
double mean_luminance(const Parameter& radiance);

// `scene_radius`: of the scene's bounding sphere, m. Throws InputError for a picture build_environment_table refuses.
double emitter_power(const Emitter& emitter, double scene_radius);

// An environment whose luminance integrates to this over all directions, W / m^2.
double environment_power(double luminance_integral, double scene_radius);

}  // namespace wavelobe
