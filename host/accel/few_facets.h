// The facets of a scene of few triangles (kernels/shapes/few_facets.h).
#pragma once

#include "accel/few_triangles.h"

namespace wavelobe {

// Enters facets, their corners and numbers into a set that has its triangles, vertices and summary. Two triangles make a facet where
// they are the halves of a parallelogram, to the rounding of its corners.
void add_facets(FewTriangleSet& few);

}  // namespace wavelobe
