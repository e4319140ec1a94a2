// Lobes in double precision, by their papers' formulas.
#pragma once

#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "support/lobe_reference_base.h"
#include "support/principled_reference.h"

namespace wavelobe::test {

inline ReferenceValue reference_rough_conductor(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const glm::dvec3 h = glm::normalize(wi + wo);
    const double d = reference_density(m, h);
    const double g = reference_masking(m, wi, false) * reference_masking(m, wo, false);
    // wi . h in the density of visible normals and 4 wo . h in the Jacobian leave 4.
    return {to_double(m.specular.value) * reference_fresnel_conductor(m, glm::dot(wi, h)) * (d * g / (4.0 * wi.z)),
            d * reference_masking(m, wi, true) / (4.0 * wi.z)};
}

inline ReferenceValue reference_rough_dielectric(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z == 0.0 || wo.z == 0.0) return {};
    const double eta = wi.z > 0.0 ? m.eta.x : 1.0 / m.eta.x;  // behind the surface over before it
    const bool reflects = wi.z * wo.z > 0.0;
    glm::dvec3 h = glm::normalize(reflects ? wi + wo : wi + eta * wo);
    if (h.z < 0.0) h = -h;
    const double cos_i = glm::dot(wi, h);
    const double cos_o = glm::dot(wo, h);
    if (cos_i * wi.z <= 0.0 || cos_o * wo.z <= 0.0) return {};
    const double fresnel = reference_fresnel_dielectric(cos_i, m.eta.x);
    const double d = reference_density(m, h);
    const double g = reference_masking(m, wi, false) * reference_masking(m, wo, false);
    if (reflects) {
        return {to_double(m.specular.value) * (fresnel * d * g / (4.0 * std::abs(wi.z))),
                fresnel * d * reference_masking(m, wi, true) / (4.0 * std::abs(wi.z))};
    }
    const double visible = d * reference_masking(m, wi, true) * std::abs(cos_i / wi.z);
    const double sum = cos_i + eta * cos_o;
    const double jacobian = eta * eta * std::abs(cos_o) / (sum * sum);
    return {to_double(m.transmission.value) *
                ((1.0 - fresnel) * d * g * std::abs(cos_i / wi.z) * jacobian / (eta * eta)),
            (1.0 - fresnel) * visible * jacobian};
}

inline ReferenceValue reference_phong(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const glm::dvec3 chord = wo - glm::dvec3{-wi.x, -wi.y, wi.z};
    const double one_minus_cos = 0.5 * glm::dot(chord, chord);
    if (one_minus_cos >= 1.0) return {};
    const double n = m.exponent.value;
    const double power = std::exp(n * std::log1p(-one_minus_cos));
    return {to_double(m.specular.value) * ((n + 2.0) / (2.0 * pi) * power * wo.z), (n + 1.0) / (2.0 * pi) * power};
}

inline ReferenceValue reference_rough_plastic_coat(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const glm::dvec3 h = glm::normalize(wi + wo);
    const double d = reference_density(m, h);
    const double g = reference_masking(m, wi, false) * reference_masking(m, wo, false);
    const double fresnel = reference_fresnel_dielectric(glm::dot(wi, h), m.eta.x);
    return {to_double(m.specular.value) * (fresnel * d * g / (4.0 * wi.z)),
            d * reference_masking(m, wi, true) / (4.0 * wi.z)};
}

inline ReferenceValue reference_lambert(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    return {to_double(m.diffuse.value) * (wo.z / pi), wo.z / pi};
}

inline ReferenceValue reference_plastic_base(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const double eta = m.eta.x;
    const glm::dvec3 diffuse = to_double(m.diffuse.value);
    const glm::dvec3 tint = m.flags & MATERIAL_NONLINEAR ? diffuse : glm::dvec3{1.0};
    const double transmitted = (1.0 - reference_fresnel_dielectric(wi.z, eta)) *
                               (1.0 - reference_fresnel_dielectric(wo.z, eta)) / (eta * eta);
    return {diffuse / (1.0 - tint * static_cast<double>(m.diffuse_fresnel_internal)) * (transmitted * wo.z / pi),
            wo.z / pi};
}

