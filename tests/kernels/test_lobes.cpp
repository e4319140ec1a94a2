// Glossy and diffuse lobes: values, densities and samples agree with each other and with double precision.
#include <limits>

#include <fmt/format.h>

#include "support/lobe_test.h"
#include "support/statistics.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

using Lobes = LobeTest;

// Chance that a family of statistical tests of one lobe fails by luck.
constexpr double significance = 1e-3;

// The rational fit of Beckmann masking exceeds the exact one by up to 0.0032, for each direction.
constexpr double beckmann_fit_excess = 1.0032 * 1.0032;

struct Case {
    const LobeParameters* parameters;
    std::uint32_t material;
    glm::vec3 wi;
    SphereGrid grid;
};

// Broad lobes over the whole sphere; narrow ones over caps about the directions of ideal reflection and refraction.
std::vector<Case> cases(const std::vector<LobeParameters>& sets) {
    std::vector<Case> result;
    for (std::uint32_t s = 0; s < sets.size(); ++s) {
        const Material& m = sets[s].material;
        for (const glm::vec3& wi : incident_directions(m)) {
            if (sets[s].width > 0.02) {
                result.push_back({&sets[s], s, wi, SphereGrid::whole(32)});
                continue;
            }
            // Closer to the horizon narrow lobes are ridges thinner than float directions tell apart.
            if (std::abs(wi.z) < 0.1F) continue;
            result.push_back({&sets[s], s, wi, SphereGrid::cap(mirrored(wi), sets[s].width, 12)});
            if (!is_transmissive(m)) continue;
            const std::vector<DeltaBranch> branches = reference_dielectric(m, wi);
            if (branches[1].probability > 0.0) {
                result.push_back({&sets[s], s, wi, SphereGrid::cap(branches[1].wo, sets[s].width, 12)});
            }
        }
    }
    return result;
}

// Energy carried, radiance scaling taken back: transmitted radiance is divided by the squared relative index.
double energy(const Material& m, const glm::vec3& wi, const glm::vec3& wo, const glm::vec3& f_cos) {
    const double value = mean(f_cos);
    if (!is_transmissive(m) || wi.z * wo.z >= 0.0F) return value;
    const double eta = relative_index(m);
    return wi.z > 0.0F ? value * eta * eta : value / (eta * eta);
}

// Integrals of pdf and energy over the cells.
std::vector<double> integrate(LobeProbe& probe, const std::vector<Material>& materials, const Case& c, double tolerance) {
    const BatchFunction function = [&](const std::vector<glm::dvec3>& directions) {
        std::vector<LobeQuery> queries;
        queries.reserve(directions.size());
        for (const glm::dvec3& d : directions) queries.push_back({c.material, c.wi, d});
        const std::vector<LobeResult> results = probe.eval(materials, queries);
        std::vector<double> values;
        values.reserve(2 * directions.size());
        for (std::size_t i = 0; i < results.size(); ++i) {
            values.push_back(results[i].pdf);
            values.push_back(energy(materials[c.material], c.wi, queries[i].wo_or_u, results[i].f_cos));
        }
        return values;
    };
    return integrate_cells(c.grid, function, 2, tolerance);
}

std::string describe(const Case& c) { return c.parameters->name + ", wi " + to_text(c.wi); }

struct Tally {
    std::vector<double> counts;  // of each cell; the last bin holds failed samples and those outside the grid
    double mean_weight = 0.0;    // of the samples within the grid
    double standard_error = 0.0;
};

constexpr std::size_t sample_count = 200000;
// Of a cell. What is not judged need not converge.
const double quadrature_tolerance = values_are_judged() ? quick_or_full(1e-7, 1e-9) : std::numeric_limits<double>::infinity();

Tally tally(LobeProbe& probe, const std::vector<Material>& materials, const Case& c, Random& random) {
    std::vector<LobeQuery> queries(sample_count);
    for (LobeQuery& q : queries) q = {c.material, c.wi, random.uniform3()};
    Tally result{std::vector<double>(c.grid.size() + 1, 0.0)};
    double sum = 0.0;
    double sum_of_squares = 0.0;
    for (const LobeSample& s : probe.sample(materials, queries)) {
        const bool failed = s.wo == glm::vec3{0.0F};
        const std::size_t bin = failed ? c.grid.size() : c.grid.index_of(s.wo);
        result.counts[bin] += 1.0;
        if (bin == c.grid.size()) continue;
        EXPECT_GT(s.value.pdf, 0.0F) << describe(c);
        const double weight = energy(materials[c.material], c.wi, s.wo, s.value.f_cos) / static_cast<double>(s.value.pdf);
        sum += weight;
        sum_of_squares += weight * weight;
    }
    result.mean_weight = sum / sample_count;
    const double variance = std::max(sum_of_squares / sample_count - result.mean_weight * result.mean_weight, 0.0);
    result.standard_error = std::sqrt(variance / sample_count);
    return result;
}

