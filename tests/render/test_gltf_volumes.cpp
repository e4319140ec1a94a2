// glTF volumes: light through slabs of a file, by Fresnel's equations and Beer's law.
#include <gtest/gtest.h>

#include "support/gltf_files.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

const Rgb light{2.0F, 3.0F, 4.0F};
const Rgb color{0.25F, 0.5F, 1.0F};
constexpr double distance = 1.5;  // after which `color` is left

glm::dvec3 left_after(double way) { return glm::pow(glm::dvec3(color), glm::dvec3(way / distance)); }

Json glass(double ior, double roughness, double thickness = 1.0) {
    return {{"name", "glass"},
            {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}},
            {"extensions",
             {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
              {"KHR_materials_ior", {{"ior", ior}}},
              {"KHR_materials_volume",
               {{"thicknessFactor", thickness}, {"attenuationDistance", distance}, {"attenuationColor", {color.r, color.g, color.b}}}}}}};
}

// Boxes about the origin with faces outwards, a node and a material each.
struct BoxFile : GltfFile {
    BoxFile() {
        json["nodes"] = Json::array();
        json["scenes"][0]["nodes"] = Json::array();
        json["materials"] = Json::array();
    }

    Json& add_box(const Json& material, const glm::vec3& half) {
        std::vector<float> positions;
        for (int i = 0; i < 8; ++i) positions.insert(positions.end(), {(i & 1) ? half.x : -half.x, (i & 2) ? half.y : -half.y, (i & 4) ? half.z : -half.z});
        Json& primitive = add_mesh(positions);
        primitive["indices"] = add(std::vector<std::uint16_t>{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
                                   "SCALAR", 5123, 1);
        const std::size_t number = json["nodes"].size();
        primitive["material"] = number;
        json["materials"].push_back(material);
        json["scenes"][0]["nodes"].push_back(number);
        json["nodes"].push_back({{"mesh", number}});
        return json["nodes"].back();
    }

    // Seen from a point, before an even background.
    Scene seen_from(const glm::vec3& point, int pixels) const {
        Json whole = json;
        whole["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1e-6}, {"znear", 1e-4}}}}});
        // Turned from -z to the origin, in the plane of x and z.
        const double angle = 0.5 * std::atan2(static_cast<double>(point.x), static_cast<double>(point.z));
        whole["nodes"].push_back({{"camera", 0}, {"translation", {point.x, point.y, point.z}}, {"rotation", {0, std::sin(angle), 0, std::cos(angle)}}});
        whole["scenes"][0]["nodes"].push_back(whole["nodes"].size() - 1);
        GltfFile file;
        file.json = whole;
        file.buffer = buffer;
        GltfOptions options;
        options.width = options.height = pixels;
        Scene scene = file.read(options);
        scene.film.filter = {ReconstructionFilter::Kind::box, 0.5F, 0.0F};
        scene.emitters = {ConstantEmitter{light}};
        scene.integrator.rr_depth = 1000;  // no roulette: light has one way to go where no index changes
        return scene;
    }
};

// Off the axis, so that no ray meets an edge between the triangles of a face.
const glm::vec3 in_front{0.02F, 0.05F, 9.0F};

double across(double thickness, const glm::vec3& from) { return thickness * glm::length(glm::dvec3(from.x, 0, from.z)) / static_cast<double>(from.z); }

TEST(GltfVolumes, IndexMatchedSlab) {
    BoxFile file;
    file.add_box(glass(1.0, 0.0), {4, 4, 0.5F});
    expect_every_pixel(render(file.seen_from(in_front, 4), 16).image, glm::dvec3(light) * left_after(across(1.0, in_front)));
}

// Distances are those of the world, whatever the node does to the mesh.
TEST(GltfVolumes, ScaledAndMirroredNode) {
    BoxFile file;
    file.add_box(glass(1.0, 0.0), {4, 4, 0.5F})["scale"] = {1, -1, 2};
    expect_every_pixel(render(file.seen_from(in_front, 4), 16).image, glm::dvec3(light) * left_after(across(2.0, in_front)));
}

TEST(GltfVolumes, InsideAnother) {
    BoxFile file;
    file.add_box(glass(1.0, 0.0), {4, 4, 1.5F});
    Json clear = glass(1.0, 0.0);
    clear["extensions"]["KHR_materials_volume"].erase("attenuationDistance");
    file.add_box(clear, {2, 2, 1});
    file.add_box(glass(1.0, 0.0), {1, 1, 0.25F});
    expect_every_pixel(render(file.seen_from(in_front, 4), 16).image, glm::dvec3(light) * left_after(across(1.0 + 0.5, in_front)));
}

TEST(GltfVolumes, CameraInside) {
    BoxFile file;
    file.add_box(glass(1.0, 0.0), {4, 4, 0.5F});
    const glm::vec3 inside{0.0F, 0.05F, 0.25F};
    const Scene scene = file.seen_from(inside, 4);
    expect_every_pixel(render(scene, 16).image, glm::dvec3(light) * left_after(0.75 - static_cast<double>(scene.camera.near_clip)));
}

TEST(GltfVolumes, BlackLeavesNothing) {
    BoxFile file;
    Json black = glass(1.0, 0.0);
    black["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0, 0, 1};
    file.add_box(black, {4, 4, 0.005F});
    expect_every_pixel(render(file.seen_from(in_front, 4), 16).image, {0, 0, light.b});
}

// Reflectance of unpolarized light, and the cosine below.
struct Interface {
    double reflectance, cosine;
};
Interface interface_of(double ior, double cosine) {
    const double below = std::sqrt(1.0 - (1.0 - cosine * cosine) / (ior * ior));
    const double s = (cosine - ior * below) / (cosine + ior * below), p = (ior * cosine - below) / (ior * cosine + below);
    return {0.5 * (s * s + p * p), below};
}

struct Slab {
    double roughness, degrees;
};

class GltfSlab : public testing::TestWithParam<Slab> {};

// What goes back and forth between the faces loses by each crossing: in an even light all ways out add up.
TEST_P(GltfSlab, ReflectsAndAbsorbs) {
    const double angle = glm::radians(GetParam().degrees);
    BoxFile file;
    file.add_box(glass(1.5, GetParam().roughness), {400, 400, 0.5F});
    const glm::vec3 from{static_cast<float>(9 * std::sin(angle)) + 0.02F, 0.05F, static_cast<float>(9 * std::cos(angle))};
    const auto [r, below] = interface_of(1.5, static_cast<double>(from.z) / glm::length(glm::dvec2(from.x, from.z)));
    const glm::dvec3 a = left_after(1.0 / below);
    expect_mean(render(file.seen_from(from, 32), 512).image, glm::dvec3(light) * (r + (1 - r) * (1 - r) * a / (1.0 - r * a)));
}

// The last is rough by little, so that the closed form still holds.
INSTANTIATE_TEST_SUITE_P(Slabs, GltfSlab, testing::Values(Slab{0.0, 0.0}, Slab{0.0, 60.0}, Slab{0.0332, 0.0}));

TEST(GltfVolumes, ThinWallsAndFacesWithHolesDoNotAbsorb) {
    BoxFile thin;
    thin.add_box(glass(1.5, 0.0, 0.0), {4, 4, 0.5F});
    const Scene walls = thin.seen_from(in_front, 4);
    EXPECT_TRUE(walls.media.empty());
    EXPECT_FALSE(walls.shapes[0].media);
    BoxFile holes;
    Json partly = glass(1.5, 0.0);
    partly["alphaMode"] = "BLEND";
    holes.add_box(partly, {4, 4, 0.5F});
    EXPECT_TRUE(holes.seen_from(in_front, 4).shapes[0].media);
    holes.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
    const Scene scene = holes.seen_from(in_front, 4);
    EXPECT_FALSE(scene.shapes[0].media);
    ASSERT_FALSE(scene.warnings.empty());
    EXPECT_NE(scene.warnings.back().find("does not absorb"), std::string::npos);
}

TEST(GltfVolumes, FaultsOfAttenuation) {
    BoxFile file;
    Json wrong = glass(1.5, 0.0);
    wrong["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 0;
    wrong["extensions"]["KHR_materials_volume"]["attenuationColor"] = {2, 0, 0};
    wrong["extensions"]["KHR_materials_volume"]["thicknessTexture"]["index"] = 4;
    file.add_box(wrong, {4, 4, 0.5F});
    EXPECT_TRUE(has_text(file.faults(), "attenuationDistance is 0"));
    EXPECT_TRUE(has_text(file.faults(), "attenuationColor"));
    EXPECT_TRUE(has_text(file.faults(), "thicknessTexture/index"));
}

}  // namespace
}  // namespace wavelobe::test
