// Normal and bump maps, two sides and blends, on surfaces whose light has a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/flatten.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

constexpr double pi = std::numbers::pi;
const Rgb irradiance{1.0F, 2.0F, 3.5F};
const Rgb albedo{0.7F, 0.5F, 0.2F};
const glm::dvec3 to_light = glm::normalize(glm::dvec3{0.6, -0.2, 0.8});  // tangents of the floor: x along u, z up
const glm::dvec3 to_camera = glm::normalize(glm::dvec3{-0.3, 0.4, 1.0});

NestedMaterial nested(MaterialModel model) { return std::make_shared<const Material>(Material{std::move(model), "nested"}); }
NestedMaterial diffuse(const Rgb& color = albedo) { return nested(Diffuse{constant(color)}); }

NormalMapped mapped(const glm::dvec3& n, NestedMaterial inner, bool soften = false) {
    NormalMapped map;
    map.normals = constant(Rgb(0.5 + 0.5 * n));
    map.perturbation.soften_terminator = soften;
    map.nested = std::move(inner);
    return map;
}

// A floor seen and lit from one side: `side` -1 takes both below it.
Image lit_floor(MaterialModel model, double side = 1.0, int samples = 1) {
    Scene scene = empty_scene(16);
    const auto world = [side](const glm::dvec3& v) { return glm::vec3(glm::dvec3{v.x, side * v.z, -v.y}); };
    const int material = add_material(scene, std::move(model));
    add_floor(scene, 50.0F, material).material.back = material;
    look_at_point(scene, 3.0F * world(to_camera), {0, 0, 0});
    scene.emitters.emplace_back(DirectionalEmitter{-world(to_light), irradiance});
    scene.integrator.max_depth = 2;
    return render(scene, samples).image;
}

glm::dvec3 lambert(const glm::dvec3& n, const Rgb& color = albedo) {
    return glm::dvec3(color) * glm::dvec3(irradiance) * std::max(glm::dot(glm::normalize(n), to_light), 0.0) / pi;
}

// Conty Estevez, Lecocq, Stein 2019.
double terminator(const glm::dvec3& n) {
    const auto tan2 = [](double z) { return 1.0 / (z * z) - 1.0; };
    const double alpha2 = std::min(0.125 * tan2(glm::normalize(n).z), 1.0);
    return 2.0 / (1.0 + std::sqrt(1.0 + alpha2 * tan2(to_light.z)));
}

const glm::dvec3 tilted = glm::normalize(glm::dvec3{0.3, 0.2, 0.9});

TEST(NormalMap, FlatMapChangesNothing) {
    expect_every_pixel(lit_floor(mapped({0, 0, 1}, diffuse(), true)), lambert({0, 0, 1}));
}

TEST(NormalMap, TiltsTheNormal) {
    expect_every_pixel(lit_floor(mapped(tilted, diffuse())), lambert(tilted));
    expect_every_pixel(lit_floor(mapped(tilted, diffuse(), true)), lambert(tilted) * terminator(tilted));
}

TEST(NormalMap, ScaleStretchesTheSlope) {
    NormalMapped map = mapped(tilted, diffuse());
    map.scale = 0.5F;
    expect_every_pixel(lit_floor(map), lambert({0.5 * tilted.x, 0.5 * tilted.y, tilted.z}));
}

// A normal that the viewer would see from behind has its slope turned round, or is black.
TEST(NormalMap, NormalsThatFaceAway) {
    const glm::dvec3 away = glm::normalize(glm::dvec3{0.9, -0.4, 0.15});
    ASSERT_LT(glm::dot(away, to_camera), 0.0);
    NormalMapped map = mapped(away, diffuse());
    expect_every_pixel(lit_floor(map), lambert({-away.x, -away.y, away.z}));
    map.perturbation.flip_invalid = false;
    expect_every_pixel(lit_floor(map), glm::dvec3(0.0));
}

TEST(NormalMap, NoDirectionChangesNothing) {
    expect_every_pixel(lit_floor(mapped({0, 0, 0}, diffuse(), true)), lambert({0, 0, 1}));
}

TEST(NormalMap, MapsInsideMaps) {
    // The inner normal stands in the frame of the outer one.
    const glm::dvec3 s = glm::normalize(glm::dvec3{1, 0, 0} - tilted * tilted.x);
    const glm::dvec3 t = glm::cross(tilted, s);
    const glm::dvec3 inner = glm::normalize(glm::dvec3{-0.2, 0.3, 0.8});
    expect_every_pixel(lit_floor(mapped(tilted, nested(mapped(inner, diffuse())))), lambert(s * inner.x + t * inner.y + tilted * inner.z));
}