// glTF 2.0, appendix B.3: mix(fresnel_mix(diffuse, specular), conductor_fresnel(specular), metallic), by its own formulas.
struct GltfTerms {
    double specular_brdf;  // D times the visibility
    double fresnel;        // (1 - |V . H|)^5
    double pdf;
};

inline GltfTerms gltf_terms(::Material m, glm::dvec3 wi, glm::dvec3 wo, const Packed3& anisotropy = unstretched) {
    const double alpha = std::max(static_cast<double>(m.alpha_u.value * m.alpha_u.value), 1e-4);
    // KHR_materials_anisotropy: the axis u turned to the direction, alpha there mix(alpha, 1, strength^2).
    const double strength = anisotropy.z;
    m.alpha_u.value = static_cast<float>(glm::mix(alpha, 1.0, strength * strength));
    m.alpha_v.value = static_cast<float>(alpha);
    m.flags = 0;
    const glm::dvec2 t = glm::normalize(2.0 * glm::dvec2(anisotropy.x, anisotropy.y) - 1.0);
    const glm::dmat3 turn(glm::dvec3(t.x, -t.y, 0), glm::dvec3(t.y, t.x, 0), glm::dvec3(0, 0, 1));
    wi = turn * wi;
    wo = turn * wo;
    const glm::dvec3 h = glm::normalize(wi + wo);
    const double d = reference_density(m, h);
    const double v = reference_masking(m, wi, true) * reference_masking(m, wo, true) / (4.0 * wi.z * wo.z);
    return {d * v, std::pow(1.0 - std::abs(glm::dot(wi, h)), 5.0), d * reference_masking(m, wi, true) / (4.0 * wi.z)};
}

inline ReferenceValue reference_metallic_roughness(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const GltfTerms t = gltf_terms(m, wi, wo);
    const glm::dvec3 f0 = to_double(m.specular.value);
    const glm::dvec3 base = to_double(m.diffuse.value);
    const double metallic = m.metallic.value;
    const double f90 = m.specular_weight;
    const glm::dvec3 dielectric = (f0 + (f90 - f0) * t.fresnel) * t.specular_brdf;
    const glm::dvec3 metal = (base + (1.0 - base) * t.fresnel) * t.specular_brdf;
    return {glm::mix(dielectric, metal, metallic) * wo.z, t.pdf};
}

inline ReferenceValue reference_metallic_roughness_base(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const double fresnel = gltf_terms(m, wi, wo).fresnel;
    const double f0 = std::max({m.specular.value.x, m.specular.value.y, m.specular.value.z});
    const double passed = (1.0 - (f0 + (static_cast<double>(m.specular_weight) - f0) * fresnel)) * (1.0 - static_cast<double>(m.metallic.value));
    return {to_double(m.diffuse.value) * (passed * wo.z / pi), wo.z / pi};
}

// Layers, by the extensions' own formulas but for the coat's Fresnel term, which is taken at the half vector.
struct LayeredTerms {
    GltfTerms surface, coat;
    double coat_fresnel, base_share;  // at the half vector
    double coat_cosine;               // between wo and the normal of the coat
    double coat_chance, surface_chance, through_chance;
    double sheen, sheen_rest;         // BRDF of white sheen, and what it leaves
    double sheen_chance, base_chance; // in their lobe
    MetallicRoughnessLayers layers;
    bool through = false;
};

inline double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

// KHR_materials_sheen, the directional albedo by the same table.
inline double reference_sheen_albedo(const SheenAlbedo& table, double roughness, double cosine) {
    const double least = static_cast<double>(SHEEN_LEAST_ROUGHNESS);
    const double y = (roughness - least) / (1.0 - least) * (SHEEN_ROUGHNESSES - 1), x = std::sqrt(std::min(cosine, 1.0)) * (SHEEN_COSINES - 1);
    const auto row = std::min(static_cast<std::size_t>(y), std::size_t{SHEEN_ROUGHNESSES - 2});
    const auto column = std::min(static_cast<std::size_t>(x), std::size_t{SHEEN_COSINES - 2});
    const auto along = [&](std::size_t r) {
        const float* at = table.at + r * SHEEN_COSINES + column;
        return std::lerp(static_cast<double>(at[0]), static_cast<double>(at[1]), x - static_cast<double>(column));
    };
    return std::lerp(along(row), along(row + 1), y - static_cast<double>(row));
}

