// glTF: tangents of vertices, and what is said in their frame.
#include <gtest/gtest.h>

#include <numbers>

#include "film/png.h"
#include "render/flatten.h"
#include "support/gltf_files.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

Json brushed(double strength, double rotation) {
    return {{"doubleSided", true},
            {"pbrMetallicRoughness", {{"roughnessFactor", 0.3}}},
            {"extensions", {{"KHR_materials_anisotropy", {{"anisotropyStrength", strength}, {"anisotropyRotation", rotation}}}}}};
}

// The square [-1, 1]^2 of the plane z = 0 with tangents alike.
struct SquareFile : GltfFile {
    explicit SquareFile(const Json& material, const glm::vec4& tangent = {1, 0, 0, 1}) {
        Json& primitive = add_mesh({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
        primitive["indices"] = add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123, 1);
        primitive["attributes"]["NORMAL"] = add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
        primitive["attributes"]["TEXCOORD_0"] = add_floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
        std::vector<float> tangents;
        for (int i = 0; i < 4; ++i) tangents.insert(tangents.end(), {tangent.x, tangent.y, tangent.z, tangent.w});
        primitive["attributes"]["TANGENT"] = add_floats(tangents, "VEC4", 4);
        primitive["material"] = 0;
        json["materials"] = Json::array({material});
    }

    void add_texture(const Rgb& encoded) {
        // Linear values that the file holds as bytes of the same.
        const auto linear = [](float v) { return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F); };
        json["textures"] = Json::array({{{"source", 0}}});
        json["images"] = Json::array({{{"uri", "data:image/png;base64," + base64(encode_png({1, 1, {linear(encoded.r), linear(encoded.g), linear(encoded.b)}}))}}});
    }

    // From the side, under one small light.
    Scene lit() const {
        Scene scene = read();
        scene.film.width = scene.film.crop_width = scene.film.height = scene.film.crop_height = 16;
        scene.film.filter = {ReconstructionFilter::Kind::box, 0.5F, 0.0F};
        look_at(scene, {0.5F, -2, 2}, {0, 0, 0}, {0, 0, 1}, 20.0F);
        scene.emitters = {PointEmitter{{-0.7F, 1, 2}, Rgb(5.0F)}};
        return scene;
    }
};

std::vector<float> picture(const SquareFile& file) { return render(file.lit(), 16).image.rgb; }

// How far apart two pictures are, over their mean.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
        all += static_cast<double>(a[i]);
    }
    return sum / all;
}

constexpr double quarter = 0.5 * std::numbers::pi;

TEST(GltfTangents, RotationTurnsFromTheTangentToTheBitangent) {
    const auto expected = picture(SquareFile(brushed(0.8, 0.4), {1, 0, 0, 1}));
    const auto c = static_cast<float>(std::cos(0.4)), s = static_cast<float>(std::sin(0.4));
    EXPECT_LT(difference(expected, picture(SquareFile(brushed(0.8, 0.0), {c, s, 0, 1}))), 1e-4);
    EXPECT_LT(difference(expected, picture(SquareFile(brushed(0.8, -0.4), {1, 0, 0, -1}))), 1e-4);
    EXPECT_GT(difference(expected, picture(SquareFile(brushed(0.8, -0.4)))), 0.05);
    EXPECT_GT(difference(expected, picture(SquareFile(brushed(0.8, 0.4 + quarter)))), 0.05);
}

