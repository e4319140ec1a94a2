// glTF: materials, textures, lights.
#include <algorithm>

#include <gtest/gtest.h>

#include "film/png.h"
#include "support/gltf_files.h"

namespace wavelobe::test {
namespace {

// A triangle of this material.
struct MaterialFile : GltfFile {
    explicit MaterialFile(const Json& material) {
        add_mesh(unit_triangle())["material"] = 0;
        json["materials"] = Json::array({material});
    }
};

// A picture of one texel as a data URI.
Json image_of(const Rgb& linear) { return {{"uri", "data:image/png;base64," + base64(encode_png({1, 1, {linear.r, linear.g, linear.b}}))}}; }

template <class Model>
Model model_of(const Scene& scene) {
    return std::get<Model>(scene.materials.at(static_cast<std::size_t>(scene.shapes.at(0).material.front)).model);
}

TEST(GltfMaterials, DefaultsAreTheSpecifications) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    const Scene scene = file.read();
    const auto model = model_of<MetallicRoughness>(scene);
    EXPECT_EQ(model.base_color.value, Rgb(1.0F));
    EXPECT_EQ(model.metallic.value.x, 1.0F);
    EXPECT_EQ(model.roughness.value.x, 1.0F);
    EXPECT_TRUE(scene.shapes[0].material.culled_behind);
    EXPECT_EQ(std::get<ThinDielectric>(scene.materials.at(static_cast<std::size_t>(scene.shapes[0].material.back)).model).eta, 1.0F);
}

TEST(GltfMaterials, FactorsAndExtensions) {
    MaterialFile file(Json{{"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}},
                                   {"emissiveFactor", {1, 0.5, 0}},
                                   {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
                                                   {"KHR_materials_ior", {{"ior", 1.8}}},
                                                   {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 2, 3}}}}}}});
    const Scene scene = file.read();
    const auto model = model_of<MetallicRoughness>(scene);
    EXPECT_EQ(model.base_color.value, Rgb(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(model.metallic.value.x, 0.25F);
    EXPECT_EQ(model.roughness.value.x, 0.5F);
    EXPECT_EQ(model.ior, 1.8F);
    EXPECT_EQ(model.specular.value.x, 0.5F);
    EXPECT_EQ(model.specular_color.value, Rgb(1, 2, 3));
    ASSERT_TRUE(scene.shapes[0].emitter);
    EXPECT_EQ(scene.shapes[0].emitter->radiance.value, Rgb(4, 2, 0));
}

// Of its textures one is a colour, the other a roughness in alpha.
TEST(GltfMaterials, Sheen) {
    MaterialFile file(Json{{"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", {0.5, 0.25, 1}}, {"sheenRoughnessFactor", 0.75},
                                                                   {"sheenColorTexture", {{"index", 0}}}, {"sheenRoughnessTexture", {{"index", 0}}}}}}}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = file.add_floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.json["textures"] = Json::array({{{"source", 0}}});
    file.json["images"] = Json::array({image_of(Rgb(0.5F))});
    const auto model = model_of<MetallicRoughness>(file.read());
    EXPECT_EQ(model.sheen_color.value, Rgb(0.5F, 0.25F, 1.0F));
    EXPECT_EQ(model.sheen_roughness.value.x, 0.75F);
    EXPECT_NEAR(std::get<Bitmap>(model.sheen_color.texture->source).rgb[0], 0.5F, 0.005F);  // decoded from sRGB
    EXPECT_EQ(std::get<Bitmap>(model.sheen_roughness.texture->source).rgb[0], 1.0F);        // a picture without alpha
    EXPECT_TRUE(has_text(MaterialFile(Json{{"extensions", {{"KHR_materials_sheen", {{"sheenRoughnessFactor", 2}}}}}}).faults(), "sheenRoughnessFactor: is 2"));
    EXPECT_TRUE(has_text(MaterialFile(Json{{"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 3}}}}}}}).faults(), "sheenColorFactor/2: is 3"));
}

TEST(GltfMaterials, TexturesKeepTheirSpaceSamplerAndTransform) {
    const Json both = {{"index", 0},
                       {"texCoord", 1},
                       {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1.5707963267948966}, {"scale", {2, 3}}}}}}};
    MaterialFile file(Json{{"pbrMetallicRoughness", {{"baseColorTexture", both}, {"metallicRoughnessTexture", both}}}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = file.add_floats({0, 0, 0, 0, 0, 0}, "VEC2", 2);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = file.add_floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.json["samplers"] = Json::array({{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}});
    file.json["textures"] = Json::array({{{"source", 0}, {"sampler", 0}}});
    file.json["images"] = Json::array({image_of(Rgb(0.5F))});
    const Scene scene = file.read();
    const auto model = model_of<MetallicRoughness>(scene);
    const auto& color = std::get<Bitmap>(model.base_color.texture->source);
    EXPECT_NEAR(color.rgb[0], 0.5F, 0.005F);  // decoded from sRGB
    EXPECT_EQ(color.wrap, Wrap::clamp);
    EXPECT_EQ(color.row_wrap, Wrap::mirror);
    EXPECT_EQ(color.filter, Filter::nearest);
    const auto& data = std::get<Bitmap>(model.roughness.texture->source);
    EXPECT_NEAR(data.rgb[0], 188.0F / 255.0F, 1e-6F);  // as stored
    EXPECT_EQ(model.roughness.channel, 1);
    EXPECT_EQ(model.metallic.channel, 2);
    EXPECT_EQ(mesh_of(scene).uvs[1], glm::vec2(1, 0));
    // (1, 0) is scaled to (2, 0), turned to (0, -2), moved to (0.5, -2).
    const glm::vec3 uv = model.base_color.texture->to_uv * glm::vec3(1, 0, 1);
    EXPECT_NEAR(uv.x, 0.5F, 1e-6F);
    EXPECT_NEAR(uv.y, -2.0F, 1e-6F);
}

TEST(GltfMaterials, AlphaModes) {
    const auto opacity = [](const char* mode) {
        return MaterialFile(Json{{"alphaMode", mode}, {"alphaCutoff", 0.3}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}}).read().shapes.at(0).material.opacity;
    };
    EXPECT_EQ(opacity("OPAQUE").value.value.x, 1.0F);
    EXPECT_EQ(opacity("BLEND").value.value.x, 0.25F);
    EXPECT_FALSE(opacity("BLEND").cutoff);
    EXPECT_EQ(opacity("MASK").cutoff, 0.3F);
}

// Each texture its own set, those of transforms first; the sets of the mesh follow.
TEST(GltfMaterials, TwoSetsOfCoordinates) {
    const Json base = {{"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 2}}}}}};
    MaterialFile file(Json{{"pbrMetallicRoughness", {{"baseColorTexture", base}, {"metallicRoughnessTexture", {{"index", 0}, {"texCoord", 1}}}}},
                           {"emissiveFactor", {1, 1, 1}},
                           {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}});
    file.json["textures"] = Json::array({{{"source", 0}}});
    file.json["images"] = Json::array({image_of(Rgb(0.5F))});
    for (const int set : {0, 1, 2}) {
        const auto x = static_cast<float>(set);
        file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_" + std::to_string(set)] = file.add_floats({x, x, x, x, x, x}, "VEC2", 2);
    }
    const Scene scene = file.read();
    const auto model = model_of<MetallicRoughness>(scene);
    EXPECT_FALSE(model.base_color.texture->second_uvs);
    EXPECT_TRUE(model.roughness.texture->second_uvs);
    EXPECT_TRUE(scene.shapes[0].emitter->radiance.texture->second_uvs);
    EXPECT_EQ(mesh_of(scene).uvs[0].x, 2.0F);
    EXPECT_EQ(mesh_of(scene).second_uvs[0].x, 1.0F);
    file.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_2");
    EXPECT_TRUE(has_text(file.faults(), "/meshes/0/primitives/0: its material looks up TEXCOORD_2"));
}

TEST(GltfMaterials, OpacityOfVertices) {
    for (const char* mode : {"OPAQUE", "MASK", "BLEND"}) {
        MaterialFile file(Json{{"alphaMode", mode}});
        file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            file.add(std::vector<std::uint8_t>{255, 0, 0, 51, 255, 0, 0, 255, 255, 0, 0, 255}, "VEC4", 5121, 4);
        file.json["accessors"].back()["normalized"] = true;
        const Scene scene = file.read();
        EXPECT_EQ(mesh_of(scene).colors[0], glm::vec3(1, 0, 0));
        if (std::string(mode) == "OPAQUE") EXPECT_TRUE(mesh_of(scene).alphas.empty());
        else EXPECT_FLOAT_EQ(mesh_of(scene).alphas.at(0), 0.2F);
    }
}

// A tetrahedron shows no back from outside, a triangle does, and a surface with two sides has none.
TEST(GltfMaterials, BacksOfSingleSidedSurfaces) {
    const auto clear = [](bool two_sided, const std::vector<float>& positions, const std::vector<std::uint16_t>& indices) {
        MaterialFile file(Json{{"doubleSided", two_sided}});
        file.json["meshes"] = Json::array();
        Json& primitive = file.add_mesh(positions);
        primitive["material"] = 0;
        primitive["indices"] = file.add(indices, "SCALAR", 5123, 1);
        return file.read().shapes[0].material.culled_behind;
    };
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<std::uint16_t> outwards{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const std::vector<std::uint16_t> inwards{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
    EXPECT_TRUE(clear(false, unit_triangle(), {0, 1, 2}));
    EXPECT_FALSE(clear(true, unit_triangle(), {0, 1, 2}));
    EXPECT_FALSE(clear(false, corners, outwards));
    EXPECT_TRUE(clear(false, corners, inwards));
}

// Triangles that turn their backs to the camera: on their own they are not there, unless they shine or have two sides; where they hang
// together with others they stay.
TEST(GltfMaterials, WhatShowsBacksAloneIsLeftOut) {
    const auto triangles = [](const Json& material, bool joined, bool orthographic = false) {
        MaterialFile file(material);
        file.json["meshes"] = Json::array();
        const float x = joined ? 0.0F : 2.0F;
        file.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, x, 0, 0, x, 1, 0, x + 1, 0, -0.5F})["material"] = 0;
        if (orthographic) {
            file.json["cameras"] = Json::array({{{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 3}, {"znear", 0}, {"zfar", 10}}}}});
            file.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 5}}});
            file.json["scenes"][0]["nodes"] = {0, 1};
        }
        const Scene scene = file.read();
        const auto is_said = [](const std::string& w) { return w.find("triangles of single-sided materials show the camera their backs alone") != std::string::npos; };
        const bool said = std::any_of(scene.warnings.begin(), scene.warnings.end(), is_said);
        EXPECT_EQ(said, mesh_of(scene).triangles.size() < 2);
        return mesh_of(scene).triangles.size();
    };
    EXPECT_EQ(triangles(Json::object(), false), 1U);
    EXPECT_EQ(triangles(Json::object(), false, true), 1U);
    EXPECT_EQ(triangles(Json::object(), true), 2U);
    EXPECT_EQ(triangles({{"doubleSided", true}}, false), 2U);
    EXPECT_EQ(triangles({{"emissiveFactor", {1, 1, 1}}}, false), 2U);
}

