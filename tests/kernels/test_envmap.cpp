// The environment picture: where it lies, what it radiates, and how its table is sampled.
#include <gtest/gtest.h>

#include "support/light_models.h"
#include "support/statistics.h"

namespace wavelobe::test {
namespace {

using std::numbers::pi;

constexpr double half_ulp = 0x1p-24;
const LightName envmap{"envmap", Reach::ENVIRONMENT};

LightProbe envmap_probe(const EnvironmentReference& reference, const glm::vec3& scale = glm::vec3(1.0F)) {
    LightBuffers buffers;
    set_environment(buffers, reference, scale);
    return {envmap, buffers};
}

LightQuery along(const glm::vec3& direction) {
    LightQuery q;
    q.direction = direction;
    return q;
}

std::vector<LightQuery> random_queries(std::size_t count) {
    std::mt19937 random(21);
    std::uniform_int_distribution<int> bits(0, (1 << 24) - 1);
    std::vector<LightQuery> queries(count);
    for (LightQuery& q : queries) {
        const auto u1 = static_cast<float>(bits(random));
        q.random = glm::vec2(u1, static_cast<float>(bits(random))) * 0x1p-24F;
    }
    return queries;
}

std::vector<glm::vec3> random_directions(std::size_t count) {
    std::mt19937 random(22);
    std::normal_distribution<double> normal;
    std::vector<glm::vec3> directions;
    for (std::size_t i = 0; i < count; ++i) {
        // Ever closer to the axis of the picture's own space.
        const double flatness = std::pow(0.5, static_cast<double>(i % 20));
        const glm::dvec3 d(normal(random) * flatness, normal(random), normal(random) * flatness);
        directions.push_back(glm::vec3(glm::normalize(d)));
    }
    return directions;
}

double largest_texel(const Bitmap& image) {
    return static_cast<double>(*std::max_element(image.rgb.begin(), image.rgb.end()));
}

// Values of Mitsuba 3.9.1 (scalar_rgb, Emitter::eval) for this picture, to_world and scale.
TEST(Envmap, AgreesWithMitsuba) {
    EnvironmentReference reference;
    reference.image = {.width = 4, .height = 5, .rgb = {}};
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 4; ++x) {
            for (int value : {(x * x + 3 * y) % 7, (2 * x + y * y) % 5, (x + y) % 3}) {
                reference.image.rgb.push_back(static_cast<float>(value));
            }
        }
    }
    reference.to_world = glm::transpose(glm::dmat3(0.83511746, -0.48051518, 0.26773864,  //
                                                   0.544331, 0.7920395, -0.2763641,      //
                                                   -0.079262406, 0.37653494, 0.92300534));
    const std::vector<std::pair<glm::vec3, glm::dvec3>> values = {
        {{0.618984044F, -0.775099695F, 0.126803905F}, {8.519803, 3.594323, 2.668844}},
        {{-0.749576807F, -0.597593486F, -0.284634173F}, {4.905653, 1.813039, 2.777123}},
        {{-0.914149046F, -0.1049615F, -0.391554028F}, {4.166261, 1.396879, 3.268347}},
        {{0.992154419F, 0.0674135461F, -0.105285659F}, {5.017354, 4.351209, 1.352216}},
        {{-0.21973224F, -0.521855295F, -0.824248016F}, {6.793637, 1.264351, 0.6064205}},
        {{-0.587883651F, 0.724992573F, -0.358857244F}, {8.091953, 3.072325, 1.947302}},
        {{0.978624701F, -0.204155073F, 0.024788091F}, {5.138525, 3.276022, 1.470196}},
        {{0.901240945F, 0.317806184F, -0.294557303F}, {6.152907, 5.474163, 1.75943}},
    };
    std::vector<LightQuery> queries;
    for (const auto& [direction, value] : values) queries.push_back(along(direction));
    const std::vector<glm::vec3> found = envmap_probe(reference, glm::vec3(2.0F)).radiance(queries);
    for (std::size_t i = 0; i < values.size(); ++i) {
        // Both programs round; the last printed digit is the sixth.
        EXPECT_LE(glm::length(glm::dvec3(found[i]) - values[i].second), 3e-5) << i;
    }
}

