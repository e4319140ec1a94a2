// Every lobe at the corners of its parameters and of the sphere: finite, positive, and the same bits at every lane width.
#include <array>
#include <bit>
#include <cmath>

#include "support/random_lobes.h"

namespace wavelobe::test {
namespace {

using Robustness = LobeTest;

constexpr std::size_t query_count = 100000;

std::vector<LobeQuery> sampling_queries(Random& random, std::size_t materials) {
    std::vector<LobeQuery> queries;
    for (std::size_t i = 0; i < query_count; ++i) {
        queries.push_back({static_cast<std::uint32_t>(random.uniform() * static_cast<float>(materials)),
                           corner_direction(random, static_cast<std::size_t>(random.uniform() * 6000.0F)),
                           {corner_number(random), corner_number(random), corner_number(random)}});
    }
    return queries;
}

// Half of the pairs are mirror images, where lobes peak; some go straight through.
std::vector<LobeQuery> eval_queries(Random& random, std::size_t materials) {
    std::vector<LobeQuery> queries = sampling_queries(random, materials);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        LobeQuery& q = queries[i];
        q.wo_or_u = corner_direction(random, i);
        if (i % 4 == 0) q.wo_or_u = mirrored(q.wi);
        if (i % 8 == 1) q.wo_or_u = -q.wi;
    }
    return queries;
}

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// `where` is called for what fails alone: to print every one of the queries took longer than all else.
template <class Where>
void expect_sane(const LobeResult& r, const Where& where) {
    ASSERT_TRUE(finite(r.f_cos) && std::isfinite(r.pdf)) << where();
    ASSERT_TRUE(r.f_cos.x >= 0.0F && r.f_cos.y >= 0.0F && r.f_cos.z >= 0.0F && r.pdf >= 0.0F) << where();
}

TEST_P(Robustness, SamplesAreFiniteUnitDirections) {
    Random random(1);
    const std::vector<Material> m = random_materials(random, 2000);
    const std::vector<LobeQuery> queries = sampling_queries(random, m.size());
    const std::vector<LobeSample> samples = probe().sample(m, queries);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const LobeSample& s = samples[i];
        const auto where = [&] { return describe(queries[i], m[queries[i].material]); };
        expect_sane(s.value, where);
        if (HasFatalFailure()) return;
        ASSERT_TRUE(finite(s.wo)) << where();
        ASSERT_TRUE(std::isfinite(s.weight) && s.weight >= 0.0F) << where();
        ASSERT_TRUE(std::isfinite(s.eta) && s.eta > 0.0F) << where();
        if (s.wo == glm::vec3{0.0F}) continue;
        // Refraction out of a dense medium scales the rounding error of |wi| by the squared index.
        ASSERT_NEAR(glm::length(glm::dvec3(s.wo)), 1.0, 40 * 0x1p-24) << where();
    }
}

TEST_P(Robustness, ValuesAreFinite) {
    if (GetParam().delta) return;  // never evaluated
    Random random(2);
    const std::vector<Material> m = random_materials(random, 2000);
    const std::vector<LobeQuery> queries = eval_queries(random, m.size());
    const std::vector<LobeResult> results = probe().eval(m, queries);
    for (std::size_t i = 0; i < results.size(); ++i) {
        expect_sane(results[i], [&] { return describe(queries[i], m[queries[i].material]); });
        if (HasFatalFailure()) return;
    }
}

template <class T>
void append_bits(std::vector<std::uint32_t>& bits, const T& value) {
    const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(T) / 4>>(value);
    bits.insert(bits.end(), words.begin(), words.end());
}

TEST_P(Robustness, SameBitsAtEveryLaneWidth) {
    Random random(3);
    const std::vector<Material> m = random_materials(random, 2000);
    const std::vector<LobeQuery> sampling = sampling_queries(random, m.size());
    const std::vector<LobeQuery> evaluation = eval_queries(random, m.size());
    std::vector<std::uint32_t> first;
    for (int lanes : {16, 8, 1}) {
        LobeProbe device_lobe = probe(lanes);
        std::vector<std::uint32_t> bits;
        for (const LobeSample& s : device_lobe.sample(m, sampling)) append_bits(bits, s);
        if (!GetParam().delta) {
            for (const LobeResult& r : device_lobe.eval(m, evaluation)) append_bits(bits, r);
        }
        if (lanes == 16) first = bits;
        EXPECT_TRUE(bits == first) << lanes << " lanes";
    }
}

INSTANTIATE_TEST_SUITE_P(All, Robustness, testing::ValuesIn(lobe_names()), lobe_test_name);

}  // namespace
}  // namespace wavelobe::test
