// Every light of lights/lights.def against what is known of it without its code: sampling against density, density against
// hits, irradiance against closed forms and quadrature.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "support/light_models.h"
#include "support/light_probe.h"
#include "support/statistics.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

constexpr double half_ulp = 0x1p-24;
constexpr float below_one = 0x1.fffffep-1F;

std::vector<LightName> reachable_lights() {
    std::vector<LightName> names = light_names();
    std::erase_if(names, [](const LightName& light) { return light.reach == Reach::DELTA; });
    return names;
}

std::vector<LightName> surface_lights() {
    std::vector<LightName> names = light_names();
    std::erase_if(names, [](const LightName& light) { return light.reach != Reach::SURFACE; });
    return names;
}

std::vector<LightName> flat_lights() {
    std::vector<LightName> names = surface_lights();
    std::erase_if(names, [](const LightName& light) { return light.name == "sphere" || light.name == "cylinder"; });
    return names;
}

std::string name_of(const testing::TestParamInfo<LightName>& light) { return light.param.name; }

LightQuery query_of(const LightModel& m, const glm::vec2& random = {}) {
    LightQuery q;
    q.light = m.light;
    q.reference = m.reference;
    q.random = random;
    return q;
}

std::vector<LightQuery> random_queries(const LightModel& m, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<LightQuery> queries;
    for (std::size_t i = 0; i < count; ++i) {
        const float u1 = std::min(uniform(random), below_one);
        queries.push_back(query_of(m, {u1, std::min(uniform(random), below_one)}));
    }
    return queries;
}

// The density of a direction: that of all places of the light it meets.
std::vector<double> density(LightProbe& probe, const LightModel& m, const std::vector<glm::dvec3>& directions) {
    std::vector<LightQuery> queries;
    std::vector<std::size_t> owner;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (const LightHit& hit : m.hits(m.reference, directions[i])) {
            LightQuery q = query_of(m);
            q.direction = glm::vec3(directions[i]);
            q.t = static_cast<float>(hit.t);
            q.normal = glm::vec3(hit.normal);
            queries.push_back(q);
            owner.push_back(i);
        }
    }
    std::vector<double> sum(directions.size(), 0.0);
    const std::vector<float> values = queries.empty() ? std::vector<float>() : probe.pdf(queries);
    for (std::size_t i = 0; i < values.size(); ++i) sum[owner[i]] += static_cast<double>(values[i]);
    return sum;
}

class Lights : public testing::TestWithParam<LightName> {
protected:
    Lights() : all_(light_models(GetParam().name)) {}

    LightProbe probe(int lanes = 16) const { return {GetParam(), all_.buffers, lanes}; }

    LightModels all_;
};

class SurfaceLights : public Lights {};
class FlatLights : public Lights {};

// Rings of equal solid angle about the direction to the light, out to where its bounding sphere ends; all around the
// reference point where that lies within the sphere.
SphereGrid grid_of(const LightModel& m) {
    constexpr int rings = 20;
    const glm::dvec3 way = m.center - glm::dvec3(m.reference);
    const double sine = 1.02 * m.radius / glm::length(way);
    const bool within = m.radius <= 0.0 || sine >= 1.0;
    // 1 - cos without cancellation.
    const double height = within ? 2.0 : sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
    std::vector<double> heights;
    for (int i = 0; i <= rings; ++i) heights.push_back(height * i / rings);
    return {within ? glm::dvec3(0.0, 0.0, 1.0) : way, heights, rings};
}

