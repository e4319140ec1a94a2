// What the tests of all lobes share: a fixture a lobe, incident directions, random numbers, and the error that rounding of
// the inputs alone excuses.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "support/lobe_parameters.h"
#include "support/lobe_probe.h"
#include "support/lobe_reference.h"

namespace wavelobe::test {

class LobeTest : public testing::TestWithParam<LobeName> {
protected:
    void SetUp() override {
        const std::string& name = GetParam().name;
        ASSERT_TRUE(lobe_parameters().contains(name) && !lobe_parameters().at(name).empty())
            << "the lobe `" << name << "` of bsdf/lobes.def has no parameter sets: add some to "
            << "tests/support/lobe_parameters.h";
        ASSERT_TRUE(GetParam().delta ? reference_deltas().contains(name) : reference_evals().contains(name))
            << "the lobe `" << name << "` of bsdf/lobes.def has no reference: add one to tests/support/lobe_reference.h";
    }

    const std::vector<LobeParameters>& parameters() const { return lobe_parameters().at(GetParam().name); }

    std::vector<Material> materials() const {
        std::vector<Material> result;
        for (const LobeParameters& p : parameters()) result.push_back(p.material);
        return result;
    }

    LobeProbe probe(int lanes = 16) const { return {GetParam(), lanes}; }
};

inline std::string lobe_test_name(const testing::TestParamInfo<LobeName>& info) { return info.param.name; }

inline std::vector<LobeName> delta_lobes() {
    std::vector<LobeName> names = lobe_names();
    std::erase_if(names, [](const LobeName& l) { return !l.delta; });
    return names;
}

inline std::vector<LobeName> evaluated_lobes() {
    std::vector<LobeName> names = lobe_names();
    std::erase_if(names, [](const LobeName& l) { return l.delta; });
    return names;
}

class Random {
public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}

    // In [0, 1), a multiple of 2^-24: as kernels get their numbers.
    float uniform() { return static_cast<float>(generator_() >> 8) * 0x1p-24F; }
    float between(float a, float b) { return a + (b - a) * uniform(); }
    float log_between(float a, float b) { return a * std::pow(b / a, uniform()); }
    glm::vec3 uniform3() { return {uniform(), uniform(), uniform()}; }

    glm::vec3 direction() {
        const double z = 2.0 * static_cast<double>(uniform()) - 1.0;
        const double phi = 2.0 * pi * static_cast<double>(uniform());
        const double r = std::sqrt(1.0 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }

private:
    std::mt19937 generator_;
};

// At a height above the surface (below, if negative).
inline glm::vec3 direction_at_height(double z, double phi) {
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

inline bool is_transmissive(const Material& m) { return (m.flags & MATERIAL_TRANSMISSIVE) != 0; }

// Of the medium below the surface over that above it.
inline double relative_index(const Material& m) { return (m.flags & MATERIAL_THIN) != 0 ? 1.0 : static_cast<double>(m.eta.x); }

// From normal to grazing incidence; from below, too, for transmissive materials.
inline std::vector<glm::vec3> incident_directions(const Material& m) {
    std::vector<glm::vec3> result;
    for (double side : {1.0, -1.0}) {
        if (side < 0.0 && !is_transmissive(m)) break;
        result.push_back({0.0F, 0.0F, side});
        result.push_back(direction_at_height(side * 0.85, 0.7));
        result.push_back(direction_at_height(side * 0.5, 3.5));
        result.push_back(direction_at_height(side * 0.1, -1.2));
        result.push_back(direction_at_height(side * 1e-3, 2.2));
    }
    return result;
}

// With all its digits.
inline std::string to_text(const glm::vec3& v) {
    return testing::PrintToString(v.x) + " " + testing::PrintToString(v.y) + " " + testing::PrintToString(v.z);
}

inline double mean(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

// How much the reference changes when each component of the directions moves by one rounding error.
inline ReferenceValue input_slack(const ReferenceEval& eval, const Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    const ReferenceValue exact = eval(m, wi, wo);
    ReferenceValue slack;
    for (int c = 0; c < 6; ++c) {
        glm::dvec3 i = wi;
        glm::dvec3 o = wo;
        (c < 3 ? i[c] : o[c - 3]) *= 1.0 + 0x1p-23;
        const ReferenceValue moved = eval(m, i, o);
        slack.f_cos += glm::abs(moved.f_cos - exact.f_cos);
        slack.pdf += std::abs(moved.pdf - exact.pdf);
    }
    return slack;
}

}  // namespace wavelobe::test
