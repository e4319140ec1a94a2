// Every lobe against double precision at random configurations, the hard corners among them.
//
// Float directions decide how well a narrow or grazing lobe can be known at all: the value of GGX of roughness 1e-4 changes
// by a thousandth when a component of a direction is rounded. The measure is therefore the mixed error (Higham 2002,
// "Accuracy and Stability of Numerical Algorithms", section 1.5): how many roundings of the result and of each input
// component together explain the difference. The plain relative error stands beside it where the problem is well
// conditioned.
#include "support/random_lobes.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

constexpr double rounding = 0x1p-24;
// Exponentials below the smallest normal float are zero; factors up to the peak of the smoothest lobe follow.
constexpr double least = 1e12 * 0x1p-126;

constexpr double mixed_bound = 32.0;  // roundings: some thirty operations in a row

// Roundings that a lobe's parameters allow: most lobes as many as above, those with exponentials of large numbers more.
double value_bound(const std::vector<LobeParameters>& sets) {
    double bound = 0.0;
    for (const LobeParameters& set : sets) bound = std::max(bound, set.rounding);
    return bound;
}

struct Configurations {
    std::vector<Material> materials;
    std::vector<LobeQuery> queries;
};

// The kernels treat smoother surfaces as this smooth.
Material as_rendered(Material m) {
    m.alpha_u.value = std::max(m.alpha_u.value, 1e-4F);
    m.alpha_v.value = std::max(m.alpha_v.value, 1e-4F);
    return m;
}

// From normal incidence to a millionth of the horizon, from both sides.
glm::vec3 incident(Random& random) {
    const float u = random.uniform();
    const double side = random.uniform() < 0.75F ? 1.0 : -1.0;
    const double phi = 6.3 * static_cast<double>(random.uniform());
    if (u < 0.05F) return {0.0F, 0.0F, side};
    if (u < 0.35F) return direction_at_height(side * static_cast<double>(random.log_between(1e-6F, 0.1F)), phi);
    return direction_at_height(side * static_cast<double>(random.between(1e-3F, 1.0F)), phi);
}

// Half of the outgoing directions are the lobe's own samples, which find narrow lobes.
Configurations configurations(LobeProbe& probe, const std::vector<LobeParameters>& sets, std::size_t n) {
    Random random(11);
    Configurations c;
    for (std::size_t i = 0; i < n / 20; ++i) c.materials.push_back(random_material(random, sets, true));
    for (std::size_t i = 0; i < n; ++i) {
        c.queries.push_back({static_cast<std::uint32_t>(i % c.materials.size()), incident(random), random.uniform3()});
    }
    const std::vector<LobeSample> samples = probe.sample(c.materials, c.queries);
    for (std::size_t i = 0; i < n; ++i) {
        const bool own = i % 2 == 0 && samples[i].wo != glm::vec3{0.0F};
        c.queries[i].wo_or_u = own ? samples[i].wo : incident(random);
    }
    for (Material& m : c.materials) m = as_rendered(m);
    return c;
}

double plain_error(double found, double exact) { return std::max(std::abs(found - exact) - least, 0.0) / exact; }

// In roundings of the result and of the inputs; `slack`: the change of the result when every input is off by two.
double mixed_error(double found, double exact, double slack) {
    const double excess = std::max(std::abs(found - exact) - least, 0.0);
    return excess == 0.0 ? 0.0 : excess / (rounding * exact + 0.5 * slack);
}

using LobePrecision = LobeTest;

TEST_P(LobePrecision, ValueAndDensity) {
    const std::string& name = GetParam().name;
    LobeProbe device_lobe = probe();
    const ReferenceEval& reference = reference_evals().at(name);
    Claim value("Appearance", name + ": value, mixed error", "roundings");
    Claim pdf("Appearance", name + ": density, mixed error", "roundings");
    Claim plain("Appearance", name + ": value and density, well conditioned", "relative");
    const Configurations c = configurations(device_lobe, parameters(), quick_or_full<std::size_t>(100000, 1000000));
    const std::vector<LobeResult> results = device_lobe.eval(c.materials, c.queries);
    std::size_t lit = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const LobeQuery& q = c.queries[i];
        const Material& m = c.materials[q.material];
        const ReferenceValue exact = reference(m, q.wi, q.wo_or_u);
        const ReferenceValue slack = input_slack(reference, m, q.wi, q.wo_or_u);
        const auto where = [&] { return describe(q, m); };
        lit += exact.pdf > 0.0;
        pdf.observe(mixed_error(results[i].pdf, exact.pdf, slack.pdf), where);
        const bool steady = slack.pdf <= 8.0 * rounding * exact.pdf && exact.pdf > 1e-20;
        if (steady) plain.observe(plain_error(results[i].pdf, exact.pdf), where);
        for (int k = 0; k < 3; ++k) {
            value.observe(mixed_error(results[i].f_cos[k], exact.f_cos[k], slack.f_cos[k]), where);
            const bool same = slack.f_cos[k] <= 8.0 * rounding * exact.f_cos[k] && exact.f_cos[k] > 1e-20;
            if (same) plain.observe(plain_error(results[i].f_cos[k], exact.f_cos[k]), where);
        }
    }
    EXPECT_GT(lit, results.size() / 10) << "most configurations are dark";
    value.count(results.size());
    pdf.count(results.size());
    const double bound = value_bound(parameters());
    value.at_most(bound);
    pdf.at_most(mixed_bound);
    plain.at_most(2.0 * bound * rounding);
}

