// The lobes of Ward and of the principled materials in double precision, by the formulas of their papers and of Mitsuba 3.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/lobe_reference_base.h"

namespace wavelobe::test {

inline ReferenceValue reference_ward(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const double au = m.alpha_u.value, av = m.alpha_v.value;
    const glm::dvec3 h = wi + wo, n = glm::normalize(h);
    const double g = std::exp(-(std::pow(n.x / au, 2) + std::pow(n.y / av, 2)) / (n.z * n.z)) / (pi * au * av);
    double norm = glm::dot(h, h) / std::pow(h.z, 4);
    if (m.flags & MATERIAL_WARD_CLASSIC) norm = 1.0 / (4.0 * std::sqrt(wi.z * wo.z));
    if (m.flags & MATERIAL_WARD_DUER) norm = 1.0 / (4.0 * wi.z * wo.z);
    // The cosine of wi and n, of unit directions: that floats are so to a rounding only must not turn its sign at the horizon.
    const double cosine = 0.5 * glm::length(h);
    return {to_double(m.specular.value) * (g * norm * wo.z), g / (4.0 * cosine * std::pow(n.z, 3))};
}

struct PrincipledTerms {
    PrincipledParameters p;
    ::Material microfacets;
    glm::dvec3 base, tint;
    double metallic;

    explicit PrincipledTerms(const ::Material& m, double roughness_scale = 1.0)
        : p(extension_of<PrincipledParameters>(m)), microfacets(m), base(to_double(m.diffuse.value)), metallic(m.metallic.value) {
        const double r = roughness_scale * m.alpha_u.value;
        const double aspect = std::sqrt(1.0 - 0.9 * p.anisotropic.value);
        microfacets.flags = 0;
        microfacets.alpha_u.value = static_cast<float>(std::max(0.001, r * r / aspect));
        microfacets.alpha_v.value = static_cast<float>(std::max(0.001, r * r * aspect));
        tint = base / (0.212671 * base.x + 0.715160 * base.y + 0.072169 * base.z);
    }
};

inline double schlick(double cosine) { return std::pow(std::clamp(1.0 - cosine, 0.0, 1.0), 5.0); }

inline double interface_schlick(double cos_i, double eta) {
    const double eta_it = cos_i >= 0.0 ? eta : 1.0 / eta;
    if (eta_it > 1.0) return schlick(std::abs(cos_i));
    return schlick(std::sqrt(std::max(1.0 - (1.0 - cos_i * cos_i) / (eta_it * eta_it), 0.0)));
}

inline glm::dvec3 lerp(const glm::dvec3& a, const glm::dvec3& b, double t) { return a * (1.0 - t) + b * t; }

inline ReferenceValue reference_principled(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z == 0.0 || wo.z == 0.0) return {};
    const PrincipledTerms t(m);
    const bool front = wi.z > 0.0, reflects = wi.z * wo.z > 0.0;
    const double refracting = (1.0 - t.metallic) * t.p.spec_trans.value;
    if (!front && refracting == 0.0) return {};
    const double eta = front ? m.eta.x : 1.0 / m.eta.x;
    glm::dvec3 h = glm::normalize(reflects ? wi + wo : wi + eta * wo);
    if (h.z < 0.0) h = -h;
    const double cos_i = glm::dot(wi, h), cos_o = glm::dot(wo, h);
    if (cos_i * wi.z <= 0.0 || cos_o * wo.z <= 0.0) return {};
    const double fresnel = reference_fresnel_dielectric(cos_i, m.eta.x);
    const double d = reference_density(t.microfacets, h);
    const double gi = reference_masking(t.microfacets, wi, true), go = reference_masking(t.microfacets, wo, true);
    const double through = front ? refracting * (1.0 - fresnel) : 1.0 - fresnel;
    if (!reflects) {
        const double sum = cos_i + eta * cos_o;
        const double jacobian = std::abs(cos_i * cos_o / wi.z) / (sum * sum);
        return {glm::sqrt(t.base) * (refracting * (1.0 - fresnel) * d * gi * go * jacobian),
                through * d * gi * eta * eta * jacobian / (front ? 1.0 + 0.25 * t.p.clearcoat.value : 1.0)};
    }
    ReferenceValue v{glm::dvec3(refracting * fresnel), (1.0 - through) * d * gi / (4.0 * std::abs(wi.z))};
    if (front) {
        const double weight = interface_schlick(cos_i, m.eta.x), tinted = t.p.spec_tint.value;
        const double r0 = std::pow((m.eta.x - 1.0) / (m.eta.x + 1.0), 2.0);
        v.f_cos = t.metallic * lerp(t.base, glm::dvec3(1.0), weight) +
                  (1.0 - t.metallic) * (tinted * lerp(t.tint * r0, glm::dvec3(1.0), weight) + glm::dvec3((1.0 - tinted) * fresnel));
    }
    v.f_cos *= d * gi * go / (4.0 * std::abs(wi.z));
    const double coat = 0.25 * t.p.clearcoat.value;
    if (!front || coat == 0.0) return v;
    const double a2 = std::pow(0.1 + (0.001 - 0.1) * t.p.clearcoat_gloss.value, 2.0);
    const double sin2 = h.x * h.x + h.y * h.y;
    const double dc = (a2 - 1.0) / (pi * std::log(a2) * (sin2 + a2 * h.z * h.z));
    const auto g1 = [](double z) { return 2.0 / (1.0 + std::sqrt(1.0 + 0.0625 * (1.0 - z * z) / (z * z))); };
    const double fc = 0.04 + 0.96 * interface_schlick(cos_i, m.eta.x);
    v.f_cos += coat * fc * dc * g1(wi.z) * g1(wo.z) * wo.z;
    v.pdf = (v.pdf + coat * dc * h.z / (4.0 * cos_o)) / (1.0 + coat);
    return v;
}

