// Fresnel reflectance where its value is known in closed form, and everywhere against extended precision.
#include "support/random_lobes.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

constexpr double rounding = 0x1p-24;

struct Incidence {
    float cosine, eta, k;
};

enum class Interface { dielectric, conductor };

// Reflectances on the device; of conductors with eta + i k.
std::vector<float> reflectances(Interface interface, const std::vector<Incidence>& incidences) {
    static Probe probe(R"(
        #include "bsdf/fresnel.h"
        kernel void dielectric(global const float *cos_i, global const float *eta, global const float *k, global float *out) {
            size_t i = get_global_id(0) * LANES;
            store(out + i, fresnel_dielectric(load(cos_i + i), load(eta + i)).reflectance);
        }
        kernel void conductor(global const float *cos_i, global const float *eta, global const float *k, global float *out) {
            size_t i = get_global_id(0) * LANES;
            store(out + i, fresnel_conductor(load(cos_i + i), load(eta + i), load(k + i)));
        })");
    const std::size_t n = (incidences.size() + 15) / 16 * 16;
    std::vector<float> cosine(n, 1.0F), eta(n, 1.5F), k(n, 0.0F), out(n);
    for (std::size_t i = 0; i < incidences.size(); ++i) {
        cosine[i] = incidences[i].cosine;
        eta[i] = incidences[i].eta;
        k[i] = incidences[i].k;
    }
    probe.run(interface == Interface::dielectric ? "dielectric" : "conductor", n / 16, std::as_const(cosine),
              std::as_const(eta), std::as_const(k), out);
    out.resize(incidences.size());
    return out;
}

std::string describe(const Incidence& i) {
    const auto text = [](float x) { return testing::PrintToString(x); };
    return "cosine " + text(i.cosine) + ", index " + text(i.eta) + " + " + text(i.k) + " i";
}

void observe_all(Claim& claim, Interface interface, const std::vector<Incidence>& incidences,
                 const std::function<double(const Incidence&)>& expected, double floor = 0.0) {
    const std::vector<float> found = reflectances(interface, incidences);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double exact = expected(incidences[i]);
        claim.observe(std::abs(found[i] - exact) / std::max(exact, floor) / (2 * rounding), [&] { return describe(incidences[i]); });
    }
}

const std::vector<float> indices{1.0001F, 1.1F, 1.33F, 1.5F, 2.4F, 1.0F / 1.5F, 1.0F / 2.4F, 0.1F, 10.0F};

// ((n - 1) / (n + 1))^2, and ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)
TEST(FresnelPoints, NormalIncidence) {
    Claim claim("Appearance", "Fresnel reflectance at normal incidence, from both sides", "ulp");
    std::vector<Incidence> glass, metal;
    for (float n : indices) {
        glass.push_back({1.0F, n, 0.0F});
        glass.push_back({-1.0F, n, 0.0F});
        for (float k : {0.0F, 1e-3F, 0.5F, 3.9F, 10.0F}) metal.push_back({1.0F, n, k});
    }
    const auto expected = [](const Incidence& i) {
        const double n = i.eta, k2 = static_cast<double>(i.k) * static_cast<double>(i.k);
        return ((n - 1) * (n - 1) + k2) / ((n + 1) * (n + 1) + k2);
    };
    observe_all(claim, Interface::dielectric, glass, expected);
    observe_all(claim, Interface::conductor, metal, expected);
    claim.at_most(8.0);
}

// At Brewster's angle, tan = n, one polarization is not reflected at all, the other with (n^2 - 1) / (n^2 + 1).
TEST(FresnelPoints, Brewster) {
    Claim claim("Appearance", "Fresnel reflectance at Brewster's angle", "ulp");
    std::vector<Incidence> incidences;
    // Beyond these the angle is so close to the normal or the horizon that a float cosine does not name it.
    for (float n : {1.0001F, 1.1F, 1.33F, 1.5F, 2.4F, 1.0F / 1.5F, 1.0F / 2.4F}) {
        const double e = n;
        incidences.push_back({static_cast<float>(1.0 / std::sqrt(1.0 + e * e)), n, 0.0F});
        // From below, where the index is 1 / n.
        incidences.push_back({-static_cast<float>(e / std::sqrt(1.0 + e * e)), n, 0.0F});
    }
    // The reflected polarization passes through the angle with a slope: the rounded cosine counts for two ulp or so.
    observe_all(claim, Interface::dielectric, incidences, [](const Incidence& i) {
        const double r = (static_cast<double>(i.eta) - 1.0) * (static_cast<double>(i.eta) + 1.0) / (static_cast<double>(i.eta) * static_cast<double>(i.eta) + 1.0);
        return 0.5 * r * r;
    });
    claim.at_most(12.0);
}

