// Whether the camera looks for emitters with rays of their own (EMISSION_RAYS, kernels/stages/generate.h).
#pragma once

#include "render/flatten.h"

namespace wavelobe {

// Rays a sample: several where much of the film is covered in part by emitters of few pixels; else none. Of the whole film, whatever window of it
// is rendered. What the scene holds beside its lights must be known.
int emission_rays(const DeviceScene& scene, const Camera& camera, const Film& film);

// By how much the emission that one camera ray finds differs from its mean: the mean over the film's pixels of c (1 - c), of which emitters
// of few pixels cover the share c. Without regard to what hides them.
double partial_coverage(const DeviceScene& scene, const Camera& camera, const Film& film);

}  // namespace wavelobe
