// The white furnace: how much of what arrives leaves again, by roughness and angle, from both sides; never more than all.
// And reciprocity.
#include <algorithm>

#include "support/random_lobes.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

using LobeEnergy = LobeTest;

// Radical inverses in bases 2, 3 and 5: the weights of samples are smooth in them.
float radical_inverse(std::uint32_t i, std::uint32_t base) {
    double digit = 1.0 / base, value = 0.0;
    for (; i > 0; i /= base, digit /= base) value += digit * (i % base);
    return static_cast<float>(std::min(value, 1.0 - 0x1p-24));
}

// Radiance scaling taken back: transmitted radiance is divided by the squared relative index.
double energy(const Material& m, const glm::vec3& wi, const LobeSample& s) {
    double value = mean(s.value.f_cos) / static_cast<double>(s.value.pdf);
    if (!is_transmissive(m) || wi.z * s.wo.z >= 0.0F) return value;
    const double eta2 = relative_index(m) * relative_index(m);
    return wi.z > 0.0F ? value * eta2 : value / eta2;
}

// White materials of one kind, from smooth to rough.
std::vector<std::pair<std::string, Material>> white_materials(const std::string& lobe) {
    std::vector<std::pair<std::string, Material>> result;
    const Material white = white_material();
    const auto rough_ones = [&](const std::string& kind, const Material& base) {
        for (Uint32 flags : {Uint32{0}, Uint32{MATERIAL_BECKMANN}}) {
            for (float alpha : {1e-4F, 1e-2F, 0.1F, 0.3F, 0.6F, 1.0F}) {
                result.emplace_back(kind + (flags != 0U ? "Beckmann " : "GGX ") + testing::PrintToString(alpha),
                                    rough(base, alpha, alpha, flags));
            }
        }
    };
    if (lobe == "rough_conductor") rough_ones("", white);
    else if (lobe == "rough_dielectric") {
        rough_ones("1.5 ", dielectric(white, 1.5F));
        rough_ones("1/1.5 ", dielectric(white, 1.0F / 1.5F));
    } else if (lobe == "phong") {
        for (float n : {0.0F, 1.0F, 30.0F, 1000.0F, 1e6F}) result.emplace_back("exponent " + testing::PrintToString(n), phong(white, n));
    } else {
        for (const LobeParameters& p : lobe_parameters().at(lobe)) result.emplace_back(p.name, p.material);
    }
    return result;
}

TEST_P(LobeEnergy, NoneIsGained) {
    const std::string& name = GetParam().name;
    LobeProbe device_lobe = probe();
    Claim gain("Appearance", name + ": energy gained in a white furnace", "share");
    const std::vector<double> cosines{1.0, 0.7, 0.4, 0.1, 0.01, 1e-4};
    const auto n = quick_or_full<std::uint32_t>(1U << 14, 1U << 20);
    std::vector<std::vector<ReportCell>> rows;
    std::uint64_t total = 0;
    for (const auto& [label, m] : white_materials(name)) {
        for (double side : {1.0, -1.0}) {
            if (side < 0.0 && !is_transmissive(m)) continue;
            std::vector<ReportCell> row{label, side > 0.0 ? "above" : "below"};
            for (double cosine : cosines) {
                const glm::vec3 wi = direction_at_height(side * cosine, 0.7);
                std::vector<LobeQuery> queries(n);
                for (std::uint32_t i = 0; i < n; ++i) queries[i] = {0, wi, {radical_inverse(i, 2), radical_inverse(i, 3), radical_inverse(i, 5)}};
                double sum = 0.0, squares = 0.0;
                for (const LobeSample& s : device_lobe.sample({m}, queries)) {
                    if (s.value.pdf == 0.0F) continue;
                    const double e = energy(m, wi, s);
                    sum += e;
                    squares += e * e;
                }
                const double albedo = sum / n;
                // Independent samples would be off by this; these are off by less.
                const double error = 4.0 * std::sqrt(std::max(squares / n - albedo * albedo, 0.0) / n);
                row.emplace_back(albedo);
                gain.observe(albedo - 1.0 - error, [&] { return label + ", cosine " + testing::PrintToString(side * cosine); });
                total += n;
            }
            rows.push_back(row);
        }
    }
    std::vector<std::string> columns{"parameters", "side"};
    for (double cosine : cosines) columns.push_back("cos " + testing::PrintToString(cosine));
    write_report_table("Appearance", "White furnace: share of the energy that leaves, " + name, columns, rows);
    gain.count(total);
    gain.at_most(32 * 0x1p-24);
}