inline double reference_sheen(double roughness, const glm::dvec3& wi, const glm::dvec3& wo) {
    const double alpha = roughness * roughness, t = (1.0 - alpha) * (1.0 - alpha);
    const auto fit = [&](double x) {
        return std::lerp(21.5473, 25.3245, t) / (1.0 + std::lerp(3.82987, 3.32435, t) * std::pow(x, std::lerp(0.19823, 0.16801, t))) +
               std::lerp(-1.97760, -1.27393, t) * x + std::lerp(-4.32054, -4.85967, t);
    };
    const auto masking = [&](double c) { return std::exp(c < 0.5 ? fit(c) : 2.0 * fit(0.5) - fit(std::max(1.0 - c, 0.0))); };
    const glm::dvec3 h = glm::normalize(wi + wo);
    const double d = (2.0 + 1.0 / alpha) * std::pow(h.x * h.x + h.y * h.y, 0.5 / alpha) / (2.0 * pi);
    return d / ((1.0 + masking(wi.z) + masking(wo.z)) * 4.0 * wi.z * wo.z);
}

inline std::optional<LayeredTerms> layered_terms(const ::Material& m, glm::dvec3 wi, glm::dvec3 wo) {
    LayeredTerms t{};
    t.layers = extension_of<MetallicRoughnessLayers>(m);
    if (m.flags & MATERIAL_TRANSMISSIVE) {
        if (wi.z < 0.0) wi.z = -wi.z, wo.z = -wo.z;
        if (wo.z < 0.0) t.through = true, wo.z = -wo.z;
    }
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    t.surface = gltf_terms(m, wi, wo, t.layers.anisotropy.value);
    ::Material coat = m;
    coat.alpha_u.value = t.layers.coat_roughness.value;
    // About the coat's own normal.
    const glm::dvec3 n = glm::normalize(2.0 * to_double(t.layers.coat_normal.value) - 1.0);
    const glm::dvec3 s = glm::normalize(glm::cross(glm::abs(n.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0), n));
    const auto on_coat = [&](const glm::dvec3& v) { return glm::dvec3(glm::dot(v, s), glm::dot(v, glm::cross(n, s)), glm::dot(v, n)); };
    const glm::dvec3 coat_wi = on_coat(wi), coat_wo = on_coat(wo);
    if (coat_wi.z > 0.0 && coat_wo.z > 0.0) t.coat = gltf_terms(coat, coat_wi, coat_wo), t.coat_cosine = coat_wo.z;
    const double specular = t.layers.specular.value;
    const glm::dvec3 f0 = glm::min(to_double(t.layers.specular_color.value), glm::dvec3(1.0)) * specular;
    const double metallic = m.metallic.value;
    const auto coat_fresnel = [&](double weight) { return static_cast<double>(t.layers.coat.value) * (0.04 + 0.96 * weight); };
    const auto base_share = [&](double weight) { return (1.0 - coat_fresnel(weight)) * (1.0 - metallic) * (1.0 - largest(f0 + (specular - f0) * weight)); };
    t.coat_fresnel = coat_fresnel(t.surface.fresnel);
    t.base_share = base_share(t.surface.fresnel);
    const double weight = std::pow(1.0 - wi.z, 5.0);
    const glm::dvec3 base = to_double(m.diffuse.value);
    const glm::dvec3 reflectance = glm::mix(f0 + (specular - f0) * weight, base + (1.0 - base) * weight, metallic);
    SheenAlbedo table;
    std::memcpy(&table, &lobe_extensions()[m.extension + t.layers.sheen_albedo], sizeof table);
    const double roughness = std::max(t.layers.sheen_roughness.value, SHEEN_LEAST_ROUGHNESS);
    const double sheen_color = largest(to_double(t.layers.sheen_color.value));
    const double seen = reference_sheen_albedo(table, roughness, wi.z), most = std::max(seen, reference_sheen_albedo(table, roughness, wo.z));
    const double seen_rest = 1.0 - sheen_color * std::min(seen, 1.0);
    t.sheen = reference_sheen(roughness, wi, wo) / std::max(most, 1.0);
    t.sheen_rest = 1.0 - sheen_color * std::min(most, 1.0);
    t.sheen_chance = (1.0 - coat_fresnel(weight)) * (1.0 - seen_rest);
    t.base_chance = (1.0 - static_cast<double>(t.layers.transmission.value)) * base_share(weight) * largest(base) * seen_rest;
    const double c = coat_wi.z > 0.0 ? coat_fresnel(std::pow(1.0 - std::min(coat_wi.z, 1.0), 5.0)) : 0.0;
    const double r = (1.0 - coat_fresnel(weight)) * largest(reflectance) * seen_rest;
    const double p = static_cast<double>(t.layers.transmission.value) * base_share(weight) * largest(base) * seen_rest;
    if (c + r + p > 0.0) t.coat_chance = c / (c + r + p), t.surface_chance = r / (c + r + p), t.through_chance = p / (c + r + p);
    return t;
}