// Throughput over value: what a path is multiplied by when the lobe continues it.
TEST_P(LobePrecision, SampleWeight) {
    const std::string& name = GetParam().name;
    LobeProbe device_lobe = probe();
    const ReferenceEval& reference = reference_evals().at(name);
    Claim weight("Appearance", name + ": weight of a sample, mixed error", "roundings");
    Random random(12);
    std::vector<Material> materials;
    std::vector<LobeQuery> queries;
    const auto n = quick_or_full<std::size_t>(100000, 1000000);
    for (std::size_t i = 0; i < n / 20; ++i) {
        materials.push_back(as_rendered(random_material(random, parameters(), !GetParam().delta)));
    }
    for (std::size_t i = 0; i < n; ++i) {
        const glm::vec3 u{corner_number(random), corner_number(random), corner_number(random)};
        queries.push_back({static_cast<std::uint32_t>(i % materials.size()), incident(random), u});
    }
    const std::vector<LobeSample> samples = device_lobe.sample(materials, queries);
    const auto ratio = [&](const Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
        ReferenceValue v = reference(m, wi, wo);
        if (v.pdf > 0.0) v.f_cos /= v.pdf;
        return v;
    };
    for (std::size_t i = 0; i < n; ++i) {
        const LobeSample& s = samples[i];
        if (s.wo == glm::vec3{0.0F} || s.value.pdf == 0.0F) continue;
        const Material& m = materials[queries[i].material];
        const ReferenceValue exact = ratio(m, queries[i].wi, s.wo);
        const ReferenceValue slack = input_slack(ratio, m, queries[i].wi, s.wo);
        for (int k = 0; k < 3; ++k) {
            const double found = static_cast<double>(s.value.f_cos[k]) / static_cast<double>(s.value.pdf);
            weight.observe(mixed_error(found, exact.f_cos[k], slack.f_cos[k]),
                           [&] { return describe({0, queries[i].wi, s.wo}, m); });
        }
    }
    weight.at_most(value_bound(parameters()));
}

INSTANTIATE_TEST_SUITE_P(All, LobePrecision, testing::ValuesIn(evaluated_lobes()), lobe_test_name);

using DeltaPrecision = LobeTest;

TEST_P(DeltaPrecision, DirectionAndWeight) {
    const std::string& name = GetParam().name;
    LobeProbe device_lobe = probe();
    const ReferenceDelta& reference = reference_deltas().at(name);
    Claim direction("Appearance", name + ": direction, mixed error", "roundings");
    Claim weight("Appearance", name + ": weight, mixed error", "roundings");
    Claim index("Appearance", name + ": relative index crossed", "relative");
    Random random(13);
    std::vector<Material> materials;
    std::vector<LobeQuery> queries;
    const auto n = quick_or_full<std::size_t>(100000, 1000000);
    for (std::size_t i = 0; i < n / 20; ++i) materials.push_back(random_material(random, parameters(), !GetParam().delta));
    for (std::size_t i = 0; i < n; ++i) {
        queries.push_back({static_cast<std::uint32_t>(i % materials.size()), incident(random), random.uniform3()});
    }
    const std::vector<LobeSample> samples = device_lobe.sample(materials, queries);
    for (std::size_t i = 0; i < n; ++i) {
        const LobeQuery& q = queries[i];
        const Material& m = materials[q.material];
        const glm::dvec3 wi{q.wi};
        const std::vector<DeltaBranch> branches = reference(m, wi);
        const double u = q.wo_or_u.x;
        std::size_t chosen = 0;
        double below = 0.0;
        while (chosen + 1 < branches.size() && u >= below + branches[chosen].probability) below += branches[chosen++].probability;
        // Too close to the border to say which.
        const double to_border = std::min(std::abs(u - below), std::abs(u - below - branches[chosen].probability));
        if (branches.size() > 1 && to_border < 1e-5) continue;
        const DeltaBranch& exact = branches[chosen];
        const auto where = [&] { return describe(q, m); };
        if (glm::all(glm::equal(exact.weight, glm::dvec3(0.0)))) {
            weight.observe(glm::length(glm::dvec3(samples[i].value.f_cos)), where);
            continue;
        }
        double slack = 0.0;
        glm::dvec3 weight_slack{0.0};
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 moved = wi;
            moved[k] *= 1.0 + 2.0 * rounding;
            const DeltaBranch other = reference(m, moved)[chosen];
            slack += glm::length(other.wo - exact.wo);
            weight_slack += glm::abs(other.weight - exact.weight);
        }
        direction.observe(mixed_error(glm::length(glm::dvec3(samples[i].wo) - exact.wo), 0.0, slack + 2.0 * rounding), where);
        for (int k = 0; k < 3; ++k) {
            weight.observe(mixed_error(samples[i].value.f_cos[k], exact.weight[k], weight_slack[k]), where);
        }
        index.observe(std::abs(static_cast<double>(samples[i].eta) / exact.eta - 1.0), where);
    }
    direction.at_most(mixed_bound);
    weight.at_most(mixed_bound);
    index.at_most(2.0 * rounding);
}

INSTANTIATE_TEST_SUITE_P(All, DeltaPrecision, testing::ValuesIn(delta_lobes()), lobe_test_name);

}  // namespace
}  // namespace wavelobe::test
