#include "tables/alias_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace wavelobe {
namespace {

// The probability of each row that a table stands for.
std::vector<double> probabilities(const std::vector<AliasEntry>& table) {
    const auto n = static_cast<double>(table.size());
    std::vector<double> p(table.size(), 0.0);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const auto threshold = static_cast<double>(table[i].threshold);
        p[i] += threshold / n;
        p[table[i].other] += (1.0 - threshold) / n;
    }
    return p;
}

// A row gathers the rounding of its own threshold and of every row that names it, each at most 2^-25 of an average row:
// relative to the larger of its own probability and the average, far below 1e-6.
void expect_probabilities(const std::vector<double>& weights) {
    const std::vector<AliasEntry> table = build_alias_table(weights);
    ASSERT_EQ(table.size(), weights.size());
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double average = 1.0 / static_cast<double>(weights.size());
    const std::vector<double> p = probabilities(table);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        ASSERT_GE(table[i].threshold, 0.0F);
        ASSERT_LE(table[i].threshold, 1.0F);
        ASSERT_LT(table[i].other, table.size());
        const double expected = weights[i] / sum;
        EXPECT_NEAR(p[i], expected, 1e-6 * std::max(expected, average)) << "row " << i;
        if (weights[i] <= 0.0) {
            EXPECT_EQ(p[i], 0.0) << "row " << i << " is never chosen";
        }
    }
}

TEST(AliasTable, HasTheProbabilitiesOfItsWeights) {
    expect_probabilities({1.0});
    expect_probabilities({3.0, 1.0});
    expect_probabilities({0.0, 1.0, 0.0});
    expect_probabilities({1e-30, 1.0, 1e30});
    expect_probabilities({1e-300, 3e-300, 0.0});
    expect_probabilities(std::vector<double>(1000, 0.1));
}

TEST(AliasTable, HasTheProbabilitiesOfManyRandomWeights) {
    std::mt19937_64 random(1);
    std::exponential_distribution<double> exponential(1.0);
    for (double spread : {0.5, 1.0, 6.0}) {
        std::vector<double> weights(20011);
        for (double& w : weights) w = std::pow(exponential(random), spread);
        for (std::size_t i = 0; i < weights.size(); i += 3) weights[i] = 0.0;
        expect_probabilities(weights);
    }
}

TEST(AliasTable, MixesFairlyWhenAllWeightsAreZero) {
    for (double p : probabilities(build_alias_table(std::vector<double>(5, 0.0)))) EXPECT_NEAR(p, 0.2, 1e-15);
}

TEST(AliasTable, IsEmptyWithoutWeights) { EXPECT_TRUE(build_alias_table({}).empty()); }

TEST(AliasTable, IsTheSameEveryTime) {
    std::mt19937_64 random(2);
    std::vector<double> weights(1000);
    for (double& w : weights) w = static_cast<double>(random() % 1000);
    const auto first = build_alias_table(weights);
    const auto second = build_alias_table(weights);
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].threshold, second[i].threshold);
        EXPECT_EQ(first[i].other, second[i].other);
    }
}

TEST(AliasTable, RefusesWeightsThatAreNone) {
    EXPECT_THROW(build_alias_table(std::vector<double>{1.0, -1.0}), std::invalid_argument);
    EXPECT_THROW(build_alias_table(std::vector<double>{1.0, std::nan("")}), std::invalid_argument);
    EXPECT_THROW(build_alias_table(std::vector<double>{std::numeric_limits<double>::infinity()}), std::invalid_argument);
    EXPECT_THROW(build_alias_table(std::vector<double>(4, std::numeric_limits<double>::max())), std::invalid_argument);
}

}  // namespace
}  // namespace wavelobe
