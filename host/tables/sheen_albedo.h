// The directional albedo of glTF's sheen, by which it takes light from what is below it.
#pragma once

#include "shared/materials.h"

namespace wavelobe {

// Of white sheen (kernels/bsdf/sheen.h) seen at that cosine, before any division by itself; `alpha` is that of its fibres. Midpoint rule.
double sheen_directional_albedo(double cosine, double alpha, int cosines, int azimuths);

SheenAlbedo sheen_albedo();

}  // namespace wavelobe
