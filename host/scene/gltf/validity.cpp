#include "scene/gltf/validity.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "scene/gltf/textures.h"

namespace wavelobe::gltf {

namespace {

// Where an extension may stand: owners, each item of a list as `#`; `...Texture` are the references to textures, which extensions of
// materials may have by any name.
const std::map<std::string, std::vector<std::string>, std::less<>>& places_of_extensions() {
    static const std::vector<std::string> material{"/materials/#"};
    static const std::map<std::string, std::vector<std::string>, std::less<>> known{
        {"EXT_mesh_gpu_instancing", {"/nodes/#"}},
        {"EXT_texture_webp", {"/textures/#"}},
        {"KHR_draco_mesh_compression", {"/meshes/#/primitives/#"}},
        {"KHR_lights_punctual", {"", "/nodes/#"}},
        {"KHR_materials_anisotropy", material},
        {"KHR_materials_clearcoat", material},
        {"KHR_materials_dispersion", material},
        {"KHR_materials_emissive_strength", material},
        {"KHR_materials_ior", material},
        {"KHR_materials_iridescence", material},
        {"KHR_materials_pbrSpecularGlossiness", material},
        {"KHR_materials_sheen", material},
        {"KHR_materials_specular", material},
        {"KHR_materials_transmission", material},
        {"KHR_materials_unlit", material},
        {"KHR_materials_variants", {"", "/meshes/#/primitives/#"}},
        {"KHR_materials_volume", material},
        {"KHR_mesh_quantization", {}},
        {"KHR_node_visibility", {"/nodes/#"}},
        {"KHR_texture_basisu", {"/textures/#"}},
        {"KHR_texture_transform", {"...Texture"}},
    };
    return known;
}

class ExtensionWalk {
public:
    ExtensionWalk(Document& document, const std::vector<std::string>& declared) : document_(document), declared_(declared.begin(), declared.end()) {}

    void visit(const Json& value) {
        if (value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i)
                if (value[i].is_structured()) descend(std::to_string(i), "#", value[i]);
            return;
        }
        for (const auto& [key, member] : value.items()) {
            if (key == "extras") continue;
            if (key == "extensions") visit_extensions(member);
            else if (member.is_structured()) descend(key, key, member);
        }
    }

private:
    void descend(const std::string& step, const std::string& kind, const Json& value) {
        const std::size_t path = path_.size(), owner = owner_.size();
        path_ += "/" + step;
        owner_ += "/" + kind;
        visit(value);
        path_.resize(path);
        owner_.resize(owner);
    }

    void visit_extensions(const Json& list) {
        const std::string here = path_ + "/extensions";
        if (!list.is_object()) {
            document_.faults.add(here, "is " + describe(list) + "; expected an object");
            return;
        }
        for (const auto& [name, value] : list.items()) {
            if (!value.is_object()) {
                document_.faults.add(here + "/" + name, "is " + describe(value) + "; expected an object");
                continue;
            }
            if (!declared_.contains(name)) document_.warn(fmt::format("{}: the extension {} is not in `extensionsUsed`", document_.file, name));
            check_place(here, name);
            const std::string owner = owner_;
            descend("extensions/" + name, "extensions/" + name, value);
            owner_ = owner;
        }
    }

    void check_place(const std::string& here, const std::string& name) {
        const auto known = places_of_extensions().find(name);
        if (known == places_of_extensions().end()) return;
        const std::vector<std::string>& places = known->second;
        const auto fits = [&](const std::string& place) {
            return place == "...Texture" ? owner_.starts_with("/materials/#/") && (owner_.ends_with("Texture") || owner_.starts_with("/materials/#/extensions/")) : place == owner_;
        };
        if (std::any_of(places.begin(), places.end(), fits)) return;
        std::string expected;
        for (const std::string& place : places) expected += (expected.empty() ? "" : " or ") + (place.empty() ? std::string("the document") : place);
        document_.faults.add(here + "/" + name, "stands where the extension has no meaning",
                             places.empty() ? "it has no objects of its own" : "expected at " + expected);
    }

    Document& document_;
    std::set<std::string> declared_;
    std::string path_, owner_;
};

void refuse_doubles(const Element& owner, const char* list) {
    std::set<std::string> seen;
    for (const std::string& name : owner.texts(list))
        if (!seen.insert(name).second) owner.fault(fmt::format("`{}` names {} twice", list, name), "expected once");
}

bool is_set_name(const std::string& name) {
    for (const std::string set : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"}) {
        if (!name.starts_with(set)) continue;
        const std::string number = name.substr(set.size());
        const bool digits = !number.empty() && std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
        return digits && (number == "0" || number[0] != '0');
    }
    return false;
}

void check_attributes(Document& document, const Accessors& accessors, const Element& attributes) {
    for (const std::string& name : attributes.keys()) {
        const bool known = name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name.starts_with("_") || is_set_name(name);
        if (!known)
            attributes.fault("`" + name + "` is no attribute",
                             "expected POSITION, NORMAL, TANGENT, TEXCOORD_n, COLOR_n, JOINTS_n, WEIGHTS_n, or a name of your own that starts with _");
        const auto index = attributes.index(name.c_str(), accessors.size(), "accessors");
        if (!index) continue;
        if (accessors[*index].component_type == 5125)
            attributes.fault(fmt::format("{} is accessor {} of component type 5125, which no attribute may have", name, *index));
        const Element& accessor = document.accessors[*index];
        if (name == "POSITION" && (!accessor.has("min") || !accessor.has("max")))
            attributes.fault(fmt::format("POSITION is accessor {} without `min` and `max`, which positions must have", *index));
    }
}

// The sets of coordinates that a material's textures look up, of extensions too: those that are known.
void add_sets(const Json& value, std::set<std::int64_t>& sets) {
    for (const auto& [key, member] : value.items()) {
        if (key == "extras" || !member.is_object()) continue;
        if (key == "extensions") {
            for (const auto& [name, extension] : member.items())
                if (extension.is_object() && places_of_extensions().contains(name)) add_sets(extension, sets);
            continue;
        }
        if (key.ends_with("Texture") && member.contains("index")) {
            Faults unheard("");
            sets.insert(uv_set_of(Element(&member, "", &unheard)));
        } else {
            add_sets(member, sets);
        }
    }
}

}  // namespace