// Samples against the density; their weights against the integral of the value; and this against what arrives.
TEST_P(Lobes, SamplesFollowTheDensityAndConserveEnergy) {
    const std::vector<Case> all = cases(parameters());
    const std::vector<Material> m = materials();
    LobeProbe device_lobe = probe();
    Random random(1);
    const double threshold = sidak_threshold(significance, 2 * all.size());
    const std::string& name = GetParam().name;
    Claim density("Appearance", name + ": samples against the density, chi-square", "Sidak threshold / p");
    Claim weights("Appearance", name + ": mean weight of samples against the integral of the value", "Sidak threshold / p");
    for (const Case& c : all) {
        const Tally found = tally(device_lobe, m, c, random);
        const std::vector<double> integrals = integrate(device_lobe, m, c, quadrature_tolerance);
        const double quadrature = quadrature_tolerance * static_cast<double>(c.grid.size());
        std::vector<double> expected(c.grid.size() + 1, 0.0);
        double total_pdf = 0.0;
        double albedo = 0.0;
        for (std::size_t i = 0; i < c.grid.size(); ++i) {
            expected[i] = integrals[2 * i] * sample_count;
            total_pdf += integrals[2 * i];
            albedo += integrals[2 * i + 1];
        }
        EXPECT_LE(total_pdf, 1.0 + quadrature) << describe(c);
        expected.back() = std::max(1.0 - total_pdf, 0.0) * sample_count;
        const double fit = m[c.material].flags & MATERIAL_BECKMANN ? beckmann_fit_excess : 1.0;
        EXPECT_LE(albedo, fit + quadrature) << describe(c);

        const ChiSquareResult chi = chi_square_test(found.counts, expected);
        density.observe(threshold / chi.p_value, [&] {
            return fmt::format("{}: chi-square {:.4g} of {} degrees of freedom; failed samples {}, expected {:.6g}", describe(c),
                               chi.statistic, chi.degrees_of_freedom, found.counts.back(), expected.back());
        });
        // Quadrature error and rounding of the weights, besides the sampling error.
        const double excess = std::max(std::abs(found.mean_weight - albedo) - quadrature - 1e-6, 0.0);
        const double p = excess == 0.0 ? 1.0 : normal_p_value(excess / found.standard_error);
        weights.observe(threshold / p, [&] {
            return fmt::format("{}: mean weight {:.6g} +- {:.2g}, integral {:.6g}", describe(c), found.mean_weight,
                               found.standard_error, albedo);
        });
    }
    for (Claim* claim : {&density, &weights}) {
        claim->count(sample_count * all.size());
        claim->at_most(1.0);
    }
}

// wi and wo over the whole sphere, a part of wi grazing.
std::vector<LobeQuery> random_pairs(Random& random, std::uint32_t material_count, std::size_t n) {
    std::vector<LobeQuery> queries;
    for (std::size_t i = 0; i < n; ++i) {
        glm::vec3 wi = random.direction();
        if (i % 4 == 0) wi = direction_at_height(random.log_between(1e-6F, 0.1F), 6.0 * random.uniform());
        queries.push_back({static_cast<std::uint32_t>(i) % material_count, wi, random.direction()});
    }
    return queries;
}

// Pairs that random directions meet, and pairs from the lobe's own samples, which find narrow lobes.
std::vector<LobeQuery> pairs(LobeProbe& device_lobe, const std::vector<Material>& m, std::uint32_t seed) {
    Random random(seed);
    const auto count = static_cast<std::uint32_t>(m.size());
    std::vector<LobeQuery> result = random_pairs(random, count, 20000);
    std::vector<LobeQuery> sampling = random_pairs(random, count, 20000);
    for (LobeQuery& q : sampling) q.wo_or_u = random.uniform3();
    const std::vector<LobeSample> samples = device_lobe.sample(m, sampling);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].wo != glm::vec3{0.0F}) result.push_back({sampling[i].material, sampling[i].wi, samples[i].wo});
    }
    return result;
}

