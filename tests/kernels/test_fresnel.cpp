// Fresnel equations against closed forms and double precision.
#include "support/lobe_reference.h"
#include "support/lobe_test.h"

namespace wavelobe::test {
namespace {

constexpr double ulp = 0x1p-24;

struct Fresnel {
    double reflectance, transmittance, cos_t, eta_it, eta_ti;
};

// Pads to whole groups of lanes.
std::vector<float> padded(std::vector<float> values) {
    values.resize((values.size() + 15) / 16 * 16, 1.0F);
    return values;
}

std::vector<Fresnel> dielectric(const std::vector<float>& cosines, const std::vector<float>& etas) {
    static Probe probe(R"(
        #include "bsdf/fresnel.h"
        kernel void run(global const float *cos_i, global const float *eta, global float *out, uint n) {
            size_t i = get_global_id(0) * LANES;
            DielectricFresnel f = fresnel_dielectric(load(cos_i + i), load(eta + i));
            store(out + i, f.reflectance);
            store(out + n + i, f.transmittance);
            store(out + 2 * n + i, f.cos_t);
            store(out + 3 * n + i, f.eta_it);
            store(out + 4 * n + i, f.eta_ti);
        })");
    const std::vector<float> c = padded(cosines);
    const std::vector<float> e = padded(etas);
    const std::size_t n = c.size();
    std::vector<float> out(5 * n);
    const auto count = static_cast<std::uint32_t>(n);
    probe.run("run", n / 16, c, e, out, count);
    std::vector<Fresnel> results(cosines.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
        results[i] = {out[i], out[n + i], out[2 * n + i], out[3 * n + i], out[4 * n + i]};
    }
    return results;
}

Fresnel dielectric(float cosine, float eta) { return dielectric(std::vector{cosine}, std::vector{eta})[0]; }

std::vector<double> conductor(const std::vector<float>& cosines, const std::vector<float>& etas,
                              const std::vector<float>& ks) {
    static Probe probe(R"(
        #include "bsdf/fresnel.h"
        kernel void run(global const float *cos_i, global const float *eta, global const float *k, global float *out) {
            size_t i = get_global_id(0) * LANES;
            store(out + i, fresnel_conductor(load(cos_i + i), load(eta + i), load(k + i)));
        })");
    const std::vector<float> c = padded(cosines);
    const std::vector<float> e = padded(etas);
    const std::vector<float> k = padded(ks);
    std::vector<float> out(c.size());
    probe.run("run", c.size() / 16, c, e, k, out);
    return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(cosines.size())};
}

const std::vector<float> etas{1.0F / 2.4F, 1.0F / 1.5F, 0.999F, 0.99999994F, 1.00000012F, 1.0001F, 1.33F, 1.5F, 2.4F};

TEST(Fresnel, NormalIncidence) {
    for (float eta : etas) {
        const double n = eta;
        const double expected = (n - 1.0) / (n + 1.0) * (n - 1.0) / (n + 1.0);
        for (float cosine : {1.0F, -1.0F}) {
            const Fresnel f = dielectric(cosine, eta);
            EXPECT_NEAR(f.reflectance, expected, 16 * ulp * expected) << eta;
            EXPECT_NEAR(f.transmittance, 1.0 - expected, 16 * ulp) << eta;
            EXPECT_NEAR(f.cos_t, -cosine, 4 * ulp);
        }
    }
}

// tan(angle) = eta: the reflected and refracted rays are perpendicular and only s-polarized light is reflected.
TEST(Fresnel, BrewsterAngle) {
    for (float eta : etas) {
        const double n_squared = static_cast<double>(eta) * static_cast<double>(eta);
        const double s = (1.0 - n_squared) / (1.0 + n_squared);
        const auto above = static_cast<float>(1.0 / std::sqrt(1.0 + n_squared));
        const auto below = static_cast<float>(-1.0 / std::sqrt(1.0 + 1.0 / n_squared));
        for (float cosine : {above, below}) {
            EXPECT_NEAR(dielectric(cosine, eta).reflectance, 0.5 * s * s, 32 * ulp * 0.5 * s * s) << eta << " " << cosine;
        }
    }
}

TEST(Fresnel, TotalReflectionBeyondTheCriticalAngle) {
    for (float eta : {1.0001F, 1.5F, 2.4F}) {
        const double critical = std::sqrt(1.0 - 1.0 / (static_cast<double>(eta) * static_cast<double>(eta)));
        // The square of the refracted cosine is known to a few rounding errors of the products it is the difference of.
        const double margin = 8 * ulp / critical;
        const Fresnel beyond = dielectric(static_cast<float>(-(critical - margin)), eta);
        EXPECT_EQ(beyond.reflectance, 1.0) << eta;
        EXPECT_EQ(beyond.transmittance, 0.0) << eta;
        EXPECT_EQ(beyond.cos_t, 0.0) << eta;
        const Fresnel before = dielectric(static_cast<float>(-(critical + margin)), eta);
        EXPECT_LT(before.reflectance, 1.0) << eta;
        EXPECT_GT(before.transmittance, 0.0) << eta;
        EXPECT_GT(before.cos_t, 0.0) << eta;
    }
    EXPECT_EQ(dielectric(-0.0001F, 1.5F).reflectance, 1.0);
    EXPECT_EQ(dielectric(0.0001F, 1.0F / 1.5F).reflectance, 1.0);
}

TEST(Fresnel, GrazingIncidence) {
    for (float eta : {1.0001F, 1.5F, 2.4F}) {
        EXPECT_EQ(dielectric(0.0F, eta).transmittance, 0.0);
        EXPECT_NEAR(dielectric(0.0F, eta).reflectance, 1.0, 8 * ulp);
        // 1 - F = 2 cos (1 + eta^2) / sqrt(eta^2 - 1) to first order
        const double g = std::sqrt((static_cast<double>(eta) - 1.0) * (static_cast<double>(eta) + 1.0));
        const double slope = 2.0 * (1.0 + static_cast<double>(eta) * static_cast<double>(eta)) / g;
        for (float cosine : {1e-6F, 1e-10F, 1e-20F}) {
            // The next order is smaller by about 2 (1 + eta^2) cos / g.
            const double bound = 16 * ulp + 2.0 * slope * static_cast<double>(cosine);
            const double expected = slope * static_cast<double>(cosine);
            EXPECT_NEAR(dielectric(cosine, eta).transmittance, expected, bound * expected) << eta << " " << cosine;
        }
    }
}

TEST(Fresnel, MatchedIndicesReflectNothing) {
    for (float cosine : {0.0F, 1e-30F, 0.3F, 1.0F, -0.3F}) {
        const Fresnel f = dielectric(cosine, 1.0F);
        EXPECT_EQ(f.reflectance, 0.0);
        EXPECT_EQ(f.transmittance, 1.0);
        EXPECT_EQ(f.eta_it, 1.0);
        EXPECT_NEAR(f.cos_t, -cosine, ulp * static_cast<double>(std::abs(cosine)));
    }
}

TEST(Fresnel, DielectricMatchesDoublePrecision) {
    Random random(1);
    std::vector<float> cosines;
    std::vector<float> indices;
    for (int i = 0; i < 100000; ++i) {
        const float magnitude = i % 2 ? random.uniform() : random.log_between(1e-6F, 1.0F);
        cosines.push_back(i % 4 < 2 ? magnitude : -magnitude);
        indices.push_back(i % 8 < 4 ? etas[static_cast<std::size_t>(i / 8) % etas.size()] : random.log_between(0.3F, 3.0F));
    }
    const std::vector<Fresnel> results = dielectric(cosines, indices);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const double c = cosines[i];
        const double eta = indices[i];
        const Fresnel& f = results[i];
        const double expected = reference_fresnel_dielectric(c, eta);
        // Towards the critical angle the reflectance follows the square root of its distance: moving the cosine by
        // rounding errors shows how far.
        const double slack = std::abs(reference_fresnel_dielectric(c * (1.0 + 4 * ulp), eta) - expected) +
                             std::abs(reference_fresnel_dielectric(c * (1.0 - 4 * ulp), eta) - expected);
        ASSERT_NEAR(f.reflectance, expected, 32 * ulp * expected + slack + 1e-16) << c << " " << eta;
        ASSERT_NEAR(f.transmittance, 1.0 - expected, 32 * ulp * (1.0 - expected) + slack + 1e-16) << c << " " << eta;
        ASSERT_NEAR(f.reflectance + f.transmittance, 1.0, 16 * ulp + slack) << c << " " << eta;
        ASSERT_NEAR(f.eta_it * f.eta_ti, 1.0, 2 * ulp);
        if (f.reflectance == 1.0 && f.transmittance == 0.0) continue;
        // Snell: tangential parts, unit length.
        const double sin_t_squared = (1.0 - c * c) * f.eta_ti * f.eta_ti;
        // Leaving a dense medium, the squared cosine is a difference of products as large as the squared index.
        ASSERT_NEAR(sin_t_squared + f.cos_t * f.cos_t, 1.0, (8.0 + 4.0 * f.eta_ti * f.eta_ti) * ulp) << c << " " << eta;
        ASSERT_LE(f.cos_t * c, 0.0);
    }
}