// Lanes without a path hold anything; what they read must lie on the picture.
TEST(Envmap, AnythingHasAPlaceOnThePicture) {
    const EnvironmentReference reference = random_environment(16, 9);
    LightProbe light = envmap_probe(reference);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const float values[] = {0.0F, -0.0F, 1.0F, -1.0F, 1e-45F, 3e38F, -3e38F, infinite, -infinite, nan};
    std::vector<LightQuery> queries;
    for (const float x : values) {
        for (const float y : values) {
            for (const float z : values) queries.push_back(along({x, y, z}));
        }
    }
    const double largest = largest_texel(reference.image) * (1.0 + 8.0 * half_ulp);
    for (const glm::vec3& radiance : light.radiance(queries)) {
        for (int c = 0; c < 3; ++c) EXPECT_FALSE(std::abs(static_cast<double>(radiance[c])) > largest);
    }
    EXPECT_EQ(light.pdf(queries).size(), queries.size());
}

TEST(Envmap, RadianceIsBilinearUpToThePoles) {
    EnvironmentReference reference = random_environment(16, 9);
    reference.to_world = glm::dmat3(1.0);
    LightProbe light = envmap_probe(reference);
    const std::vector<glm::vec3> directions = random_directions(1 << 14);
    std::vector<LightQuery> queries;
    for (const glm::vec3& d : directions) queries.push_back(along(d));
    const std::vector<glm::vec3> radiance = light.radiance(queries);
    const std::vector<float> pdf = light.pdf(queries);
    const EnvironmentTable table = build_environment_table(reference.image);
    std::size_t at_borders = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const glm::dvec3 d(directions[i]);
        const auto place = reference.place(d);
        // A few roundings of u and v, each worth up to the largest texel's difference a cell.
        const double slack = 8.0 * half_ulp * largest_texel(reference.image) * (16.0 + 9.0);
        ASSERT_LE(glm::length(glm::dvec3(radiance[i]) - reference.radiance(place)), slack) << i;

        const double column = place.u * 16.0 - 0.5 + (place.u * 16.0 < 0.5 ? 16.0 : 0.0);
        const double row = std::min(place.v * 8.0, 7.999999);
        const auto cell = static_cast<std::size_t>(row) * 16 + static_cast<std::size_t>(column);
        const double expected =
            static_cast<double>(table.density[cell]) / (2.0 * pi * pi * std::hypot(d.x, d.z) / glm::length(d));
        const bool same = std::abs(static_cast<double>(pdf[i]) / expected - 1.0) <= 16.0 * half_ulp;
        at_borders += same ? 0 : 1;
        if (!same) {
            const double distance = std::min(std::abs(column - std::round(column)), std::abs(row - std::round(row)));
            ASSERT_LE(distance, 16.0 * 16.0 * half_ulp) << i;
        }
    }
    EXPECT_LE(at_borders, 8U);
}

TEST(Envmap, IsFiniteAtThePoles) {
    EnvironmentReference reference = random_environment(16, 9);
    reference.to_world = glm::dmat3(1.0);
    LightProbe light = envmap_probe(reference);
    const std::vector<LightQuery> queries = {along({0.0F, 1.0F, 0.0F}), along({0.0F, -1.0F, 0.0F}), along({-0.0F, 1.0F, -0.0F}),
                                             along({1e-30F, 1.0F, 0.0F}), along({0.0F, -1.0F, 1e-42F})};
    const std::vector<glm::vec3> radiance = light.radiance(queries);
    const std::vector<float> pdf = light.pdf(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        EXPECT_TRUE(std::isfinite(radiance[i].x) && radiance[i].x >= 0.0F) << i;
        EXPECT_TRUE(std::isfinite(pdf[i] * pdf[i]) && pdf[i] > 0.0F) << i << ": its square is finite too";
    }
}

