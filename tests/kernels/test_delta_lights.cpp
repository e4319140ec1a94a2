// Lights that no ray can hit: point, spot and directional, against their formulas in double precision.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "support/light_models.h"

namespace wavelobe::test {
namespace {

constexpr double half_ulp = 0x1p-24;
const glm::vec3 intensity{1.0F, 2.0F, 4.0F};

Light light_at(const glm::vec3& position, const glm::vec3& direction = {0.0F, 0.0F, 1.0F}) {
    Light light{};
    light.radiance = {packed(intensity), WAVELOBE_NONE};
    light.position = packed(position);
    light.edge1 = packed(direction);
    return light;
}

LightBuffers buffers_of(const std::vector<Light>& lights) {
    LightBuffers buffers;
    buffers.lights = lights;
    return buffers;
}

std::vector<glm::vec3> random_points(double size, std::size_t count) {
    std::mt19937 random(31);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = uniform(random);
        const double y = uniform(random);
        points.push_back(glm::vec3(glm::dvec3(x, y, uniform(random)) * size));
    }
    return points;
}

std::vector<LightQuery> queries_at(const std::vector<glm::vec3>& points, Uint32 light = 0) {
    std::vector<LightQuery> queries;
    for (const glm::vec3& p : points) {
        LightQuery q;
        q.light = light;
        q.reference = p;
        queries.push_back(q);
    }
    return queries;
}

// intensity * share(direction of travel) / distance^2, and the parts every delta light at a place has.
void expect_intensity(const LightName& name, const Light& light, double size,
                      const std::function<double(const glm::dvec3&)>& share, double share_slack) {
    LightProbe probe(name, buffers_of({Light{}, light}));
    const std::vector<LightQuery> queries = queries_at(random_points(size, 4096), 1);
    const std::vector<LightResult> samples = probe.sample(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const LightResult& s = samples[i];
        const glm::dvec3 way = unpacked(light.position) - glm::dvec3(queries[i].reference);
        const double d = glm::length(way);
        const glm::dvec3 expected = glm::dvec3(intensity) * (share(-way / d) / (d * d));
        const double scale = glm::length(glm::dvec3(intensity)) / (d * d);
        // The difference of the points loses digits where they are close.
        const double rounding = 8.0 * half_ulp * (1.0 + size / d);
        ASSERT_LE(glm::length(glm::dvec3(s.radiance) - expected), (rounding + share_slack) * scale) << i;
        ASSERT_LE(glm::length(glm::dvec3(s.direction) - way / d), rounding) << i;
        ASSERT_EQ(s.point, glm::vec3(unpacked(light.position)));
        ASSERT_EQ(s.error, glm::vec3(0.0F));
        ASSERT_EQ(s.normal, glm::vec3(0.0F));
        ASSERT_EQ(s.pdf, 1.0F);
        ASSERT_EQ(s.delta, 1.0F);
        ASSERT_EQ(s.at_infinity, 0.0F);
    }
}

const LightName point{"point", Reach::DELTA};
const LightName spot{"spot", Reach::DELTA};
const LightName directional{"directional", Reach::DELTA};

TEST(PointLight, FallsWithTheSquareOfTheDistance) {
    for (double size : {1e-6, 1.0, 1e6}) {
        expect_intensity(point, light_at(glm::vec3(glm::dvec3(0.3, -0.2, 0.1) * size)), size,
                         [](const glm::dvec3&) { return 1.0; }, 0.0);
    }
}

TEST(PointLight, IsDarkAtItsOwnPlace) {
    LightProbe probe(point, buffers_of({light_at(glm::vec3(1.0F))}));
    const LightResult s = probe.sample(queries_at({glm::vec3(1.0F)})).front();
    EXPECT_EQ(s.radiance, glm::vec3(0.0F));
    EXPECT_EQ(glm::length(s.direction), 1.0F);
}

TEST(SpotLight, FallsLinearlyBetweenItsAngles) {
    const glm::vec3 axis(glm::normalize(glm::dvec3(0.2, -0.7, 0.4)));
    for (auto [beam, cutoff] : {std::pair{0.35, 0.5}, {0.0, 1.5}, {0.3, 0.3}, {1.0, 3.0}, {0.02, 0.03}}) {
        Light light = light_at({0.3F, -0.2F, 0.1F}, axis);
        light.cos_beam = static_cast<float>(std::cos(beam));
        light.cos_cutoff = static_cast<float>(std::cos(cutoff));
        // The angles that the rounded cosines stand for.
        const double from = std::acos(static_cast<double>(light.cos_beam));
        const double to = std::acos(static_cast<double>(light.cos_cutoff));
        const glm::dvec3 along = glm::normalize(glm::dvec3(axis));
        const auto share = [&](const glm::dvec3& d) {
            const double angle = std::atan2(glm::length(glm::cross(d, along)), glm::dot(d, along));
            if (angle <= from) return 1.0;
            return angle < to ? (to - angle) / (to - from) : 0.0;
        };
        // Rounding of the angles against the width of the fall; a step has none, and no sample is near it here.
        const double slack = to > from ? 16.0 * half_ulp * (1.0 + to) / (to - from) : 0.0;
        expect_intensity(spot, light, 1.0, share, slack);
    }
}

// The recommended falloff of KHR_lights_punctual.
TEST(SpotLight, FallsSmoothlyWhereAskedTo) {
    const glm::vec3 axis(glm::normalize(glm::dvec3(0.2, -0.7, 0.4)));
    for (auto [beam, cutoff] : {std::pair{0.35, 0.5}, {0.0, 1.5}, {1.0, 1.4}}) {
        Light light = light_at({0.3F, -0.2F, 0.1F}, axis);
        light.cos_beam = static_cast<float>(std::cos(beam));
        light.cos_cutoff = static_cast<float>(std::cos(cutoff));
        light.smooth_cone = 1;
        const auto inner = static_cast<double>(light.cos_beam);
        const auto outer = static_cast<double>(light.cos_cutoff);
        const glm::dvec3 along = glm::normalize(glm::dvec3(axis));
        const auto share = [&](const glm::dvec3& d) {
            const double ramp = std::clamp((glm::dot(d, along) - outer) / (inner - outer), 0.0, 1.0);
            return ramp * ramp;
        };
        expect_intensity(spot, light, 1.0, share, 32.0 * half_ulp / (inner - outer));
    }
}

// Khronos's recommended window on top of the square of the distance.
TEST(PointLight, EndsAtItsRange) {
    Light light = light_at(glm::vec3(0.0F));
    light.inverse_range = 0.5F;
    LightProbe probe(point, buffers_of({Light{}, light}));
    for (const double d : {0.25, 1.0, 1.75, 1.999, 2.001, 10.0}) {
        const LightResult s = probe.sample(queries_at({glm::vec3(static_cast<float>(d), 0.0F, 0.0F)}, 1)).front();
        const double window = std::max(1.0 - std::pow(d / 2.0, 4.0), 0.0);
        EXPECT_NEAR(static_cast<double>(s.radiance.y), 2.0 * window / (d * d), 1e-6 * (1.0 + 1.0 / (d * d))) << d;
    }
}

// Values of Mitsuba 3.9.1 (scalar_rgb, Emitter::sample_direction): from (1, 2, 3) towards (2, 1, -1), beam 20 and cutoff
// 30 degrees.
TEST(SpotLight, AgreesWithMitsuba) {
    Light light = light_at({1.0F, 2.0F, 3.0F}, glm::vec3(glm::normalize(glm::dvec3(1.0, -1.0, -4.0))));
    light.cos_beam = static_cast<float>(std::cos(20.0 * std::numbers::pi / 180.0));
    light.cos_cutoff = static_cast<float>(std::cos(30.0 * std::numbers::pi / 180.0));
    const std::vector<std::pair<glm::vec3, double>> values = {{{2.5F, 0.5F, -3.0F}, 0.02469135},
                                                              {{4.0F, 2.5F, -1.0F}, 0.0007943},
                                                              {{4.5F, 0.5F, -1.0F}, 0.01203442},
                                                              {{2.0F, -1.0F, -1.0F}, 0.02920439},
                                                              {{3.2F, 3.0F, -1.0F}, 0.0007719}};
    std::vector<glm::vec3> points;
    for (const auto& [reference, value] : values) points.push_back(reference);
    const std::vector<LightResult> samples = LightProbe(spot, buffers_of({light})).sample(queries_at(points));
    for (std::size_t i = 0; i < values.size(); ++i) {
        // Eight printed digits, and in both programs the rounding of an angle against the ten degrees of the fall.
        const double d = glm::distance(glm::dvec3(values[i].first), unpacked(light.position));
        const double slack = 1e-8 + 16.0 * half_ulp / (10.0 * std::numbers::pi / 180.0) / (d * d);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(samples[i].radiance[k] / intensity[k], values[i].second, slack) << i;
        }
    }
}

