// Delta lobes: directions, weights and probabilities against double precision.
#include "support/lobe_test.h"

namespace wavelobe::test {
namespace {

using DeltaLobes = LobeTest;

// Random incident directions from both sides, a part of them grazing, and those along the axis.
std::vector<LobeQuery> queries_of(std::uint32_t material_count, std::size_t n) {
    Random random(1);
    std::vector<LobeQuery> queries;
    for (std::size_t i = 0; i < n; ++i) {
        glm::vec3 wi = random.direction();
        if (i % 4 == 0) wi = direction_at_height(random.log_between(1e-6F, 0.1F), 6.0 * random.uniform());
        if (i % 8 == 0) wi.z = -wi.z;
        if (i % 100 == 0) wi = {0.0F, 0.0F, i % 200 == 0 ? 1.0F : -1.0F};
        queries.push_back({static_cast<std::uint32_t>(i / 8) % material_count, wi, random.uniform3()});
    }
    return queries;
}

TEST_P(DeltaLobes, MatchDoublePrecision) {
    const std::vector<Material> m = materials();
    const std::vector<LobeQuery> queries = queries_of(static_cast<std::uint32_t>(m.size()), 40000);
    const std::vector<LobeSample> samples = probe().sample(m, queries);
    const ReferenceDelta& reference = reference_deltas().at(GetParam().name);
    std::vector<std::size_t> taken(2, 0);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const LobeQuery& q = queries[i];
        const std::vector<DeltaBranch> branches = reference(m[q.material], q.wi);
        const double first = branches[0].probability;
        // Rounding may change the choice next to the border, by as much as it changes the reflectance.
        const std::vector<DeltaBranch> moved =
            reference(m[q.material], glm::dvec3(q.wi) * glm::dvec3(1.0, 1.0, 1.0 - 0x1p-22));
        const double slack = std::abs(moved[0].probability - first) + 0x1p-22;
        const double u = q.wo_or_u.x;
        if (branches.size() > 1 && std::abs(u - first) < slack) continue;
        const std::size_t choice = branches.size() > 1 && u >= first ? 1 : 0;
        ++taken[choice];
        const DeltaBranch& b = branches[choice];
        const std::string where = parameters()[q.material].name + ", wi " + testing::PrintToString(q.wi.z);
        for (int c = 0; c < 3; ++c) {
            const double slack_wo = 2.0 * std::abs(moved[choice].wo[c] - b.wo[c]);
            const double slack_weight = 2.0 * std::abs(moved[choice].weight[c] - b.weight[c]);
            ASSERT_NEAR(samples[i].wo[c], b.wo[c], slack_wo + 4 * 0x1p-24) << where;
            ASSERT_NEAR(samples[i].value.f_cos[c], b.weight[c], slack_weight + 16 * 0x1p-24 * b.weight[c]) << where;
        }
        ASSERT_NEAR(samples[i].eta, b.eta, 0x1p-23 * b.eta) << where;
    }
    EXPECT_GT(taken[0], queries.size() / 100);
}

// Frequencies of the branches, summed with their weights, give the energy that leaves: none is made, and white interfaces
// lose none.
TEST_P(DeltaLobes, ConserveEnergy) {
    const std::vector<Material> m = materials();
    LobeProbe device_lobe = probe();
    constexpr std::size_t steps = 4096;
    for (std::uint32_t s = 0; s < m.size(); ++s) {
        for (const glm::vec3& wi : incident_directions(m[s])) {
            std::vector<LobeQuery> queries(steps);
            for (std::size_t i = 0; i < steps; ++i) {
                queries[i] = {s, wi, {(static_cast<float>(i) + 0.5F) / static_cast<float>(steps), 0.0F, 0.0F}};
            }
            glm::dvec3 sum{0.0};
            for (const LobeSample& sample : device_lobe.sample(m, queries)) {
                sum += glm::dvec3(sample.value.f_cos) * static_cast<double>(sample.eta * sample.eta);
            }
            const glm::dvec3 energy = sum / static_cast<double>(steps);
            for (int c = 0; c < 3; ++c) EXPECT_LE(energy[c], 1.0 + 8 * 0x1p-24) << parameters()[s].name;
            if (is_transmissive(m[s]) && m[s].specular.value.x == 1.0F && m[s].transmission.value.x == 1.0F) {
                EXPECT_NEAR(energy.x, 1.0, 8 * 0x1p-24) << parameters()[s].name;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, DeltaLobes, testing::ValuesIn(delta_lobes()), lobe_test_name);

}  // namespace
}  // namespace wavelobe::test