// Of two triangles the second has mirrored coordinates: its green is turned over.
TEST(GltfMaterials, NormalMaps) {
    MaterialFile file(Json{{"normalTexture", {{"index", 0}, {"texCoord", 1}, {"scale", 0.5}}},
                           {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    file.json["meshes"] = Json::array();
    Json& primitive = file.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1});
    primitive["material"] = 0;
    primitive["attributes"]["TEXCOORD_0"] = file.add_floats(std::vector<float>(12, 0.0F), "VEC2", 2);
    primitive["attributes"]["TEXCOORD_1"] = file.add_floats({0, 1, 1, 1, 0, 0, 1, 1, 0, 1, 1, 0}, "VEC2", 2);
    file.json["textures"] = Json::array({{{"source", 0}}});
    file.json["images"] = Json::array({image_of(Rgb(0.0F, 1.0F, 1.0F))});
    const Scene scene = file.read();
    ASSERT_EQ(scene.shapes.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto& map = std::get<NormalMapped>(scene.materials.at(static_cast<std::size_t>(scene.shapes[i].material.front)).model);
        const bool mirrored = mesh_of(scene, i).triangles.at(0).x >= 3;
        EXPECT_EQ(map.scale, 0.5F);
        EXPECT_FALSE(map.normals.texture->second_uvs);
        EXPECT_EQ(mesh_of(scene, i).uvs[1], glm::vec2(1, 1));
        EXPECT_EQ(std::get<Bitmap>(map.normals.texture->source).rgb, (std::vector<float>{0, mirrored ? 0.0F : 1.0F, 1}));
        const auto& sides = std::get<TwoSided>(map.nested->model);
        EXPECT_TRUE(std::get<MetallicRoughness>(sides.front->model).base_color.texture->second_uvs);
    }
}

// What blends is no lamp to sample; what has two sides shines on both.
TEST(GltfMaterials, EmissionOfBlendedAndTwoSidedSurfaces) {
    const auto emitter = [](const Json& more) {
        Json material = {{"emissiveFactor", {1, 1, 1}}};
        material.update(more);
        return *MaterialFile(material).read().shapes[0].emitter;
    };
    EXPECT_TRUE(emitter(Json::object()).sampled);
    EXPECT_FALSE(emitter(Json::object()).both_sides);
    EXPECT_FALSE(emitter({{"alphaMode", "BLEND"}}).sampled);
    EXPECT_TRUE(emitter({{"doubleSided", true}}).both_sides);
}

TEST(GltfMaterials, UnlitSurfacesShineInTheirColour) {
    const Scene scene = MaterialFile(Json{{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.125, 1}}}},
                                       {"extensions", {{"KHR_materials_unlit", Json::object()}}}}).read();
    EXPECT_EQ(scene.shapes[0].emitter->radiance.value, Rgb(0.5F, 0.25F, 0.125F));
    EXPECT_TRUE(!scene.shapes[0].emitter->both_sides && !scene.shapes[0].emitter->sampled && scene.shapes[0].emitter->colored);
    EXPECT_EQ(model_of<Diffuse>(scene).reflectance.value, Rgb(0.0F));
}