// The integral of the bilinear picture over all directions in closed form.
TEST(Envmap, EnergyIsThatOfThePicture) {
    const EnvironmentReference reference = random_environment(8, 6);
    glm::dvec3 expected(0.0);
    for (int row = 0; row < 5; ++row) {
        const double step = pi / 5.0;
        const double top = row * step;
        const double bottom = top + step;
        // Integrals of sin, and of sin times the share of the lower row.
        const double whole = std::cos(top) - std::cos(bottom);
        const double lower = (std::sin(bottom) - std::sin(top)) / step - std::cos(bottom);
        for (int column = 0; column < 8; ++column) {
            expected += 2.0 * pi / 8.0 * ((whole - lower) * reference.texel(column, row) + lower * reference.texel(column, row + 1));
        }
    }
    // By quadrature of the look-up, a midpoint rule on every cell ...
    LightProbe light = envmap_probe(reference);
    constexpr int steps = 64;
    std::vector<LightQuery> queries;
    std::vector<double> measure;
    for (int x = 0; x < 8 * steps; ++x) {
        for (int y = 0; y < 5 * steps; ++y) {
            const double v = (y + 0.5) / (5 * steps);
            queries.push_back(along(glm::vec3(reference.direction({(x + 0.5) / (8 * steps), v}))));
            measure.push_back(2.0 * pi * pi * std::sin(pi * v) / (8 * steps * 5 * steps));
        }
    }
    glm::dvec3 sum(0.0);
    const std::vector<glm::vec3> radiance = light.radiance(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) sum += glm::dvec3(radiance[i]) * measure[i];
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(sum[k] / expected[k], 1.0, pi * pi / (24.0 * 25.0 * steps * steps) * 2.0) << "midpoint rule";
    }
    // ... and by sampling.
    glm::dvec3 mean(0.0);
    glm::dvec3 squares(0.0);
    const std::vector<LightResult> samples = light.sample(random_queries(1 << 20));
    for (const LightResult& s : samples) {
        const glm::dvec3 value = glm::dvec3(s.radiance) / static_cast<double>(s.pdf) / expected;
        mean += value / static_cast<double>(samples.size());
        squares += value * value / static_cast<double>(samples.size());
    }
    for (int k = 0; k < 3; ++k) {
        const double error = std::sqrt((squares[k] - mean[k] * mean[k]) / static_cast<double>(samples.size()));
        EXPECT_LT(error, 1e-3);
        EXPECT_GT(normal_p_value((mean[k] - 1.0) / error), sidak_threshold(0.01, 3)) << mean[k];
    }
}

TEST(Envmap, EvenPictureIsTheConstantLight) {
    EnvironmentReference reference = random_environment(7, 4);
    for (float& value : reference.image.rgb) value = 1.0F;
    const std::vector<LightResult> samples = envmap_probe(reference, test_radiance).sample(random_queries(1 << 16));
    double mean = 0.0;
    for (const LightResult& s : samples) {
        ASSERT_LE(glm::distance(s.radiance, test_radiance), 4.0F * static_cast<float>(half_ulp) * glm::length(test_radiance));
        mean += 1.0 / static_cast<double>(s.pdf) / static_cast<double>(samples.size());
    }
    EXPECT_NEAR(mean / (4.0 * pi), 1.0, 1e-2) << "solid angle of all directions";
}

// Cells are drawn as often as the table's density says, and each is filled evenly.
void expect_cells(const EnvironmentReference& reference, std::size_t count) {
    const auto columns = static_cast<std::size_t>(reference.image.width);
    const auto rows = static_cast<std::size_t>(reference.image.height - 1);
    const EnvironmentTable table = build_environment_table(reference.image);
    std::vector<double> cells(columns * rows, 0.0);
    std::vector<double> inside(8 * 8, 0.0);
    for (const LightResult& s : envmap_probe(reference).sample(random_queries(count))) {
        const auto place = reference.place(glm::dvec3(s.direction));
        double x = place.u * static_cast<double>(columns) - 0.5;
        if (x < 0.0) x += static_cast<double>(columns);
        const double y = std::min(place.v * static_cast<double>(rows), static_cast<double>(rows) - 1e-9);
        ++cells[static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x)];
        ++inside[static_cast<std::size_t>(8.0 * (y - std::floor(y))) * 8 + static_cast<std::size_t>(8.0 * (x - std::floor(x)))];
    }
    std::vector<double> expected;
    for (float density : table.density) {
        expected.push_back(static_cast<double>(density) * static_cast<double>(count) / static_cast<double>(cells.size()));
    }
    const ChiSquareResult by_cell = chi_square_test(cells, expected);
    EXPECT_GT(by_cell.p_value, sidak_threshold(0.01, 6)) << by_cell.statistic << " of " << by_cell.degrees_of_freedom;
    const ChiSquareResult within = chi_square_test(inside, std::vector<double>(64, static_cast<double>(count) / 64.0));
    EXPECT_GT(within.p_value, sidak_threshold(0.01, 6)) << within.statistic << " of " << within.degrees_of_freedom;
}

TEST(Envmap, SamplesFollowTheTable) {
    EnvironmentReference reference = random_environment(8, 6);
    expect_cells(reference, 1 << 20);
    // Nearly all light from a single texel.
    for (std::size_t i = 0; i < reference.image.rgb.size(); ++i) reference.image.rgb[i] *= i / 3 == 20 ? 1000.0F : 1e-3F;
    expect_cells(reference, 1 << 18);
}

TEST(Envmap, LargePicturesKeepDigitsForThePlaceWithinACell) {
    EnvironmentReference reference = random_environment(4096, 33);
    reference.to_world = glm::dmat3(1.0);
    expect_cells(reference, 1 << 20);
}

}  // namespace
}  // namespace wavelobe::test