TEST_P(Lights, SamplesFollowTheDensity) {
    LightProbe light = probe();
    const std::size_t count = 1 << 18;
    const double threshold = sidak_threshold(0.01, 200);
    Claim claim("Light transport", std::string(GetParam().name) + " light: samples against the density, chi-square",
                "Sidak threshold / p");
    for (const LightModel& m : all_.models) {
        SCOPED_TRACE(m.label);
        const SphereGrid grid = grid_of(m);
        // A share of 1e-6 is a quarter of a sample.
        const std::vector<double> expected = integrate_cells(
            grid, [&](const std::vector<glm::dvec3>& d) { return density(light, m, d); }, 1, 1e-6);
        double total = 0.0;
        for (double e : expected) total += e;
        // A cylinder's density rises like 1 / sqrt towards its outline, where the quadrature converges slowly; smaller cells
        // bring its sum ever closer to one, and the irradiance below knows it to 1e-6.
        EXPECT_NEAR(total, 1.0, GetParam().name == "cylinder" ? 3e-3 : 1e-3) << "the density integrates to one";

        std::vector<double> counts(grid.size() + 1, 0.0);
        for (const LightResult& s : light.sample(random_queries(m, count, 5))) {
            ++counts[grid.index_of(glm::normalize(glm::dvec3(s.direction)))];
        }
        EXPECT_EQ(counts.back(), 0.0) << "directions beyond the light";
        counts.pop_back();
        std::vector<double> scaled;
        for (double e : expected) scaled.push_back(e * static_cast<double>(count) / total);
        const ChiSquareResult result = chi_square_test(counts, scaled);
        claim.observe(threshold / result.p_value, [&] {
            return m.label + ": chi-square " + std::to_string(result.statistic) + " of " + std::to_string(result.degrees_of_freedom);
        });
        EXPECT_GT(result.degrees_of_freedom, 10);
    }
    claim.count(count * all_.models.size());
    claim.at_most(1.0);
}

// The density of a hit is the one that sampling reports for it.
TEST_P(Lights, HitsHaveTheDensityOfTheirSample) {
    LightProbe light = probe();
    for (const LightModel& m : all_.models) {
        SCOPED_TRACE(m.label);
        std::vector<LightQuery> queries = random_queries(m, 1 << 14, 6);
        const std::vector<LightResult> samples = light.sample(queries);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            queries[i].direction = samples[i].direction;
            queries[i].t = samples[i].at_infinity > 0.0F ? std::numeric_limits<float>::infinity()
                                                         : glm::distance(samples[i].point, m.reference);
            queries[i].normal = samples[i].normal;
        }
        const std::vector<float> pdf = light.pdf(queries);
        std::size_t strays = 0;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const double relative = std::abs(static_cast<double>(pdf[i]) / static_cast<double>(samples[i].pdf) - 1.0);
            // The cosine's rounding weighs more the more the surface is seen edge-on; towards the poles of a picture the
            // sine's does.
            const double cosine = std::abs(glm::dot(glm::dvec3(samples[i].direction), glm::dvec3(samples[i].normal)));
            const double slack = GetParam().reach == Reach::SURFACE ? 16.0 * half_ulp * (1.0 + 1.0 / cosine) : 1e-4;
            strays += relative <= slack ? 0 : 1;
        }
        // Rounding moves a direction into the neighbouring cell of a picture once in about a hundred thousand times.
        EXPECT_LE(strays, GetParam().name == "envmap" ? 3U : 0U);
    }
}

