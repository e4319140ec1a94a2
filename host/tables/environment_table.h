// The sampling table of an environment picture; lights/envmap.h says where the picture lies on the sphere.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/lights.h"

namespace wavelobe {

struct EnvironmentTable {
    Uint32 cell_columns = 0;  // the picture's width
    Uint32 cell_rows = 0;     // its height - 1: rows of texels reach from pole to pole
    // Running sums of the probabilities of each row's cells, from 0 to 1, row by row, then those of the rows:
    // cell_rows * (cell_columns + 1) + cell_rows + 1 numbers.
    std::vector<float> sums;
    std::vector<float> density;   // a cell: its probability, as these sums have it, over its share of the unit square
    double luminance_integral = 0.0;  // over the sphere of directions, W / m^2, before any scale
};

// Pictures of fewer than three rows with their last row repeated up to three, others as they are: so reads Mitsuba 3.
Bitmap with_three_rows(Bitmap image);

// A cell's probability follows the mean luminance of its corners times its solid angle; a black picture is sampled evenly.
// Throws InputError naming `name` and the first texel that is negative or not finite, and for fewer than two rows.
//
// `compensated`: probabilities follow what a cell has above the average radiance over the sphere, and cells below it have
// none, for estimators that weigh these samples against others that reach every direction. Karlik, Sik, Vevoda, Skrivan,
// Krivanek 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling".
EnvironmentTable build_environment_table(const Bitmap& image, const std::string& name = {}, bool compensated = false);

}  // namespace wavelobe