// The diffuse part of both, of directions above the surface.
inline glm::dvec3 reference_principled_diffuse(const PrincipledTerms& t, double roughness, const glm::dvec3& wi, const glm::dvec3& wo,
                                               double scattering, double sheen) {
    const double fo = schlick(wo.z), fi = schlick(wi.z), cos_d = glm::dot(glm::normalize(wi + wo), wo);
    const double diffuse = (1.0 - 0.5 * fi) * (1.0 - 0.5 * fo), rr = 2.0 * roughness * cos_d * cos_d;
    const double retro = rr * (fo + fi + fo * fi * (rr - 1.0));
    const double below = (1.0 + (0.5 * rr - 1.0) * fo) * (1.0 + (0.5 * rr - 1.0) * fi);
    const double flat = 1.25 * (below * (1.0 / (wo.z + wi.z) - 0.5) + 0.5);
    const double flatness = t.p.flatness.value;
    const glm::dvec3 sheen_color = lerp(glm::dvec3(1.0), t.tint, t.p.sheen_tint.value) * static_cast<double>(t.p.sheen.value);
    return wo.z * (scattering * t.base / pi * ((1.0 - flatness) * (diffuse + retro) + flatness * flat) + sheen * schlick(std::abs(cos_d)) * sheen_color);
}

inline ReferenceValue reference_principled_base(const ::Material& m, const glm::dvec3& wi, const glm::dvec3& wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return {};
    const PrincipledTerms t(m);
    const double rest = 1.0 - t.metallic;
    return {reference_principled_diffuse(t, m.alpha_u.value, wi, wo, rest * (1.0 - t.p.spec_trans.value), rest), wo.z / pi};
}

inline ReferenceValue reference_principled_thin(const ::Material& m, glm::dvec3 wi, glm::dvec3 wo) {
    if (wi.z == 0.0 || wo.z == 0.0) return {};
    if (wi.z < 0.0) wi = -wi, wo = -wo;
    const bool reflects = wo.z > 0.0;
    const double eta = extension_of<PrincipledParameters>(m).eta.value;
    const PrincipledTerms t(m, reflects ? 1.0 : 0.65 * eta - 0.35);
    const glm::dvec3 folded{wo.x, wo.y, std::abs(wo.z)};
    const glm::dvec3 h = glm::normalize(wi + folded);
    if (!reflects && glm::dot(wo, h) >= 0.0) return {};
    const double cos_i = glm::dot(wi, h), fresnel = reference_fresnel_dielectric(cos_i, eta);
    const double d = reference_density(t.microfacets, h), gi = reference_masking(t.microfacets, wi, true);
    const double go = reference_masking(t.microfacets, folded, true), r0 = std::pow((eta - 1.0) / (eta + 1.0), 2.0);
    const glm::dvec3 tinted = lerp(t.tint * r0, glm::dvec3(1.0), interface_schlick(cos_i, eta));
    const glm::dvec3 color = reflects ? lerp(glm::dvec3(fresnel), tinted, t.p.spec_tint.value) : t.base * (1.0 - fresnel);
    return {color * (t.p.spec_trans.value * d * gi * go / (4.0 * wi.z)), 0.5 * d * gi / (4.0 * wi.z)};
}

inline ReferenceValue reference_principled_thin_base(const ::Material& m, glm::dvec3 wi, glm::dvec3 wo) {
    if (wi.z == 0.0 || wo.z == 0.0) return {};
    if (wi.z < 0.0) wi = -wi, wo = -wo;
    const PrincipledTerms t(m);
    const double through = 0.5 * t.p.diff_trans.value, scattering = 1.0 - t.p.spec_trans.value;
    const double cosine = std::abs(wo.z) / pi;
    if (wo.z < 0.0) return {t.base * (scattering * through * cosine), through * cosine};
    const double reflecting = scattering * (1.0 - through);
    return {reference_principled_diffuse(t, m.alpha_u.value, wi, wo, reflecting, reflecting), (1.0 - through) * cosine};
}

}  // namespace wavelobe::test