TEST(GltfMaterials, PunctualLights) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    file.json["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", "point"}, {"intensity", 2}, {"range", 7}, {"color", {1, 0.5, 0}}},
                     {{"type", "directional"}},
                     {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}}});
    for (int light = 0; light < 3; ++light) {
        Json node = {{"translation", {0, 4, 0}}};
        node["extensions"]["KHR_lights_punctual"]["light"] = light;
        file.json["nodes"].push_back(node);
    }
    file.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
    const Scene scene = file.read();
    ASSERT_EQ(scene.emitters.size(), 3U);
    EXPECT_TRUE(scene.notes.empty());
    EXPECT_EQ(std::get<PointEmitter>(scene.emitters[0]).intensity, Rgb(2, 1, 0));
    EXPECT_EQ(std::get<PointEmitter>(scene.emitters[0]).position, glm::vec3(0, 4, 0));
    EXPECT_EQ(std::get<PointEmitter>(scene.emitters[0]).range, 7.0F);
    EXPECT_TRUE(std::get<SpotEmitter>(scene.emitters[2]).smooth);
    EXPECT_EQ(std::get<DirectionalEmitter>(scene.emitters[1]).direction, glm::vec3(0, 0, -1));
    EXPECT_NEAR(std::get<SpotEmitter>(scene.emitters[2]).cutoff_degrees, glm::degrees(0.5F), 1e-4F);
}