// The irradiance that samples estimate, with random numbers from a lattice, shifted at random a number of times: their
// spread tells the error of their mean.
TEST_P(Lights, SamplesEstimateTheIrradiance) {
    LightProbe light = probe();
    constexpr int shifts = 32;
    constexpr int points = 1 << 13;
    for (const LightModel& m : all_.models) {
        SCOPED_TRACE(m.label);
        std::mt19937 random(12);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        std::vector<LightQuery> queries;
        for (int shift = 0; shift < shifts; ++shift) {
            const glm::dvec2 offset(uniform(random), uniform(random));
            for (int i = 0; i < points; ++i) {
                const glm::dvec2 u = glm::fract(offset + glm::dvec2(static_cast<double>(i) / points, i * std::numbers::phi));
                queries.push_back(query_of(m, glm::min(glm::vec2(u), glm::vec2(below_one))));
            }
        }
        const std::vector<LightResult> samples = light.sample(queries);
        glm::dvec3 mean(0.0);
        glm::dvec3 squares(0.0);
        for (int shift = 0; shift < shifts; ++shift) {
            glm::dvec3 sum(0.0);
            for (int i = 0; i < points; ++i) {
                const LightResult& s = samples[static_cast<std::size_t>(shift * points + i)];
                const double cosine = glm::dot(glm::dvec3(s.direction), glm::dvec3(m.facing));
                if (s.pdf > 0.0F && cosine > 0.0) sum += glm::dvec3(s.radiance) * (cosine / static_cast<double>(s.pdf));
            }
            const glm::dvec3 ratio = sum / (static_cast<double>(points) * m.irradiance);
            mean += ratio / static_cast<double>(shifts);
            squares += ratio * ratio / static_cast<double>(shifts);
        }
        const glm::dvec3 error = glm::sqrt(glm::max(squares - mean * mean, 0.0) / (shifts - 1.0));
        for (int k = 0; k < 3; ++k) {
            EXPECT_LT(error[k], 6e-4) << "too noisy to tell";
            // Student's t for 31 degrees of freedom and a chance of 1e-5, and a few dozen roundings.
            EXPECT_NEAR(mean[k], 1.0, 5.3 * error[k] + 32.0 * half_ulp) << "standard error " << error[k];
        }
    }
}

TEST_P(SurfaceLights, PointsLieOnTheSurfaceWithinTheirErrorBound) {
    LightProbe light = probe();
    for (const LightModel& m : all_.models) {
        SCOPED_TRACE(m.label);
        for (const LightResult& s : light.sample(random_queries(m, 1 << 14, 7))) {
            glm::dvec3 normal;
            const double distance = std::abs(m.distance(glm::dvec3(s.point), normal));
            const double bound = glm::dot(glm::abs(normal), glm::dvec3(s.error));
            ASSERT_LE(distance, bound);
            ASSERT_LE(bound, 64.0 * half_ulp * (glm::length(s.point) + glm::length(m.center)));
            ASSERT_NEAR(std::abs(glm::dot(normal, glm::dvec3(s.normal))), 1.0, 1e-6);
            // The direction leads there.
            const glm::dvec3 way = glm::dvec3(s.point) - glm::dvec3(m.reference);
            const double rounding = 16.0 * half_ulp * (1.0 + (glm::length(m.center) + glm::length(m.reference)) / glm::length(way));
            ASSERT_LE(glm::length(glm::normalize(way) - glm::dvec3(s.direction)), rounding);
            ASSERT_NEAR(glm::length(glm::dvec3(s.direction)), 1.0, 1e-6);
        }
    }
}

// On the light, in its plane, at its centre and corners, at the borders of the random numbers.
TEST_P(Lights, AreFiniteInCorners) {
    LightProbe light = probe();
    std::vector<LightQuery> queries;
    for (const LightModel& m : all_.models) {
        std::vector<glm::vec3> references{m.reference, glm::vec3(m.center)};
        for (const LightResult& s : light.sample(random_queries(m, 64, 8))) {
            references.push_back(s.point);
            references.push_back(2.0F * s.point - glm::vec3(m.center));
        }
        for (const glm::vec3& reference : references) {
            for (float u1 : {0.0F, 0x1p-32F, 0.25F, 0.5F, below_one}) {
                for (float u2 : {0.0F, 0x1p-32F, 0.25F, 0.5F, below_one}) {
                    LightQuery q = query_of(m, {u1, u2});
                    q.reference = reference;
                    queries.push_back(q);
                }
            }
        }
    }
    const std::vector<LightResult> samples = light.sample(queries);
    const auto good = [](const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const LightResult& s = samples[i];
        ASSERT_TRUE(good(s.direction) && good(s.point) && good(s.error) && good(s.normal) && good(s.radiance)) << i;
        ASSERT_NEAR(static_cast<double>(glm::length(s.direction)), 1.0, 1e-6) << i;
        ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0F) << s.pdf;
        ASSERT_TRUE(s.radiance.x >= 0.0F && s.radiance.y >= 0.0F && s.radiance.z >= 0.0F);
        ASSERT_TRUE(s.pdf > 0.0F || s.radiance == glm::vec3(0.0F)) << "light without density";
        ASSERT_EQ(s.delta, 0.0F);
        queries[i].direction = s.direction;
        queries[i].t = glm::distance(s.point, queries[i].reference);
        queries[i].normal = s.normal;
    }
    for (float pdf : light.pdf(queries)) ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0.0F) << pdf;
}

