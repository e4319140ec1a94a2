// The Phong lobe: its helpers, and closed forms of its integrals.
#include "support/lobe_test.h"

namespace wavelobe::test {
namespace {

const LobeName name{"phong", false};

std::vector<float> map(const std::string& function, const std::vector<float>& x) {
    Probe probe(R"(
        #define HAS_TEXTURES 0
        #include "bsdf/phong.h"
        kernel void run(global const float *x, global float *y) {
            size_t i = get_global_id(0) * LANES;
            store(y + i, )" + function + R"((load(x + i)));
        })");
    std::vector<float> y(x.size());
    probe.run("run", x.size() / 16, x, y);
    return y;
}

TEST(Phong, LogarithmNearOneKeepsRelativePrecision) {
    Random random(1);
    std::vector<float> x(65536);
    for (float& v : x) v = random.log_between(1e-20F, 0.99999F);
    const std::vector<float> y = map("log_one_minus", x);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double expected = std::log1p(-static_cast<double>(x[i]));
        ASSERT_NEAR(y[i], expected, 4 * 0x1p-23 * -expected) << x[i];
    }
}

TEST(Phong, ExponentialNearZeroKeepsRelativePrecision) {
    Random random(2);
    std::vector<float> x(65536);
    for (float& v : x) v = -random.log_between(1e-20F, 100.0F);
    const std::vector<float> y = map("one_minus_exp", x);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double expected = -std::expm1(static_cast<double>(x[i]));
        ASSERT_NEAR(y[i], expected, 4 * 0x1p-24 * expected) << x[i];
    }
}

TEST(Phong, PeaksInTheMirrorDirection) {
    LobeProbe probe(name, 16);
    for (float n : {0.0F, 1.0F, 30.0F, 1e6F}) {
        const Material m = phong(coloured_material(), n);
        const glm::vec3 wi = direction_at_height(0.6, 1.0);
        const LobeResult r = probe.eval({m}, {{0, wi, mirrored(wi)}})[0];
        const double peak = (static_cast<double>(n) + 2.0) / (2.0 * pi) * static_cast<double>(wi.z);
        EXPECT_NEAR(r.f_cos.x, static_cast<double>(m.specular.value.x) * peak, 4 * 0x1p-24 * peak) << n;
        EXPECT_NEAR(r.pdf, (static_cast<double>(n) + 1.0) / (2.0 * pi), 4 * 0x1p-24 * (static_cast<double>(n) + 1.0)) << n;
    }
}

// At normal incidence samples have E[cos] = (n + 1) / (n + 2), Var[cos] = (n + 1) / ((n + 3) (n + 2)^2), and weights
// specular (n + 2) / (n + 1) cos, whose mean is the specular reflectance.
TEST(Phong, MomentsOfSamples) {
    LobeProbe probe(name, 16);
    Random random(3);
    constexpr std::size_t count = 200000;
    for (float exponent : {0.0F, 1.0F, 30.0F, 1000.0F, 1e6F}) {
        const std::vector<Material> m{phong(white_material(), exponent)};
        std::vector<LobeQuery> queries(count);
        for (LobeQuery& q : queries) q = {0, {0.0F, 0.0F, 1.0F}, random.uniform3()};
        double one_minus_cos = 0.0;
        double weight = 0.0;
        for (const LobeSample& s : probe.sample(m, queries)) {
            const glm::dvec3 chord = glm::dvec3(s.wo) - glm::dvec3(0, 0, 1);
            one_minus_cos += 0.5 * glm::dot(chord, chord);
            weight += static_cast<double>(s.value.f_cos.x) / static_cast<double>(s.value.pdf);
        }
        const double n = exponent;
        const double deviation = std::sqrt((n + 1.0) / (n + 3.0)) / (n + 2.0) / std::sqrt(static_cast<double>(count));
        // Five standard deviations: chance 6e-7.
        EXPECT_NEAR(one_minus_cos / count, 1.0 / (n + 2.0), 5.0 * deviation) << exponent;
        EXPECT_NEAR(weight / count, 1.0, 5.0 * deviation * (n + 2.0) / (n + 1.0) + 8 * 0x1p-24) << exponent;
    }
}

}  // namespace
}  // namespace wavelobe::test