TEST(GltfMaterials, FaultsOfImagesAndMaterials) {
    const auto faults = [](const Json& image) {
        MaterialFile file(Json{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = file.add_floats({0, 0, 0, 0, 0, 0}, "VEC2", 2);
        file.json["textures"] = Json::array({{{"source", 0}}});
        file.json["images"] = Json::array({image});
        return file.faults();
    };
    EXPECT_TRUE(faults(image_of(Rgb(1.0F))).empty());
    EXPECT_TRUE(has_text(faults({{"uri", "absent.png"}}), "absent.png"));
    EXPECT_TRUE(has_text(faults({{"uri", "data:image/png;base64,AAAA"}}), "not an image of a supported format"));
    EXPECT_TRUE(has_text(faults({{"bufferView", 77}}), "/images/0/bufferView: is 77"));
    EXPECT_TRUE(has_text(faults(Json::object()), "/images/0: expected either"));
    EXPECT_TRUE(has_text(MaterialFile(Json{{"pbrMetallicRoughness", {{"roughnessFactor", -1}}}}).faults(), "/materials/0/pbrMetallicRoughness/roughnessFactor: is -1"));
    EXPECT_TRUE(has_text(MaterialFile(Json{{"alphaMode", "GLASS"}}).faults(), "alphaMode `GLASS`"));
    EXPECT_TRUE(has_text(MaterialFile(Json{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 3}}}}}}).faults(), "the file has 0 textures"));
}

}  // namespace
}  // namespace wavelobe::test