// f / n^2 is symmetric, n the index of the side the radiance arrives at the viewer from: Veach 1997, section 5.2.
TEST_P(LobeEnergy, IsReciprocal) {
    const std::string& name = GetParam().name;
    if (name.starts_with("principled_thin")) return;  // does not bend light, whatever its index
    LobeProbe device_lobe = probe();
    const ReferenceEval& reference = reference_evals().at(name);
    Claim claim("Appearance", name + ": difference of the BSDF there and back, mixed error", "roundings");
    Random random(31);
    std::vector<LobeParameters> sets = parameters();
    std::erase_if(sets, [](const LobeParameters& set) { return !set.reciprocal; });
    std::vector<Material> materials;
    for (int i = 0; i < 5000; ++i) {
        Material m = random_material(random, sets, true);
        m.alpha_u.value = std::max(m.alpha_u.value, 1e-4F), m.alpha_v.value = std::max(m.alpha_v.value, 1e-4F);
        materials.push_back(m);
    }
    std::vector<LobeQuery> there;
    for (std::size_t i = 0; i < quick_or_full<std::size_t>(100000, 1000000); ++i) {
        const double side = i % 3 == 0 ? -1.0 : 1.0;
        const glm::vec3 wi = direction_at_height(side * static_cast<double>(random.log_between(1e-6F, 1.0F)), 6.3 * static_cast<double>(random.uniform()));
        there.push_back({static_cast<std::uint32_t>(i % materials.size()), wi, random.uniform3()});
    }
    const std::vector<LobeSample> samples = device_lobe.sample(materials, there);
    for (std::size_t i = 0; i < there.size(); ++i) there[i].wo_or_u = samples[i].value.pdf > 0.0F ? samples[i].wo : random.direction();
    std::vector<LobeQuery> back = there;
    for (LobeQuery& q : back) std::swap(q.wi, q.wo_or_u);
    const std::vector<LobeResult> f = device_lobe.eval(materials, there);
    const std::vector<LobeResult> g = device_lobe.eval(materials, back);
    for (std::size_t i = 0; i < there.size(); ++i) {
        const LobeQuery& q = there[i];
        const Material& m = materials[q.material];
        if (q.wi.z == 0.0F || q.wo_or_u.z == 0.0F) continue;
        const double eta2 = relative_index(m) * relative_index(m);
        const bool crosses = is_transmissive(m) && q.wi.z * q.wo_or_u.z < 0.0F;
        const double to_there = (crosses && q.wi.z < 0.0F ? 1.0 / eta2 : 1.0) / std::abs(q.wo_or_u.z);
        const double to_back = (crosses && q.wo_or_u.z < 0.0F ? 1.0 / eta2 : 1.0) / std::abs(q.wi.z);
        const double a = mean(f[i].f_cos) * to_there, b = mean(g[i].f_cos) * to_back;
        const double slack = mean(input_slack(reference, m, q.wi, q.wo_or_u).f_cos) * to_there +
                             mean(input_slack(reference, m, q.wo_or_u, q.wi).f_cos) * to_back;
        const double least = 1e12 * 0x1p-126 * (to_there + to_back);
        const double excess = std::max(std::abs(a - b) - least, 0.0);
        claim.observe(excess == 0.0 ? 0.0 : excess / (0x1p-24 * a + 0.5 * slack), [&] { return describe(q, m); });
    }
    claim.at_most(std::ranges::max_element(sets, {}, &LobeParameters::rounding)->rounding);
}

INSTANTIATE_TEST_SUITE_P(All, LobeEnergy, testing::ValuesIn(evaluated_lobes()), lobe_test_name);

}  // namespace
}  // namespace wavelobe::test
