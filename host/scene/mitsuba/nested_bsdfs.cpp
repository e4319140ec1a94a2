#include "scene/mitsuba/nested_bsdfs.h"

#include <algorithm>
#include <utility>

namespace wavelobe::mitsuba {

namespace {

NestedMaterial named(Query& query, MaterialModel model) {
    return std::make_shared<const Material>(Material{std::move(model), query.object().id});
}

bool holds_others(const NestedMaterial& material) {
    if (material == nullptr) return false;
    const MaterialModel& model = material->model;
    return std::holds_alternative<NormalMapped>(model) || std::holds_alternative<BumpMapped>(model) ||
           std::holds_alternative<TwoSided>(model) || std::holds_alternative<Blend>(model);
}

// The nested BSDFs, from `fewest` to `most` of them; none where there is a fault, which is then on record.
std::vector<Bsdf> nested_bsdfs(Query& query, std::size_t fewest, std::size_t most, const std::string& expected) {
    const std::vector<const Child*> nested = query.children("bsdf");
    if (query.has_unresolved_children()) return {};
    if (nested.size() < fewest || nested.size() > most) {
        query.fault("holds " + std::to_string(nested.size()) + " nested BSDFs; expected " + expected, "");
        return {};
    }
    std::vector<Bsdf> found;
    for (const Child* child : nested) found.push_back(read_bsdf(query.context(), *child->object));
    const bool usable = std::all_of(found.begin(), found.end(), [](const Bsdf& b) { return b.front != nullptr; });
    return usable ? found : std::vector<Bsdf>{};
}

// A BSDF inside a material that keeps its frame.
NestedMaterial inside(Query& query, const Bsdf& bsdf) {
    return bsdf.turned ? named(query, TwoSided{bsdf.front, bsdf.back}) : bsdf.front;
}

bool is_constant(const Opacity& opacity) { return opacity.value.texture == nullptr && !opacity.cutoff; }
bool is_everywhere(const Opacity& opacity, float value) { return is_constant(opacity) && opacity.value.value.x == value; }

NormalPerturbation perturbation(Query& query) {
    NormalPerturbation p;
    p.flip_invalid = query.boolean("flip_invalid_normals", true);
    p.soften_terminator = query.boolean("use_shadowing_function", true);
    return p;
}

// A map around a BSDF: it shows on both sides as much as that does.
Bsdf around(const Bsdf& nested, NestedMaterial material) { return {material, material, nested.transmissive, nested.opacity}; }

// 1 minus a texture of one channel.
std::shared_ptr<const Texture> inverted(Query& query, const Texture& texture) {
    if (auto attribute = query.context().mesh_attributes.inverted(texture)) return attribute;
    auto out = std::make_shared<Texture>(texture);
    if (auto* board = std::get_if<Checkerboard>(&out->source)) {
        *board = {Rgb(1.0F) - board->color0, Rgb(1.0F) - board->color1};
    } else {
        for (float& texel : std::get<Bitmap>(out->source).rgb) texel = 1.0F - texel;
    }
    return out;
}

}  // namespace

Bsdf read_normal_map(Query& query) {
    NormalMapped map;
    map.perturbation = perturbation(query);
    if (query.has("normalmap")) map.normals = query.parameter("normalmap", 0.5, ColourUse::unbounded);
    else query.fault("the texture `normalmap` is missing", "nest a <texture name=\"normalmap\" type=\"bitmap\">");
    const std::vector<Bsdf> nested = nested_bsdfs(query, 1, 1, "one, whose normals are changed");
    if (nested.empty()) return {};
    map.nested = inside(query, nested.front());
    return around(nested.front(), named(query, map));
}

Bsdf read_bump_map(Query& query) {
    BumpMapped map;
    map.perturbation = perturbation(query);
    map.scale = static_cast<float>(query.real("scale", 1.0));
    const std::vector<const Child*> textures = query.children("texture");
    const std::vector<Bsdf> nested = nested_bsdfs(query, 1, 1, "one, whose surface is raised");
    if (query.has_unresolved_children()) return {};
    if (textures.size() != 1) {
        query.fault("holds " + std::to_string(textures.size()) + " nested textures; expected one, of heights", "");
        return {};
    }
    map.height = read_texture(query.context(), *textures.front()->object, TextureUse::scalar);
    if (nested.empty() || map.height == nullptr) return {};
    if (query.context().attribute_textures.contains(map.height.get()))
        query.fault("attributes of meshes have no slope", "nest a bitmap");
    if (!std::holds_alternative<Bitmap>(map.height->source)) query.warn("the texture is of no slope, the surface stays flat");
    map.nested = inside(query, nested.front());
    return around(nested.front(), named(query, map));
}

Bsdf read_twosided(Query& query) {
    const bool transmits = query.boolean("allow_transmission", false);
    const std::vector<Bsdf> nested = nested_bsdfs(query, 1, 2, "one for both sides, or one for each");
    if (nested.empty()) return {};
    const Bsdf& front = nested.front();
    const Bsdf& back = nested.back();
    if (!transmits && (front.transmissive || back.transmissive)) {
        query.fault("holds a BSDF that transmits light; only opaque ones can be nested",
                    "use the dielectric without `twosided`: it has two sides already");
        return {};
    }
    if (nested.size() == 2 && !(is_everywhere(front.opacity, 1.0F) && is_everywhere(back.opacity, 1.0F))) {
        query.fault("holds masks; its two sides cannot be there in different places", "put the mask around it");
        return {};
    }
    if (!front.transmissive && !back.transmissive && !holds_others(front.front) && !holds_others(back.front))
        return {front.front, back.front, false, front.opacity, true};
    const NestedMaterial both = named(query, TwoSided{front.front, back.front});
    return {both, both, front.transmissive || back.transmissive, front.opacity};
}

Bsdf read_blend(Query& query) {
    if (!query.has("weight")) query.fault("the property `weight` is missing", "give it as <float> or nest a <texture name=\"weight\">");
    Blend blend;
    blend.weight = query.scalar_parameter("weight", 0.5, {});
    const std::vector<Bsdf> nested = nested_bsdfs(query, 2, 2, "two, to blend");
    if (nested.empty()) return {};
    const Bsdf& first = nested[0];
    const Bsdf& second = nested[1];
    const bool varies = blend.weight.texture != nullptr;
    const float weight = std::clamp(blend.weight.value.x, 0.0F, 1.0F);

    // What is there of the blend, and which share of that is the second.
    Opacity opacity;
    const float there = is_constant(first.opacity) ? std::clamp(first.opacity.value.value.x, 0.0F, 1.0F) : -1.0F;
    const float second_there = is_constant(second.opacity) ? std::clamp(second.opacity.value.value.x, 0.0F, 1.0F) : -2.0F;
    if (there == second_there) {
        opacity = first.opacity;
    } else if (varies && there == 0.0F && second_there == 1.0F) {
        opacity.value = blend.weight;
        blend.weight = Parameter{Rgb(1.0F), nullptr};
    } else if (varies && there == 1.0F && second_there == 0.0F) {
        opacity.value = {Rgb(0.0F), inverted(query, *blend.weight.texture)};
        blend.weight = Parameter{Rgb(0.0F), nullptr};
    } else if (!varies && there >= 0.0F && second_there >= 0.0F) {
        const float of_second = weight * second_there;
        const float all = (1.0F - weight) * there + of_second;
        opacity.value.value = Rgb(all);
        blend.weight.value = Rgb(all > 0.0F ? of_second / all : 0.0F);
    } else {
        query.fault("blends BSDFs of which one is masked by a texture; how much of the blend is there cannot be told",
                    "put the mask around the blend");
        return {};
    }
    blend.first = inside(query, first);
    blend.second = inside(query, second);
    const bool behind = first.back != nullptr || second.back != nullptr;
    const NestedMaterial material = named(query, blend);
    return {material, behind ? material : nullptr, first.transmissive || second.transmissive, opacity};
}

Bsdf read_mask(Query& query) {
    const Parameter opacity = query.scalar_parameter("opacity", 0.5, {});
    for (const Child& child : query.object().children) {
        if (child.object == nullptr || child.object->type != "mask") continue;
        query.children("bsdf");
        query.fault("holds another mask; only one can be applied", "multiply the two opacities into one mask");
        return {};
    }
    const std::vector<Bsdf> nested = nested_bsdfs(query, 1, 1, "one, which `opacity` masks");
    if (nested.empty()) return {};
    Bsdf masked = nested.front();
    masked.transmissive = true;
    // A mask of nothing is nothing.
    if (is_everywhere(masked.opacity, 1.0F)) masked.opacity.value = opacity;
    else if (!is_everywhere(masked.opacity, 0.0F))
        query.fault("holds a BSDF that is masked itself; only one mask can be applied", "multiply the two opacities into one mask");
    return masked;
}

// A surface that is not there. Where it emits, it is black otherwise.
Bsdf read_null(Query& query) {
    const NestedMaterial black = named(query, Diffuse{Parameter{Rgb(0.0F), nullptr}});
    Bsdf nothing{black, black, true};
    nothing.opacity.value.value = Rgb(0.0F);
    return nothing;
}

}  // namespace wavelobe::mitsuba
