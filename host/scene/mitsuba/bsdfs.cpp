// The BSDF plugins.
#include <algorithm>
#include <array>
#include <utility>

#include "scene/conductors.h"
#include "scene/mitsuba/nested_bsdfs.h"
#include "scene/mitsuba/principled.h"
#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

enum class Sides { front, both };

Bsdf make(Query& query, MaterialModel model, Sides sides) {
    auto material = std::make_shared<const Material>(Material{std::move(model), query.object().id});
    const bool both = sides == Sides::both;
    return {material, both ? material : nullptr, both};
}

Parameter reflectance(Query& query, const std::string& name, double otherwise) {
    return query.parameter(name, otherwise, ColourUse::reflectance);
}

struct Index {
    Rgb eta{0.0F};
    Rgb k{1.0F};
};

Index conductor_index(Query& query) {
    const std::string material = query.text("material", "none");
    const Index given{query.colour("eta", 0.0, ColourUse::unbounded), query.colour("k", 1.0, ColourUse::unbounded)};
    if (material == "none") return given;
    if (query.has("eta") || query.has("k"))
        query.fault("both `material` and `eta`, `k` are given", "keep one of the two");
    const NamedConductor* named = find_conductor(material);
    if (named == nullptr) {
        query.fault_at(
            "material",
            "`" + material + "` is no conductor known here; expected one of " + quoted_list(conductor_names()),
            suggestion(material, conductor_names()));
        return {};
    }
    return {Rgb(named->eta[0], named->eta[1], named->eta[2]), Rgb(named->k[0], named->k[1], named->k[2])};
}

float relative_index(Query& query, const std::string& interior) {
    const double inside = query.refractive_index("int_ior", interior);
    return static_cast<float>(inside / query.refractive_index("ext_ior", "air"));
}

struct Roughness {
    Parameter alpha_u, alpha_v;
    Distribution distribution = Distribution::beckmann;
};

Distribution distribution(Query& query) {
    query.boolean("sample_visible", true);
    return query.choice("distribution", {"beckmann", "ggx"}, 0) == 0 ? Distribution::beckmann : Distribution::ggx;
}

Roughness alphas(Query& query) {
    Roughness result;
    const bool two = query.has("alpha_u") || query.has("alpha_v");
    if (two && !(query.has("alpha_u") && query.has("alpha_v")))
        query.fault("only one of `alpha_u` and `alpha_v` is given", "give both, or `alpha` alone");
    if (two && query.has("alpha"))
        query.fault("`alpha` is given along with `alpha_u` and `alpha_v`", "keep one of the two forms");
    // Smoother surfaces are clamped, as the microfacet models of Mitsuba are.
    const auto alpha_of = [&](const std::string& name) {
        Parameter alpha = query.scalar_parameter(name, 0.1, not_negative);
        alpha.value = glm::max(alpha.value, Rgb(1e-4F));
        return alpha;
    };
    const Parameter alpha = alpha_of("alpha");
    const Parameter alpha_u = alpha_of("alpha_u");
    const Parameter alpha_v = alpha_of("alpha_v");
    result.alpha_u = two ? alpha_u : alpha;
    result.alpha_v = two ? alpha_v : alpha;
    return result;
}

Roughness roughness(Query& query) {
    Roughness result = alphas(query);
    result.distribution = distribution(query);
    return result;
}

Bsdf read_diffuse(Query& query) {
    return make(query, Diffuse{reflectance(query, "reflectance", 0.5)}, Sides::front);
}

Bsdf read_conductor(Query& query) {
    const Index index = conductor_index(query);
    return make(query, Conductor{index.eta, index.k, reflectance(query, "specular_reflectance", 1.0)},
                Sides::front);
}

Bsdf read_rough_conductor(Query& query) {
    const Index index = conductor_index(query);
    const Roughness rough = roughness(query);
    return make(query,
                RoughConductor{index.eta, index.k, reflectance(query, "specular_reflectance", 1.0), rough.alpha_u,
                               rough.alpha_v, rough.distribution},
                Sides::front);
}

Bsdf read_dielectric(Query& query) {
    const float eta = relative_index(query, "bk7");
    const Parameter reflected = reflectance(query, "specular_reflectance", 1.0);
    return make(query, Dielectric{eta, reflected, reflectance(query, "specular_transmittance", 1.0)}, Sides::both);
}

Bsdf read_thin_dielectric(Query& query) {
    const float eta = relative_index(query, "bk7");
    const Parameter reflected = reflectance(query, "specular_reflectance", 1.0);
    return make(query, ThinDielectric{eta, reflected, reflectance(query, "specular_transmittance", 1.0)},
                Sides::both);
}

Bsdf read_rough_dielectric(Query& query) {
    const float eta = relative_index(query, "bk7");
    if (eta == 1.0F)
        query.fault("the indices of refraction inside and outside are equal", "let `int_ior` and `ext_ior` differ");
    const Parameter reflected = reflectance(query, "specular_reflectance", 1.0);
    const Parameter transmitted = reflectance(query, "specular_transmittance", 1.0);
    const Roughness rough = roughness(query);
    return make(query,
                RoughDielectric{eta, reflected, transmitted, rough.alpha_u, rough.alpha_v, rough.distribution},
                Sides::both);
}

