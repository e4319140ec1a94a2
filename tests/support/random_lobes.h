// Random materials and directions for tests of lobes, among them the hard corners of both.
#pragma once

#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "support/lobe_test.h"

namespace wavelobe::test {

template <class List>
auto pick(Random& random, const List& list) {
    return list[static_cast<std::size_t>(random.uniform() * static_cast<float>(std::size(list)))];
}

constexpr float corner_etas[] = {1.0F, 1.0001F, 1.0F / 1.5F, 1.5F, 2.4F};
constexpr float corner_alphas[] = {0.0F, 1e-4F, 1.0F};
constexpr float corner_exponents[] = {0.0F, 1e6F};

// Materials whose parameters have nothing to do with each other.
inline std::vector<Material> random_materials(Random& random, std::size_t n) {
    std::vector<Material> materials;
    for (std::size_t i = 0; i < n; ++i) {
        Material m = white_material();
        const auto colour = [&] {
            return i % 5 == 0 ? Packed3{0.0F, 1.0F, 1.0F} : Packed3{random.uniform(), random.uniform(), random.uniform()};
        };
        m.flags = static_cast<Uint32>(i) % 8;
        m.diffuse.value = colour();
        m.specular.value = colour();
        m.transmission.value = colour();
        m.eta = {pick(random, corner_etas), pick(random, corner_etas), 0.0F};
        m.k = {random.between(0.0F, 10.0F), 0.0F, 1.0F};
        m.alpha_u.value = i % 3 == 0 ? pick(random, corner_alphas) : random.log_between(1e-4F, 1.0F);
        m.alpha_v.value = i % 3 == 1 ? pick(random, corner_alphas) : random.log_between(1e-4F, 1.0F);
        m.exponent.value = i % 4 == 0 ? pick(random, corner_exponents) : random.log_between(0.1F, 1e6F);
        m.metallic.value = i % 7 == 0 ? 1.0F : random.uniform();
        m.diffuse_fresnel_internal = random.between(0.0F, 0.95F);
        m.specular_weight = random.uniform();
        materials.push_back(m);
    }
    return materials;
}

// One of a lobe's own parameter sets; of three in four what all lobes share is random too: roughness of both axes apart,
// indices, extinction (also none), exponent. Flags stay, which say what the material is.
inline Material random_material(Random& random, const std::vector<LobeParameters>& sets, bool glossy) {
    Material m = pick(random, sets).material;
    if (random.uniform() < 0.25F) return m;
    m.alpha_u.value = random.uniform() < 0.3F ? pick(random, corner_alphas) : random.log_between(1e-4F, 1.0F);
    m.alpha_v.value = random.uniform() < 0.3F ? pick(random, corner_alphas) : random.log_between(1e-4F, 1.0F);
    if (random.uniform() < 0.3F) m.alpha_v.value = m.alpha_u.value;
    float eta = random.uniform() < 0.5F ? pick(random, corner_etas) : random.between(0.4F, 2.5F);
    // A rough interface between equal media has no half vector: readers refuse it.
    if (eta == 1.0F && glossy) eta = 1.0F + 0x1p-13F;
    m.eta = {eta, random.between(0.05F, 4.0F), pick(random, corner_etas)};
    m.k = {random.between(0.0F, 10.0F), 0.0F, random.log_between(1e-3F, 10.0F)};
    m.exponent.value = random.uniform() < 0.3F ? pick(random, corner_exponents) : random.log_between(0.1F, 1e6F);
    m.metallic.value = i % 7 == 0 ? 1.0F : random.uniform();
    return m;
}

inline glm::vec3 corner_direction(Random& random, std::size_t i) {
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

inline float corner_number(Random& random) {
    const float u = random.uniform();
    if (u < 0.1F) return 0.0F;
    if (u < 0.2F) return 1.0F - 0x1p-24F;
    if (u < 0.3F) return 0x1p-24F;
    return random.uniform();
}

inline std::string describe(const LobeQuery& q, const Material& m) {
    const auto text = [](const auto& value) { return testing::PrintToString(value); };
    return "wi " + to_text(q.wi) + ", wo or u " + to_text(q.wo_or_u) + ", alpha " + text(m.alpha_u.value) + " " +
           text(m.alpha_v.value) + ", eta " + text(m.eta.x) + ", exponent " + text(m.exponent.value) + ", flags " +
           text(m.flags);
}

}  // namespace wavelobe::test
