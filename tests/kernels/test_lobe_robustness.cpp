// Every lobe at the corners of its parameters and of the sphere: finite, positive, and the same bits at every lane width.
#include <array>
#include <bit>
#include <cmath>

#include "support/lobe_test.h"

namespace wavelobe::test {
namespace {

using Robustness = LobeTest;

std::vector<Material> random_materials(Random& random, std::size_t n) {
    const float etas[] = {1.0F, 1.0001F, 1.0F / 1.5F, 1.5F, 2.4F};
    const float corner_alphas[] = {0.0F, 1e-4F, 1.0F};
    const float exponents[] = {0.0F, 1e6F};
    std::vector<Material> materials;
    for (std::size_t i = 0; i < n; ++i) {
        Material m = white_material();
        const auto pick = [&](const auto& list) {
            return list[static_cast<std::size_t>(random.uniform() * static_cast<float>(std::size(list)))];
        };
        const auto colour = [&] {
            return i % 5 == 0 ? Packed3{0.0F, 1.0F, 1.0F} : Packed3{random.uniform(), random.uniform(), random.uniform()};
        };
        m.flags = static_cast<Uint32>(i) % 8;
        m.diffuse.value = colour();
        m.specular.value = colour();
        m.transmission.value = colour();
        m.eta = {pick(etas), pick(etas), 0.0F};
        m.k = {random.between(0.0F, 10.0F), 0.0F, 1.0F};
        m.alpha_u.value = i % 3 == 0 ? pick(corner_alphas) : random.log_between(1e-4F, 1.0F);
        m.alpha_v.value = i % 3 == 1 ? pick(corner_alphas) : random.log_between(1e-4F, 1.0F);
        m.exponent.value = i % 4 == 0 ? pick(exponents) : random.log_between(0.1F, 1e6F);
        m.metallic.value = i % 7 == 0 ? 1.0F : random.uniform();
        m.diffuse_fresnel_internal = random.between(0.0F, 0.95F);
        m.specular_weight = random.uniform();
        materials.push_back(m);
    }
    return materials;
}

glm::vec3 corner_direction(Random& random, std::size_t i) {
    const double phi = 2.0 * pi * static_cast<double>(random.uniform());
    const double side = random.uniform() < 0.5F ? 1.0 : -1.0;
    switch (i % 6) {
        case 0: return {0.0F, 0.0F, side};
        case 1: return direction_at_height(side * random.log_between(1e-6F, 1e-2F), phi);
        case 2: return direction_at_height(side * 1e-6, i % 4 == 0 ? 0.0 : phi);
        case 3: return direction_at_height(side * random.log_between(1e-30F, 1e-6F), i % 4 == 1 ? 0.0 : pi);
        case 4: return direction_at_height(0.0, phi);
        default: return random.direction();
    }
}

float corner_number(Random& random) {
    const float u = random.uniform();
    if (u < 0.1F) return 0.0F;
    if (u < 0.2F) return 1.0F - 0x1p-24F;
    if (u < 0.3F) return 0x1p-24F;
    return random.uniform();
}

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

void expect_sane(const LobeResult& r, const std::string& where) {
    ASSERT_TRUE(finite(r.f_cos) && std::isfinite(r.pdf)) << where;
    ASSERT_TRUE(r.f_cos.x >= 0.0F && r.f_cos.y >= 0.0F && r.f_cos.z >= 0.0F && r.pdf >= 0.0F) << where;
}

std::string describe(const LobeQuery& q, const Material& m) {
    return "wi " + testing::PrintToString(std::vector<float>{q.wi.x, q.wi.y, q.wi.z}) + ", wo or u " +
           testing::PrintToString(std::vector<float>{q.wo_or_u.x, q.wo_or_u.y, q.wo_or_u.z}) + ", alpha " +
           testing::PrintToString(m.alpha_u.value) + " " + testing::PrintToString(m.alpha_v.value) + ", eta " +
           testing::PrintToString(m.eta.x) + ", exponent " + testing::PrintToString(m.exponent.value) + ", flags " +
           testing::PrintToString(m.flags);
}

TEST_P(Robustness, SamplesAreFiniteUnitDirections) {
    Random random(1);
    const std::vector<Material> m = random_materials(random, 2000);
    const std::vector<LobeQuery> queries = sampling_queries(random, m.size());
    const std::vector<LobeSample> samples = probe().sample(m, queries);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const LobeSample& s = samples[i];
        const std::string where = describe(queries[i], m[queries[i].material]);
        expect_sane(s.value, where);
        if (HasFatalFailure()) return;
        ASSERT_TRUE(finite(s.wo)) << where;
        ASSERT_TRUE(std::isfinite(s.weight) && s.weight >= 0.0F) << where;
        ASSERT_TRUE(std::isfinite(s.eta) && s.eta > 0.0F) << where;
        if (s.wo == glm::vec3{0.0F}) continue;
        // Refraction out of a dense medium scales the rounding error of |wi| by the squared index.
        ASSERT_NEAR(glm::length(glm::dvec3(s.wo)), 1.0, 40 * 0x1p-24) << where;
    }
}

TEST_P(Robustness, ValuesAreFinite) {
    if (GetParam().delta) return;  // never evaluated
    Random random(2);
    const std::vector<Material> m = random_materials(random, 2000);
    const std::vector<LobeQuery> queries = eval_queries(random, m.size());
    const std::vector<LobeResult> results = probe().eval(m, queries);
    for (std::size_t i = 0; i < results.size(); ++i) {
        expect_sane(results[i], describe(queries[i], m[queries[i].material]));
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