// A mirrored node mirrors its tangent frames: the bitangent stays where the mirrored mesh has it.
TEST(GltfTangents, MirroredNode) {
    SquareFile file(brushed(0.8, 0.4));
    file.json["nodes"][0]["scale"] = {1, -1, 1};
    EXPECT_LT(difference(picture(file), picture(SquareFile(brushed(0.8, -0.4)))), 1e-4);
    file.json["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
    EXPECT_LT(difference(picture(file), picture(SquareFile(brushed(0.8, -0.4)))), 1e-4);
}

// A coat alone looks like a dielectric alone that has its normal map, and keeps to the surface's normal without one of its own, whatever map
// is below it.
TEST(GltfTangents, CoatsHaveNormalsOfTheirOwn) {
    const Rgb tilted{0.7F, 0.6F, 0.9F};
    const auto bare = [] {
        return Json{{"doubleSided", true}, {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.4}}}};
    };
    const auto coated = [&] {
        Json material = bare();
        material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.4}};
        material["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
        return material;
    };
    const auto shown = [&](Json material, const char* map, double scale, const glm::vec4& tangent = {1, 0, 0, 1}, bool from_behind = false) {
        const Json info = {{"index", 0}, {"scale", scale}};
        if (std::string(map) == "normalTexture") material[map] = info;
        if (std::string(map) == "clearcoatNormalTexture") material["extensions"]["KHR_materials_clearcoat"][map] = info;
        SquareFile file(material, tangent);
        file.add_texture(tilted);
        Scene scene = file.lit();
        if (from_behind) {
            look_at(scene, {0.5F, -2, -2}, {0, 0, 0}, {0, 0, 1}, 20.0F);
            scene.emitters = {PointEmitter{{-0.7F, 1, -2}, Rgb(5.0F)}};
        }
        return render(scene, 16).image.rgb;
    };
    const auto plain = shown(bare(), "", 1);
    EXPECT_LT(difference(plain, shown(coated(), "", 1)), 1e-3);
    EXPECT_LT(difference(plain, shown(coated(), "normalTexture", 1)), 1e-3);
    EXPECT_GT(difference(plain, shown(bare(), "normalTexture", 1)), 0.1);
    EXPECT_LT(difference(shown(bare(), "normalTexture", 1), shown(coated(), "clearcoatNormalTexture", 1)), 1e-3);
    EXPECT_LT(difference(shown(bare(), "normalTexture", 0.5, {0, 1, 0, -1}), shown(coated(), "clearcoatNormalTexture", 0.5, {0, 1, 0, -1})), 1e-3);
    EXPECT_LT(difference(shown(bare(), "normalTexture", 1, {1, 0, 0, 1}, true), shown(coated(), "clearcoatNormalTexture", 1, {1, 0, 0, 1}, true)), 1e-3);
}

TEST(GltfTangents, WithoutThemTextureCoordinatesServe) {
    SquareFile file(brushed(0.8, 0.4));
    const auto expected = picture(file);
    file.json["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
    EXPECT_LT(difference(expected, picture(file)), 1e-4);
}

TEST(GltfTangents, AnisotropyTexture) {
    Json material = brushed(1.0, 0.2);
    material["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"]["index"] = 0;
    SquareFile file(material);
    // As bytes: 204/255 = 0.8, 229/255 and 179/255.
    file.add_texture({0.8F, 229.0F / 255.0F, 179.0F / 255.0F});
    const double angle = std::atan2(2.0 * 229.0 / 255.0 - 1.0, 0.6);
    EXPECT_LT(difference(picture(file), picture(SquareFile(brushed(179.0 / 255.0, 0.2 + angle)))), 1e-3);
    file.json["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"]["index"] = 9;
    EXPECT_TRUE(has_text(file.faults(), "anisotropyTexture/index"));
}

// Normals leaning along the tangent: turned by the file's tangents, against what texture coordinates would say.
TEST(GltfTangents, NormalMapsFollowThem) {
    Json material = {{"doubleSided", true}, {"pbrMetallicRoughness", {{"roughnessFactor", 0.3}}}, {"normalTexture", {{"index", 0}}}};
    const auto leaning = [&](const Rgb& normal, const glm::vec4& tangent) {
        SquareFile file(material, tangent);
        file.add_texture(normal);
        return picture(file);
    };
    // Of bytes, 127 and 128 are opposite.
    const float half = 128.0F / 255.0F, opposite = 127.0F / 255.0F, more = 170.0F / 255.0F;
    const auto expected = leaning({more, half, 1.0F}, {1, 0, 0, 1});
    EXPECT_LT(difference(expected, leaning({opposite, more, 1.0F}, {0, -1, 0, 1})), 1e-4);
    EXPECT_LT(difference(expected, leaning({half, more, 1.0F}, {0, 1, 0, -1})), 1e-4);
    EXPECT_GT(difference(expected, leaning({half, more, 1.0F}, {0, 1, 0, 1})), 0.1);
}

// What is not anisotropic has none of it compiled, nor tangents in its buffers.
TEST(GltfTangents, CostNothingWhereNothingAsksForThem) {
    const Json plain = {{"doubleSided", true}, {"pbrMetallicRoughness", {{"roughnessFactor", 0.3}}}};
    const SquareFile with(brushed(0.0, 0.3));
    SquareFile without(plain);
    without.json["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
    const DeviceScene a = flatten_scene(with.lit()), b = flatten_scene(without.lit());
    EXPECT_EQ(a.features.names(), b.features.names());
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.materials.size(), b.materials.size());
    EXPECT_EQ(picture(with), picture(without));
    const DeviceScene c = flatten_scene(SquareFile(brushed(0.5, 0.3)).lit());
    EXPECT_EQ(c.normals.size(), 2 * a.normals.size());
    EXPECT_TRUE(c.features.anisotropy && c.features.vertex_tangents);
}

}  // namespace
}  // namespace wavelobe::test