// From below, in a frame turned over, the tangents keep their directions; a map outside of the sides is turned as a whole.
TEST(NormalMap, TwoSides) {
    expect_every_pixel(lit_floor(TwoSided{nested(mapped(tilted, diffuse())), nested(mapped(tilted, diffuse()))}, -1.0), lambert(tilted));
    expect_every_pixel(lit_floor(mapped(tilted, nested(TwoSided{diffuse(Rgb(0.1F)), diffuse()})), -1.0),
                       lambert({-tilted.x, -tilted.y, tilted.z}));
    expect_every_pixel(lit_floor(mapped(tilted, diffuse()), -1.0), glm::dvec3(0.0));
}

// Heights that rise by a tenth a texel: the slope is theirs wherever the filter is between texel centres.
TEST(BumpMap, SlopeTiltsTheNormal) {
    auto ramp = std::make_shared<Texture>();
    Bitmap bitmap;
    bitmap.width = 8;
    bitmap.height = 4;
    for (int y = 0; y < bitmap.height; ++y) {
        for (int x = 0; x < bitmap.width; ++x) bitmap.rgb.insert(bitmap.rgb.end(), 3, 0.1F * static_cast<float>(x) - 0.2F * static_cast<float>(y));
    }
    ramp->source = bitmap;
    ramp->to_uv = glm::mat3(0.5F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.03F, 0.04F, 1.0F);
    BumpMapped map;
    map.height = ramp;
    map.scale = 50.0F;
    map.perturbation.soften_terminator = false;
    map.nested = diffuse();
    // Over a floor of 100 units: along u 0.1 * 8 texels / 2, along v -0.2 * 4 texels.
    const glm::dvec3 n{-50.0 * 0.4 / 100.0, 50.0 * 0.8 / 100.0, 1.0};
    expect_every_pixel(lit_floor(map), lambert(n));
    std::get<Bitmap>(ramp->source).filter = Filter::nearest;
    expect_every_pixel(lit_floor(map), lambert({0, 0, 1}));
}

// ---- blends ------------------------------------------------------------------------------------------------------

TEST(BlendedMaterial, WholeWeightIsOneOfThem) {
    for (const float weight : {-1.0F, 0.0F, 1.0F, 2.0F}) {
        const Blend blend{constant(weight), diffuse(), diffuse(Rgb{0.1F, 0.4F, 0.9F})};
        expect_every_pixel(lit_floor(blend), lambert({0, 0, 1}, weight > 0.0F ? Rgb{0.1F, 0.4F, 0.9F} : albedo));
    }
}

TEST(BlendedMaterial, BlendsInsideBlends) {
    const Blend inner{constant(0.25F), diffuse(Rgb{0.9F}), diffuse(Rgb{0.3F})};
    const Blend outer{constant(0.4F), nested(inner), nested(mapped(tilted, diffuse()))};
    const glm::dvec3 expected = 0.6 * (0.75 * lambert({0, 0, 1}, Rgb(0.9F)) + 0.25 * lambert({0, 0, 1}, Rgb(0.3F))) + 0.4 * lambert(tilted);
    expect_mean(lit_floor(outer, 1.0, 1024), expected);
}

TEST(BlendedMaterial, OneSidedAndTransmissive) {
    // Seen from below, the diffuse share is black, and the glass shows the environment.
    Scene scene = empty_scene(32);
    const int material = add_material(scene, Blend{constant(0.3F), nested(ThinDielectric{}), diffuse()});
    add_floor(scene, 50.0F, material).material.back = material;
    look_at_point(scene, {0.5F, -3.0F, 0.2F}, {0, 0, 0});
    scene.emitters.emplace_back(ConstantEmitter{irradiance});
    expect_mean(render(scene, 256).image, 0.7 * glm::dvec3(irradiance));
}

// A mirror and an even diffuse surface that lose nothing give an even environment back.
TEST(BlendedMaterial, DeltaAndDiffuseKeepEnergy) {
    Scene scene = empty_scene(32);
    const int material = add_material(scene, Blend{constant(0.5F), nested(Conductor{}), diffuse(Rgb(1.0F))});
    add_floor(scene, 50.0F, material);
    look_at_point(scene, {0.5F, 3.0F, 0.2F}, {0, 0, 0});
    scene.emitters.emplace_back(ConstantEmitter{irradiance});
    expect_mean(render(scene, 256).image, glm::dvec3(irradiance));
}

TEST(NestedMaterials, AreCompiledWhereTheyAreUsed) {
    Scene scene = empty_scene(16);
    add_floor(scene, 1.0F, add_material(scene, mapped(tilted, nested(TwoSided{diffuse(), diffuse()}))));
    const FeatureSet maps = flatten_scene(scene).features;
    EXPECT_TRUE(maps.normal_maps && maps.nested_sides && !maps.bump_maps && !maps.blends);
    EXPECT_EQ(maps.material_levels, 2);
    scene.materials[0].model = Blend{constant(0.5F), diffuse(), nullptr};
    const FeatureSet blends = flatten_scene(scene).features;
    EXPECT_TRUE(blends.blends && !blends.normal_maps && !blends.nested_sides);
}

}  // namespace
}  // namespace wavelobe::test