inline ReferenceValue reference_layered(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    const auto t = layered_terms(m, wi, wo);
    if (!t || t->coat_chance + t->surface_chance + t->through_chance == 0.0) return {};
    const glm::dvec3 base = to_double(m.diffuse.value);
    const double cosine = std::abs(wo.z);
    if (t->through)
        return {base * (static_cast<double>(t->layers.transmission.value) * t->base_share * t->surface.specular_brdf * t->sheen_rest * cosine),
                t->through_chance * t->surface.pdf};
    const double specular = t->layers.specular.value;
    const glm::dvec3 f0 = glm::min(to_double(t->layers.specular_color.value), glm::dvec3(1.0)) * specular;
    const double w = t->surface.fresnel;
    const glm::dvec3 reflectance = glm::mix(f0 + (specular - f0) * w, base + (1.0 - base) * w, static_cast<double>(m.metallic.value));
    const glm::dvec3 value = reflectance * ((1.0 - t->coat_fresnel) * t->surface.specular_brdf * t->sheen_rest * cosine) + t->coat_fresnel * t->coat.specular_brdf * t->coat_cosine;
    return {value, t->surface_chance * t->surface.pdf + t->coat_chance * t->coat.pdf};
}

inline ReferenceValue reference_layered_base(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    const auto t = layered_terms(m, wi, wo);
    if (!t || t->through) return {};
    const double share = (1.0 - static_cast<double>(t->layers.transmission.value)) * t->base_share;
    return {to_double(m.diffuse.value) * (share * std::abs(wo.z) / pi), std::abs(wo.z) / pi};
}

inline ReferenceValue reference_sheen_base(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    const auto t = layered_terms(m, wi, wo);
    if (!t || t->through) return {};
    const double cosine = std::abs(wo.z);
    const double base = (1.0 - static_cast<double>(t->layers.transmission.value)) * t->base_share * t->sheen_rest / pi;
    const glm::dvec3 value = to_double(t->layers.sheen_color.value) * ((1.0 - t->coat_fresnel) * t->sheen) + to_double(m.diffuse.value) * base;
    return {value * cosine, (t->sheen_chance * 0.5 + t->base_chance * cosine) / ((t->sheen_chance + t->base_chance) * pi)};
}

inline double reference_rough_transmittance(const ::Material& m, double cosine) {
    const auto& table = extension_of<RoughTransmittance>(m).at;
    const double at = std::min(cosine, 1.0) * (ROUGH_TRANSMITTANCE_STEPS - 1);
    const auto step = std::min(static_cast<std::size_t>(at), std::size_t{ROUGH_TRANSMITTANCE_STEPS - 2});
    const double share = at - static_cast<double>(step);
    return (1.0 - share) * table[step] + share * table[step + 1];
}

inline ReferenceValue reference_rough_plastic_base(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const double eta = m.eta.x;
    const glm::dvec3 diffuse = to_double(m.diffuse.value);
    const glm::dvec3 tint = m.flags & MATERIAL_NONLINEAR ? diffuse : glm::dvec3{1.0};
    const double transmitted =
        reference_rough_transmittance(m, wi.z) * reference_rough_transmittance(m, wo.z) / (eta * eta);
    return {diffuse / (1.0 - tint * static_cast<double>(m.diffuse_fresnel_internal)) * (transmitted * wo.z / pi),
            wo.z / pi};
}

