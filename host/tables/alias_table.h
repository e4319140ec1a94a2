// Alias tables: choice among n weighted rows in constant time.
// Walker 1974, "New fast method for generating discrete random numbers with arbitrary frequency distributions";
// Vose 1991, "A linear algorithm for generating random numbers with a given distribution".
#pragma once

#include <span>
#include <vector>

#include "shared/lights.h"

namespace wavelobe {

// One row a weight: row i is chosen with probability weights[i] / sum. A row of weight zero is never chosen, unless all
// are zero: then all rows are equally likely. The same weights give the same table.
// Throws std::invalid_argument if a weight is negative or not finite, or the sum overflows.
std::vector<AliasEntry> build_alias_table(std::span<const double> weights);

}  // namespace wavelobe