TEST(DirectionalLight, IsTheSameEverywhere) {
    const glm::vec3 travels(glm::normalize(glm::dvec3(0.2, -0.7, 0.4)));
    LightProbe probe(directional, buffers_of({light_at({}, travels)}));
    for (const LightResult& s : probe.sample(queries_at(random_points(1e6, 64)))) {
        EXPECT_EQ(s.direction, -travels);
        EXPECT_EQ(s.radiance, intensity);
        EXPECT_EQ(s.pdf, 1.0F);
        EXPECT_EQ(s.delta, 1.0F);
        EXPECT_EQ(s.at_infinity, 1.0F);
        EXPECT_EQ(s.normal, glm::vec3(0.0F));
    }
}

// Every light of the list that is a delta light.
TEST(DeltaLights, SameBitsAtEveryWidth) {
    Light light = light_at({0.3F, -0.2F, 0.1F}, glm::vec3(glm::normalize(glm::dvec3(0.2, -0.7, 0.4))));
    light.cos_beam = 0.9F;
    light.cos_cutoff = 0.3F;
    const std::vector<LightQuery> queries = queries_at(random_points(1.0, 4096));
    for (const LightName& name : light_names()) {
        if (name.reach != Reach::DELTA) continue;
        // One light, whose record is read once, and two, whose records are gathered.
        const std::vector<LightResult> wide = LightProbe(name, buffers_of({light})).sample(queries);
        const std::size_t bytes = wide.size() * sizeof(LightResult);
        EXPECT_EQ(std::memcmp(LightProbe(name, buffers_of({light, light})).sample(queries).data(), wide.data(), bytes), 0);
        for (int lanes : {1, 8}) {
            LightProbe narrow(name, buffers_of({light}), lanes);
            EXPECT_EQ(std::memcmp(narrow.sample(queries).data(), wide.data(), bytes), 0) << name.name << " " << lanes;
        }
    }
}

}  // namespace
}  // namespace wavelobe::test