TEST(Fresnel, PerfectConductorReflectsAll) {
    for (float cosine : {0.0F, 1e-6F, 0.1F, 0.7F, 1.0F}) {
        EXPECT_EQ(conductor({cosine}, {0.0F}, {1.0F})[0], 1.0) << cosine;
        EXPECT_EQ(conductor({cosine}, {0.0F}, {0.0F})[0], 1.0) << cosine;
    }
}

TEST(Fresnel, ConductorMatchesDoublePrecision) {
    Random random(2);
    std::vector<float> cosines;
    std::vector<float> indices;
    std::vector<float> ks;
    for (int i = 0; i < 100000; ++i) {
        cosines.push_back(i % 2 ? random.uniform() : random.log_between(1e-6F, 1.0F));
        indices.push_back(i % 3 ? random.log_between(0.01F, 10.0F) : 1.0F + random.log_between(1e-5F, 1.0F));
        ks.push_back(i % 5 ? random.log_between(1e-3F, 30.0F) : 0.0F);
    }
    const std::vector<double> results = conductor(cosines, indices, ks);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const auto reference = [&](double c, double eta, double k) { return reference_fresnel(std::min(c, 1.0), {eta, k}); };
        const double c = cosines[i];
        const double eta = indices[i];
        const double k = ks[i];
        const double expected = reference(c, eta, k);
        const double step = 1.0 + 2 * ulp;
        const double slack = std::abs(reference(c * step, eta, k) - expected) +
                             std::abs(reference(c, eta * step, k) - expected) +
                             std::abs(reference(c, eta, k * step) - expected);
        ASSERT_NEAR(results[i], expected, 32 * ulp * expected + 4.0 * slack) << c << " " << eta << " " << k;
    }
}

}  // namespace
}  // namespace wavelobe::test