using ReferenceEval = std::function<ReferenceValue(const ::Material&, const glm::dvec3&, const glm::dvec3&)>;

// By the name of the lobe.
inline const std::map<std::string, ReferenceEval>& reference_evals() {
    static const std::map<std::string, ReferenceEval> evals{
        {"rough_conductor", reference_rough_conductor}, {"rough_dielectric", reference_rough_dielectric},
        {"phong", reference_phong},                     {"lambert", reference_lambert},
        {"plastic_base", reference_plastic_base},       {"metallic_roughness", reference_metallic_roughness},
        {"metallic_roughness_base", reference_metallic_roughness_base},
        {"layered_metallic_roughness", reference_layered},
        {"layered_metallic_roughness_base", reference_layered_base},
        {"sheen_metallic_roughness_base", reference_sheen_base},
        {"plastic_base", reference_plastic_base},       {"rough_plastic_coat", reference_rough_plastic_coat},
        {"rough_plastic_base", reference_rough_plastic_base}, {"ward", reference_ward},
        {"principled", reference_principled},           {"principled_base", reference_principled_base},
        {"principled_thin", reference_principled_thin}, {"principled_thin_base", reference_principled_thin_base},
    };
    return evals;
}

// ---- delta lobes --------------------------------------------------------------------------------------------

// What a delta lobe may do, in the order in which a rising random number chooses.
struct DeltaBranch {
    double probability;
    glm::dvec3 wo;
    glm::dvec3 weight;
    double eta;
};

inline glm::dvec3 mirrored(const glm::dvec3& wi) { return {-wi.x, -wi.y, wi.z}; }

inline std::vector<DeltaBranch> reference_mirror(const ::Material& m, const glm::dvec3& wi) {
    const glm::dvec3 f = wi.z > 0.0 ? reference_fresnel_conductor(m, wi.z) : glm::dvec3{0.0};
    return {{1.0, mirrored(wi), to_double(m.specular.value) * f, 1.0}};
}

inline std::vector<DeltaBranch> reference_dielectric(const ::Material& m, const glm::dvec3& wi) {
    const double f = reference_fresnel_dielectric(wi.z, m.eta.x);
    const double eta = wi.z >= 0.0 ? m.eta.x : 1.0 / m.eta.x;
    const double cos_t = std::sqrt(std::max(1.0 - (1.0 - wi.z * wi.z) / (eta * eta), 0.0));
    return {{f, mirrored(wi), to_double(m.specular.value), 1.0},
            {1.0 - f,
             {-wi.x / eta, -wi.y / eta, wi.z >= 0.0 ? -cos_t : cos_t},
             to_double(m.transmission.value) / (eta * eta),
             eta}};
}

inline std::vector<DeltaBranch> reference_thin_dielectric(const ::Material& m, const glm::dvec3& wi) {
    const double r = reference_fresnel_dielectric(std::abs(wi.z), m.eta.x);
    // r + t r t (1 + r^2 + r^4 + ...) with t = 1 - r
    const double pane = r + (1.0 - r) * r / (1.0 + r);
    return {{pane, mirrored(wi), to_double(m.specular.value), 1.0},
            {1.0 - pane, -wi, to_double(m.transmission.value), 1.0}};
}

inline std::vector<DeltaBranch> reference_plastic_coat(const ::Material& m, const glm::dvec3& wi) {
    const double f = wi.z > 0.0 ? reference_fresnel_dielectric(wi.z, m.eta.x) : 0.0;
    return {{1.0, mirrored(wi), to_double(m.specular.value) * f, 1.0}};
}

using ReferenceDelta = std::function<std::vector<DeltaBranch>(const ::Material&, const glm::dvec3&)>;

inline const std::map<std::string, ReferenceDelta>& reference_deltas() {
    static const std::map<std::string, ReferenceDelta> deltas{
        {"mirror", reference_mirror},
        {"dielectric", reference_dielectric},
        {"thin_dielectric", reference_thin_dielectric},
        {"plastic_coat", reference_plastic_coat},
    };
    return deltas;
}

}  // namespace wavelobe::test
