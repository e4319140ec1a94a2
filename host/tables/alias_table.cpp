#include "tables/alias_table.h"

#include <cmath>
#include <stdexcept>

namespace wavelobe {
namespace {

double checked_sum(std::span<const double> weights) {
    double sum = 0.0;
    for (double weight : weights) {
        if (!(weight >= 0.0)) throw std::invalid_argument("a weight of an alias table is negative or not a number");
        sum += weight;
    }
    if (!std::isfinite(sum)) throw std::invalid_argument("the weights of an alias table have no finite sum");
    return sum;
}

}  // namespace

std::vector<AliasEntry> build_alias_table(std::span<const double> weights) {
    const std::size_t n = weights.size();
    const double sum = checked_sum(weights);
    std::vector<AliasEntry> table(n);
    for (std::size_t i = 0; i < n; ++i) table[i] = {1.0F, static_cast<Uint32>(i)};
    if (sum <= 0.0) return table;

    // Shares in units of the average. Those below one are filled up from those above.
    std::vector<double> share(n);
    std::vector<std::size_t> below;
    std::vector<std::size_t> above;
    for (std::size_t i = 0; i < n; ++i) {
        share[i] = weights[i] / sum * static_cast<double>(n);
        (share[i] < 1.0 ? below : above).push_back(i);
    }
    while (!below.empty() && !above.empty()) {
        const std::size_t poor = below.back();
        const std::size_t rich = above.back();
        below.pop_back();
        table[poor] = {static_cast<float>(share[poor]), static_cast<Uint32>(rich)};
        share[rich] = (share[rich] + share[poor]) - 1.0;
        if (share[rich] < 1.0) {
            above.pop_back();
            below.push_back(rich);
        }
    }
    // Rows that are left are full but for rounding, and keep their threshold of one.
    return table;
}

}  // namespace wavelobe
