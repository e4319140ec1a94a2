#include "tables/environment_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "scene/fault.h"
#include "tables/luminance.h"

namespace wavelobe {
namespace {

using std::numbers::pi;

Bitmap picture(int width, int height, const std::function<Rgb(int, int)>& color) {
    Bitmap image{.width = width, .height = height, .rgb = {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Rgb c = color(x, y);
            image.rgb.insert(image.rgb.end(), {c.r, c.g, c.b});
        }
    }
    return image;
}

Bitmap random_picture(int width, int height) {
    std::mt19937 random(7);
    std::exponential_distribution<float> exponential(1.0F);
    return picture(width, height, [&](int, int) {
        return Rgb(exponential(random), exponential(random), exponential(random));
    });
}

// Probability of each cell: chance of its row times its chance within the row.
std::vector<double> cell_probabilities(const EnvironmentTable& table) {
    const std::size_t rows = table.cell_rows;
    const std::size_t columns = table.cell_columns;
    const auto chances = [&](std::size_t first, std::size_t count) {
        EXPECT_EQ(table.sums[first], 0.0F);
        EXPECT_EQ(table.sums[first + count], 1.0F);
        std::vector<double> p;
        for (std::size_t i = first; i < first + count; ++i) {
            EXPECT_LE(table.sums[i], table.sums[i + 1]);
            p.push_back(static_cast<double>(table.sums[i + 1]) - static_cast<double>(table.sums[i]));
        }
        return p;
    };
    const std::vector<double> row_chance = chances(rows * (columns + 1), rows);
    std::vector<double> result;
    for (std::size_t y = 0; y < rows; ++y) {
        for (double p : chances(y * (columns + 1), columns)) result.push_back(p * row_chance[y]);
    }
    return result;
}

TEST(EnvironmentTable, CellsFollowLuminanceTimesSolidAngle) {
    const Bitmap image = random_picture(13, 9);
    const EnvironmentTable table = build_environment_table(image);
    ASSERT_EQ(table.cell_columns, 13U);
    ASSERT_EQ(table.cell_rows, 8U);
    ASSERT_EQ(table.sums.size(), 8U * 14U + 9U);
    ASSERT_EQ(table.density.size(), 8U * 13U);

    const auto texel = [&](std::size_t x, std::size_t y) {
        const std::size_t i = 3 * (y * 13 + x % 13);
        return luminance({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    };
    std::vector<double> weight;
    for (std::size_t y = 0; y < 8; ++y) {
        const double solid_angle =
            2.0 * pi / 13.0 * (std::cos(pi * static_cast<double>(y) / 8.0) - std::cos(pi * static_cast<double>(y + 1) / 8.0));
        for (std::size_t x = 0; x < 13; ++x) {
            weight.push_back(solid_angle * 0.25 * (texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)));
        }
    }
    const double sum = std::accumulate(weight.begin(), weight.end(), 0.0);
    const std::vector<double> p = cell_probabilities(table);
    for (std::size_t i = 0; i < weight.size(); ++i) {
        // Sums are rounded to multiples of 2^-24 at the most.
        EXPECT_NEAR(p[i], weight[i] / sum, 2.0 * 0x1p-24) << "cell " << i;
        // The density is the probability with which a cell is drawn, over the cell's share of the unit square.
        EXPECT_NEAR(static_cast<double>(table.density[i]), p[i] * 8.0 * 13.0, 1e-6 * p[i] * 8.0 * 13.0) << "cell " << i;
    }
    EXPECT_NEAR(table.luminance_integral, sum, 1e-12 * sum);
}

TEST(EnvironmentTable, EvenPictureHasTheSolidAngleOfTheSphere) {
    for (int height : {2, 3, 7, 64}) {
        const EnvironmentTable table = build_environment_table(picture(16, height, [](int, int) { return Rgb(1.0F); }));
        EXPECT_NEAR(table.luminance_integral, 4.0 * pi, 1e-12);
    }
}

TEST(EnvironmentTable, OneBrightTexelLightsItsFourCellsOnly) {
    const EnvironmentTable table =
        build_environment_table(picture(8, 6, [](int x, int y) { return Rgb(x == 0 && y == 2 ? 5.0F : 0.0F); }));
    for (std::size_t y = 0; y < 5; ++y) {
        for (std::size_t x = 0; x < 8; ++x) {
            const bool touches = (x == 0 || x == 7) && (y == 1 || y == 2);
            EXPECT_EQ(table.density[y * 8 + x] > 0.0F, touches) << x << ", " << y;
        }
    }
}

TEST(EnvironmentTable, BlackPictureIsSampledEvenlyOverTheSphere) {
    const EnvironmentTable table = build_environment_table(picture(8, 5, [](int, int) { return Rgb(0.0F); }));
    EXPECT_EQ(table.luminance_integral, 0.0);
    const std::vector<double> p = cell_probabilities(table);
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
    const double polar = 0.5 * (1.0 - std::cos(pi / 4.0)) / 8.0;
    EXPECT_NEAR(p[0], polar, 1e-7);
    EXPECT_NEAR(p[31], polar, 1e-7);
}

TEST(EnvironmentTable, RefusesTexelsThatAreNoRadiance) {
    for (float bad : {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Bitmap image = random_picture(4, 4);
        image.rgb[3 * (4 * 2 + 1) + 1] = bad;
        try {
            build_environment_table(image, "sky.exr");
            FAIL() << bad << " was taken";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("sky.exr"), std::string::npos);
            EXPECT_NE(std::string(error.what()).find("texel (1, 2)"), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(build_environment_table(Bitmap{}), InputError);
    EXPECT_THROW(build_environment_table(random_picture(4, 1)), InputError);
}

TEST(EnvironmentTable, RepeatsTheLastRowOfFlatPictures) {
    const Bitmap two = with_three_rows(picture(2, 2, [](int, int y) { return Rgb(static_cast<float>(y)); }));
    ASSERT_EQ(two.height, 3);
    const std::vector<float> expected = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    EXPECT_EQ(two.rgb, expected);
    EXPECT_EQ(with_three_rows(random_picture(3, 1)).height, 3);
    EXPECT_EQ(with_three_rows(random_picture(3, 4)).height, 4);
}

// Cells follow what they have above the average over the sphere; an even picture stays as it is.
TEST(EnvironmentTable, CompensatedLeavesOutWhatIsBelowAverage) {
    const Bitmap image = random_picture(16, 9);
    const std::vector<double> plain = cell_probabilities(build_environment_table(image));
    const std::vector<double> rest = cell_probabilities(build_environment_table(image, {}, true));
    std::vector<double> expected(plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const double top = std::cos(pi * static_cast<double>(i / 16) / 8.0);
        const double bottom = std::cos(pi * static_cast<double>(i / 16 + 1) / 8.0);
        expected[i] = std::max(plain[i] - 0.5 * (top - bottom) / 16.0, 0.0);
    }
    const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(rest[i], expected[i] / sum, 1e-6);
    const Bitmap even = picture(16, 9, [](int, int) { return Rgb(2.0F); });
    EXPECT_EQ(build_environment_table(even, {}, true).density, build_environment_table(even).density);
}

TEST(Luminance, OfColours) { EXPECT_NEAR(luminance({1.0F, 2.0F, 3.0F}), 0.212671 + 2 * 0.715160 + 3 * 0.072169, 1e-12); }

TEST(Luminance, OfTexturesIsTheirMean) {
    Parameter radiance{Rgb(2.0F), nullptr};
    EXPECT_NEAR(mean_luminance(radiance), luminance(Rgb(2.0F)), 1e-9);
    auto texture = std::make_shared<Texture>();
    texture->source = picture(2, 1, [](int x, int) { return Rgb(x == 0 ? 0.0F : 4.0F); });
    radiance.texture = texture;
    EXPECT_NEAR(mean_luminance(radiance), luminance(Rgb(2.0F)), 1e-9);
    texture->source = Checkerboard{Rgb(1.0F), Rgb(3.0F)};
    EXPECT_NEAR(mean_luminance(radiance), luminance(Rgb(2.0F)), 1e-9);
}

}  // namespace
}  // namespace wavelobe