Bsdf read_plastic(Query& query) {
    const float eta = relative_index(query, "polypropylene");
    const Parameter diffuse = reflectance(query, "diffuse_reflectance", 0.5);
    const Parameter specular = reflectance(query, "specular_reflectance", 1.0);
    return make(query, Plastic{eta, diffuse, specular, query.boolean("nonlinear", false)}, Sides::front);
}

Bsdf read_rough_plastic(Query& query) {
    RoughPlastic m;
    m.eta = relative_index(query, "polypropylene");
    if (m.eta == 1.0F)
        query.fault("the indices of refraction inside and outside are equal", "let `int_ior` and `ext_ior` differ");
    m.diffuse_reflectance = reflectance(query, "diffuse_reflectance", 0.5);
    m.specular_reflectance = reflectance(query, "specular_reflectance", 1.0);
    m.nonlinear = query.boolean("nonlinear", false);
    m.distribution = distribution(query);
    for (const char* name : {"alpha_u", "alpha_v"})
        if (query.has(name)) query.fault_at(name, "rough plastic is isotropic", "give `alpha` alone");
    m.alpha = static_cast<float>(std::max(query.real("alpha", 0.1, not_negative), 1e-4));
    return make(query, m, Sides::front);
}

// Plugins of Mitsuba 0.x, whose spelling of the names is accepted next to today's.
Parameter either(Query& query, const std::string& name, const std::string& old_name, double otherwise) {
    if (query.has(name) && query.has(old_name))
        query.fault("both `" + name + "` and `" + old_name + "` are given", "keep one of the two");
    const Parameter old_spelling = reflectance(query, old_name, otherwise);
    const Parameter new_spelling = reflectance(query, name, otherwise);
    return query.has(old_name) ? old_spelling : new_spelling;
}

Bsdf read_phong(Query& query) {
    const Parameter diffuse = either(query, "diffuse_reflectance", "diffuseReflectance", 0.5);
    const Parameter specular = either(query, "specular_reflectance", "specularReflectance", 0.2);
    return make(query, Phong{diffuse, specular, query.scalar_parameter("exponent", 30.0, not_negative)},
                Sides::front);
}

Bsdf read_ward(Query& query) {
    constexpr std::array variants{Ward::Variant::ward, Ward::Variant::ward_duer, Ward::Variant::balanced};
    Ward m;
    m.variant = variants[query.choice("variant", {"ward", "ward-duer", "balanced"}, 2)];
    m.diffuse_reflectance = either(query, "diffuse_reflectance", "diffuseReflectance", 0.5);
    m.specular_reflectance = either(query, "specular_reflectance", "specularReflectance", 0.2);
    const Roughness rough = alphas(query);
    m.alpha_u = rough.alpha_u;
    m.alpha_v = rough.alpha_v;
    return make(query, m, Sides::front);
}

struct Plugin {
    const char* name;
    Bsdf (*read)(Query&);
};
constexpr std::array<Plugin, 18> plugins{{
    {"blendbsdf", read_blend},
    {"bumpmap", read_bump_map},
    {"conductor", read_conductor},
    {"dielectric", read_dielectric},
    {"diffuse", read_diffuse},
    {"mask", read_mask},
    {"normalmap", read_normal_map},
    {"null", read_null},
    {"phong", read_phong},
    {"plastic", read_plastic},
    {"principled", read_principled},
    {"principledthin", read_principled_thin},
    {"roughconductor", read_rough_conductor},
    {"roughdielectric", read_rough_dielectric},
    {"roughplastic", read_rough_plastic},
    {"thindielectric", read_thin_dielectric},
    {"twosided", read_twosided},
    {"ward", read_ward},
}};

}  // namespace

Bsdf read_bsdf(Context& context, const Object& object) {
    const auto known = context.bsdfs.find(&object);
    if (known != context.bsdfs.end()) {
        context.attributes.insert(known->second.attributes.begin(), known->second.attributes.end());
        return known->second;
    }
    Bsdf bsdf;
    std::set<AttributeUse> outer = std::exchange(context.attributes, {});
    constexpr int most_levels = 16;
    if (context.bsdf_levels == most_levels) {
        context.faults.add(object.place, object.label(),
                           "BSDFs are nested more than " + std::to_string(most_levels) + " deep", "nest fewer of them");
    } else if (const auto* plugin = find_plugin(context, object, plugins)) {
        Query query(context, object);
        ++context.bsdf_levels;
        bsdf = plugin->read(query);
        --context.bsdf_levels;
        query.finish();
    }
    bsdf.attributes = context.attributes;
    context.attributes.merge(outer);
    return context.bsdfs[&object] = bsdf;
}

Bsdf default_bsdf(Context& context, bool emitter) {
    auto& material = emitter ? context.black_material : context.default_material;
    if (material == nullptr)
        material =
            std::make_shared<const Material>(Material{Diffuse{Parameter{Rgb(emitter ? 0.0F : 0.5F), nullptr}}, ""});
    return {material, nullptr, false};
}

std::vector<std::string> bsdf_types() { return names_of(plugins); }

}  // namespace wavelobe::mitsuba