// Beyond the critical angle everything is reflected; one float before it, not.
TEST(FresnelPoints, CriticalAngle) {
    Claim beyond("Appearance", "Fresnel: reflectance lacking from 1 beyond the critical angle", "absolute");
    std::size_t partial = 0, tried = 0;
    for (float n : {1.0001F, 1.1F, 1.33F, 1.5F, 2.4F}) {
        const double critical = std::sqrt(1.0 - 1.0 / (static_cast<double>(n) * static_cast<double>(n)));
        std::vector<Incidence> incidences;
        float inside = static_cast<float>(critical * (1.0 - 8 * rounding)), outside = static_cast<float>(critical * (1.0 + 8 * rounding));
        for (int i = 0; i < 64; ++i) {
            incidences.push_back({-inside, n, 0.0F});
            incidences.push_back({-outside, n, 0.0F});
            inside *= 0.9F;
            outside = std::nextafter(outside, 1.0F);
        }
        incidences.push_back({-0.0F, 1.0F / n, 0.0F});  // grazing
        const std::vector<float> found = reflectances(Interface::dielectric, incidences);
        for (std::size_t i = 0; i + 1 < found.size(); ++i) {
            if (i % 2 == 0) beyond.observe(1.0 - static_cast<double>(found[i]), [&] { return describe(incidences[i]); });
            if (i % 2 == 1) partial += found[i] < 1.0F, ++tried;
        }
    }
    beyond.at_most(0.0);
    EXPECT_EQ(partial, tried) << "total reflection before the critical angle";
}

// Sweeps against long double; how far the rounding of the cosine itself may carry is allowed for.
TEST(FresnelPoints, Everywhere) {
    Claim glass("Appearance", "Fresnel reflectance of dielectrics, mixed error", "roundings");
    Claim metal("Appearance", "Fresnel reflectance of conductors, mixed error", "roundings");
    Random random(21);
    std::vector<Incidence> incidences;
    for (std::size_t i = 0; i < quick_or_full<std::size_t>(1000000, 20000000); ++i) {
        const float cosine = i % 3 == 0 ? random.log_between(1e-6F, 1.0F) : random.between(1e-3F, 1.0F);
        const float eta = i % 2 == 0 ? pick(random, corner_etas) : random.log_between(0.05F, 10.0F);
        const float k = i % 5 == 0 ? 0.0F : random.log_between(1e-4F, 20.0F);
        incidences.push_back({cosine, eta, k});
    }
    const auto mixed = [](double found, const Incidence& i, const std::function<double(double, double, double)>& reference) {
        const double exact = reference(i.cosine, i.eta, i.k);
        double slack = 0.0;
        for (int input = 0; input < 3; ++input) {
            double x[3] = {i.cosine, i.eta, i.k};
            x[input] *= 1.0 + 2 * rounding;
            slack += std::abs(reference(x[0], x[1], x[2]) - exact);
        }
        return std::abs(found - exact) / (rounding * exact + 0.5 * slack + 1e-38);
    };
    const std::vector<float> conductor = reflectances(Interface::conductor, incidences);
    for (std::size_t i = 0; i < incidences.size(); ++i) {
        metal.observe(mixed(conductor[i], incidences[i], [](double c, double n, double k) {
            return n == 1.0 && k == 0.0 ? 0.0 : reference_fresnel(c, {n, k});
        }), [&] { return describe(incidences[i]); });
        if (i % 2 == 1) incidences[i].cosine = -incidences[i].cosine;
    }
    const std::vector<float> dielectric = reflectances(Interface::dielectric, incidences);
    for (std::size_t i = 0; i < incidences.size(); ++i) {
        glass.observe(mixed(dielectric[i], incidences[i], [](double c, double n, double) { return reference_fresnel_dielectric(c, n); }),
                      [&] { return describe(incidences[i]); });
    }
    glass.at_most(16.0);
    metal.at_most(16.0);
}

}  // namespace
}  // namespace wavelobe::test