TEST_P(Lobes, MatchDoublePrecision) {
    const std::vector<Material> m = materials();
    LobeProbe device_lobe = probe();
    const std::vector<LobeQuery> queries = pairs(device_lobe, m, 2);
    const std::vector<LobeResult> results = device_lobe.eval(m, queries);
    const ReferenceEval& reference = reference_evals().at(GetParam().name);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const LobeQuery& q = queries[i];
        const Material& material = m[q.material];
        const double rounding = parameters()[q.material].rounding * 0x1p-24;
        const ReferenceValue expected = reference(material, q.wi, q.wo_or_u);
        const ReferenceValue slack = input_slack(reference, material, q.wi, q.wo_or_u);
        const std::string where = parameters()[q.material].name + ", wi " + to_text(q.wi) + ", wo " +
                                  to_text(q.wo_or_u);
        // Exponentials below the smallest normal float are zero; factors up to the peak of the smoothest lobe follow.
        const double least = 1e12 * 0x1p-126;
        ASSERT_NEAR(results[i].pdf, expected.pdf, rounding * expected.pdf + 4.0 * slack.pdf + least) << where;
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(results[i].f_cos[c], expected.f_cos[c],
                        rounding * expected.f_cos[c] + 4.0 * slack.f_cos[c] + least)
                << where;
        }
    }
}

TEST_P(Lobes, AreReciprocal) {
    const std::vector<Material> m = materials();
    LobeProbe device_lobe = probe();
    std::vector<LobeQuery> queries = pairs(device_lobe, m, 3);
    std::erase_if(queries, [&](const LobeQuery& q) {
        return q.wi.z == 0.0F || q.wo_or_u.z == 0.0F || !parameters()[q.material].reciprocal;
    });
    if (queries.empty()) return;
    std::vector<LobeQuery> swapped = queries;
    for (LobeQuery& q : swapped) std::swap(q.wi, q.wo_or_u);
    const std::vector<LobeResult> there = device_lobe.eval(m, queries);
    const std::vector<LobeResult> back = device_lobe.eval(m, swapped);
    const ReferenceEval& reference = reference_evals().at(GetParam().name);
    std::size_t lit = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const LobeQuery& q = queries[i];
        const Material& material = m[q.material];
        // f / n^2 is symmetric, n the index of the side the radiance arrives at the viewer from: Veach 1997, section 5.2.
        const double eta_squared = relative_index(material) * relative_index(material);
        const bool transmits = is_transmissive(material) && q.wi.z * q.wo_or_u.z < 0.0F;
        const double scale_there = (transmits && q.wi.z < 0.0F ? 1.0 / eta_squared : 1.0) / std::abs(q.wo_or_u.z);
        const double scale_back = (transmits && q.wo_or_u.z < 0.0F ? 1.0 / eta_squared : 1.0) / std::abs(q.wi.z);
        const double a = mean(there[i].f_cos) * scale_there;
        const double b = mean(back[i].f_cos) * scale_back;
        const double slack = mean(input_slack(reference, material, q.wi, q.wo_or_u).f_cos) * scale_there +
                             mean(input_slack(reference, material, q.wo_or_u, q.wi).f_cos) * scale_back;
        ASSERT_NEAR(a, b, 64 * 0x1p-24 * a + 4.0 * slack + 1e12 * 0x1p-126 * (scale_there + scale_back))
            << parameters()[q.material].name << ", wi " << q.wi.z << ", wo " << q.wo_or_u.z;
        lit += a > 0.0;
    }
    EXPECT_GT(lit, queries.size() / 10);
}

TEST_P(Lobes, OneSidedLobesAreDarkFromBehind) {
    const std::vector<Material> m = materials();
    LobeProbe device_lobe = probe();
    Random random(4);
    for (std::uint32_t s = 0; s < m.size(); ++s) {
        if (is_transmissive(m[s])) continue;
        std::vector<LobeQuery> queries;
        for (int i = 0; i < 1000; ++i) {
            glm::vec3 below = random.direction();
            below.z = -std::abs(below.z);
            queries.push_back({s, below, random.direction()});
            queries.push_back({s, random.direction(), below});
        }
        for (const LobeResult& r : device_lobe.eval(m, queries)) {
            ASSERT_EQ(r.f_cos, glm::vec3{0.0F});
            ASSERT_EQ(r.pdf, 0.0F);
        }
        for (std::size_t i = 0; i < queries.size(); i += 2) queries[i].wo_or_u = random.uniform3();
        const std::vector<LobeSample> samples = device_lobe.sample(m, queries);
        for (std::size_t i = 0; i < samples.size(); i += 2) ASSERT_EQ(samples[i].wo, glm::vec3{0.0F});
    }
}

INSTANTIATE_TEST_SUITE_P(All, Lobes, testing::ValuesIn(evaluated_lobes()), lobe_test_name);

}  // namespace
}  // namespace wavelobe::test