void check_extension_objects(Document& document) {
    refuse_doubles(document.root, "extensionsUsed");
    refuse_doubles(document.root, "extensionsRequired");
    ExtensionWalk(document, document.root.texts("extensionsUsed")).visit(*document.root.json());
}

void check_primitives(Document& document, const Accessors& accessors) {
    std::vector<std::set<std::int64_t>> sets;
    for (const Element& material : document.materials) {
        sets.emplace_back();
        if (material.present()) add_sets(*material.json(), sets.back());
    }
    for (const Element& mesh : document.meshes) {
        for (const Element& primitive : mesh.objects("primitives")) {
            const Element attributes = primitive.object("attributes");
            check_attributes(document, accessors, attributes);
            accessors.refuse_stride(primitive, "indices");
            for (const Element& target : primitive.objects("targets")) check_attributes(document, accessors, target);
            const auto material = primitive.index("material", sets.size(), "materials");
            if (!material) continue;
            for (const std::int64_t set : sets[*material])
                if (!attributes.has(fmt::format("TEXCOORD_{}", set).c_str()))
                    primitive.fault(fmt::format("its material looks up TEXCOORD_{}, which it does not have", set));
        }
    }
}

void check_skins(Document& document, const Accessors& accessors, const NodeTree& tree) {
    std::vector<std::vector<std::size_t>> joints;
    for (const Element& skin : document.skins) {
        accessors.refuse_stride(skin, "inverseBindMatrices");
        joints.push_back(skin.indices("joints", document.nodes.size(), "nodes"));
        if (joints.back().empty() || !tree.is_tree()) continue;
        const std::size_t root = tree.root_of(joints.back()[0]);
        const auto elsewhere = std::find_if(joints.back().begin(), joints.back().end(), [&](std::size_t j) { return tree.root_of(j) != root; });
        if (elsewhere != joints.back().end())
            skin.fault(fmt::format("joints {} and {} are below no common node", joints.back()[0], *elsewhere), "expected one root above all joints");
        const auto skeleton = skin.index("skeleton", document.nodes.size(), "nodes");
        if (!skeleton) continue;
        for (const std::size_t joint : joints.back()) {
            if (tree.is_below(joint, *skeleton)) continue;
            skin.fault(fmt::format("`skeleton` is node {}, and joint {} is not below it", *skeleton, joint), "expected a node above all joints");
            break;
        }
    }
    std::vector<std::set<std::size_t>> scenes;
    for (const Element& scene : document.scenes) {
        const std::vector<std::size_t> nodes = scene.indices("nodes", document.nodes.size(), "nodes");
        scenes.emplace_back(nodes.begin(), nodes.end());
    }
    std::set<std::pair<std::size_t, std::size_t>> checked;
    for (std::size_t n = 0; n < document.nodes.size(); ++n) {
        const Element& node = document.nodes[n];
        const auto mesh = node.index("mesh", document.meshes.size(), "meshes");
        const auto skin = node.index("skin", joints.size(), "skins");
        if (!mesh || !skin || joints[*skin].empty() || !tree.is_tree()) continue;
        for (std::size_t s = 0; s < scenes.size(); ++s)
            if (scenes[s].contains(tree.root_of(n)) && !scenes[s].contains(tree.root_of(joints[*skin][0])))
                node.fault(fmt::format("is shown by scene {}, and the joints of its skin are not", s), "expected their root in the same scene");
        if (!checked.emplace(*mesh, *skin).second) continue;
        for (const Element& primitive : document.meshes[*mesh].objects("primitives")) {
            const Element attributes = primitive.object("attributes");
            for (int set = 0; attributes.has(fmt::format("JOINTS_{}", set).c_str()); ++set) {
                const std::string name = fmt::format("JOINTS_{}", set);
                const auto index = attributes.index(name.c_str(), accessors.size(), "accessors");
                if (!index || (accessors[*index].component_type != 5121 && accessors[*index].component_type != 5123)) continue;
                const std::vector<std::uint32_t> values = accessors.integers(*index);
                const auto bad = std::find_if(values.begin(), values.end(), [&](std::uint32_t j) { return j >= joints[*skin].size(); });
                if (bad == values.end()) continue;
                attributes.fault(fmt::format("{}: vertex {} follows joint {}; the skin has {}", name, static_cast<std::size_t>(bad - values.begin()) / 4,
                                             *bad, joints[*skin].size()));
            }
        }
    }
}

}  // namespace wavelobe::gltf