TEST_P(SurfaceLights, DarkOnTheOtherSide) {
    LightProbe light = probe();
    for (const LightModel& m : all_.models) {
        SCOPED_TRACE(m.label);
        std::vector<LightQuery> queries;
        for (const LightResult& s : light.sample(random_queries(m, 1024, 9))) {
            // Behind a point of the light, nearly on it.
            LightQuery q = query_of(m, {0.3F, 0.6F});
            q.reference = s.point - s.normal * (0.01F * glm::distance(s.point, glm::vec3(m.center)));
            queries.push_back(q);
        }
        // From inside, an outward sphere is dark altogether; other shapes may still face their back with another part.
        const bool enclosed = GetParam().name == "sphere" && m.radius > 0.0;
        for (const LightResult& s : light.sample(queries)) {
            const bool faces = glm::dot(s.direction, s.normal) < 0.0F;
            ASSERT_EQ(s.radiance == glm::vec3(0.0F), enclosed || !faces);
        }
    }
}

// What is flat does not light itself, though rounding puts a point of it on one side or the other.
TEST_P(FlatLights, DoNotLightThemselves) {
    LightProbe light = probe();
    for (const LightModel& m : all_.models) {
        SCOPED_TRACE(m.label);
        std::vector<LightQuery> queries = random_queries(m, 1 << 14, 11);
        const std::vector<LightResult> places = light.sample(random_queries(m, 1 << 14, 12));
        for (std::size_t i = 0; i < queries.size(); ++i) queries[i].reference = places[i].point;
        double sum = 0.0;
        for (const LightResult& s : light.sample(queries)) {
            const double cosine = std::abs(glm::dot(s.direction, s.normal));  // of the receiver, which is in the same plane
            if (s.pdf > 0.0F) sum += static_cast<double>(s.radiance.x) * cosine / static_cast<double>(s.pdf);
        }
        EXPECT_LT(sum / static_cast<double>(queries.size()), 1e-4 * std::numbers::pi * static_cast<double>(test_radiance.x));
    }
}

TEST_P(Lights, SameBitsAtEveryWidth) {
    std::vector<LightQuery> queries;
    for (const LightModel& m : all_.models) {
        for (const LightQuery& q : random_queries(m, 1024, 10)) queries.push_back(q);
    }
    LightProbe wide = probe();
    const std::vector<LightResult> samples = wide.sample(queries);
    std::vector<LightQuery> hits = queries;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        hits[i].direction = samples[i].direction;
        hits[i].t = glm::distance(samples[i].point, hits[i].reference);
        hits[i].normal = samples[i].normal;
    }
    const std::vector<float> pdf = wide.pdf(hits);
    for (int lanes : {1, 8}) {
        LightProbe narrow = probe(lanes);
        EXPECT_EQ(std::memcmp(narrow.sample(queries).data(), samples.data(), samples.size() * sizeof(LightResult)), 0) << lanes;
        EXPECT_EQ(std::memcmp(narrow.pdf(hits).data(), pdf.data(), pdf.size() * sizeof(float)), 0) << lanes;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Lights, testing::ValuesIn(reachable_lights()), name_of);
INSTANTIATE_TEST_SUITE_P(All, SurfaceLights, testing::ValuesIn(surface_lights()), name_of);
INSTANTIATE_TEST_SUITE_P(All, FlatLights, testing::ValuesIn(flat_lights()), name_of);

}  // namespace
}  // namespace wavelobe::test
