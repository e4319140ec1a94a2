// BSDFs and their parameters.
#include <gtest/gtest.h>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

// The scene of a sphere with this BSDF.
Scene with_bsdf(const std::string& xml) {
    return SceneFolder().elements("<shape type=\"sphere\">" + xml + "</shape>");
}

template <typename Model>
Model model_of(const std::string& xml) {
    return std::get<Model>(with_bsdf(xml).materials.at(0).model);
}

TEST(Materials, Defaults) {
    EXPECT_EQ(model_of<Diffuse>("").reflectance.value, Rgb(0.5F));
    EXPECT_EQ(model_of<Diffuse>(R"(<bsdf type="diffuse"/>)").reflectance.value, Rgb(0.5F));
    const auto mirror = model_of<Conductor>(R"(<bsdf type="conductor"/>)");
    EXPECT_EQ(mirror.eta, Rgb(0.0F));
    EXPECT_EQ(mirror.k, Rgb(1.0F));
    const auto rough = model_of<RoughConductor>(R"(<bsdf type="roughconductor"/>)");
    EXPECT_EQ(rough.alpha_u.value.r, 0.1F);
    EXPECT_EQ(rough.distribution, Distribution::beckmann);
    EXPECT_FLOAT_EQ(model_of<Dielectric>(R"(<bsdf type="dielectric"/>)").eta, 1.5046F / 1.000277F);
    EXPECT_FLOAT_EQ(model_of<ThinDielectric>(R"(<bsdf type="thindielectric"/>)").eta, 1.5046F / 1.000277F);
    const auto plastic = model_of<Plastic>(R"(<bsdf type="plastic"/>)");
    EXPECT_FLOAT_EQ(plastic.eta, 1.49F / 1.000277F);
    EXPECT_FALSE(plastic.nonlinear);
    const auto rough_plastic = model_of<RoughPlastic>(R"(<bsdf type="roughplastic"/>)");
    EXPECT_FLOAT_EQ(rough_plastic.eta, 1.49F / 1.000277F);
    EXPECT_EQ(rough_plastic.alpha, 0.1F);
    EXPECT_EQ(rough_plastic.distribution, Distribution::beckmann);
    const auto phong = model_of<Phong>(R"(<bsdf type="phong"/>)");
    EXPECT_EQ(phong.diffuse_reflectance.value, Rgb(0.5F));
    EXPECT_EQ(phong.specular_reflectance.value, Rgb(0.2F));
    EXPECT_EQ(phong.exponent.value.r, 30.0F);
}

TEST(Materials, ColourForms) {
    const auto colour = [](const std::string& value) {
        return model_of<Diffuse>("<bsdf type=\"diffuse\">" + value + "</bsdf>").reflectance.value;
    };
    EXPECT_EQ(colour(R"(<rgb name="reflectance" value="0.25, 0.5, 1"/>)"), Rgb(0.25F, 0.5F, 1.0F));
    EXPECT_EQ(colour(R"(<rgb name="reflectance" value="0.25 0.5 +1e0"/>)"), Rgb(0.25F, 0.5F, 1.0F));
    EXPECT_EQ(colour(R"(<rgb name="reflectance" value="0.75"/>)"), Rgb(0.75F));
    EXPECT_EQ(colour(R"(<rgb name="reflectance" value="#ff0033"/>)"), Rgb(1.0F, 0.0F, 0.2F));
    EXPECT_EQ(colour(R"(<spectrum name="reflectance" value="0.125"/>)"), Rgb(0.125F));
    EXPECT_EQ(colour(R"(<float name="reflectance" value="0.125"/>)"), Rgb(0.125F));
}

TEST(Materials, NamedIndices) {
    const auto gold = model_of<Conductor>(R"(<bsdf type="conductor"><string name="material" value="Au"/></bsdf>)");
    EXPECT_NEAR(gold.eta.r, 0.143036F, 1e-6F);
    EXPECT_NEAR(gold.k.b, 1.603359F, 1e-6F);
    const auto given = model_of<RoughConductor>(
        R"(<bsdf type="roughconductor"><rgb name="eta" value="2.5, 2, 1.5"/><float name="k" value="3"/><string name="distribution" value="GGX"/>
           <float name="alpha_u" value="0.2"/><float name="alpha_v" value="0"/></bsdf>)");
    EXPECT_EQ(given.eta, Rgb(2.5F, 2.0F, 1.5F));
    EXPECT_EQ(given.k, Rgb(3.0F));
    EXPECT_EQ(given.distribution, Distribution::ggx);
    EXPECT_EQ(given.alpha_u.value.r, 0.2F);
    EXPECT_EQ(given.alpha_v.value.r, 1e-4F);
    const auto ice = model_of<RoughDielectric>(
        R"(<bsdf type="roughdielectric"><string name="int_ior" value="Water ice"/><float name="ext_ior" value="1"/></bsdf>)");
    EXPECT_FLOAT_EQ(ice.eta, 1.31F);
}

TEST(Materials, Sides) {
    const auto sides = [](const std::string& xml) { return with_bsdf(xml).shapes.at(0).material; };
    const auto diffuse = sides(R"(<bsdf type="diffuse"/>)");
    EXPECT_EQ(diffuse.back, -1);
    const auto glass = sides(R"(<bsdf type="dielectric"/>)");
    EXPECT_EQ(glass.back, glass.front);
    EXPECT_EQ(sides(R"(<bsdf type="conductor"/>)").back, -1);
    const auto same = sides(R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)");
    EXPECT_EQ(same.back, same.front);
    const Scene two =
        with_bsdf(R"(<bsdf type="twosided"><bsdf type="diffuse" id="a"/><bsdf type="plastic" id="b"/></bsdf>)");
    EXPECT_EQ(two.materials.at(static_cast<std::size_t>(two.shapes[0].material.front)).name, "a");
    EXPECT_EQ(two.materials.at(static_cast<std::size_t>(two.shapes[0].material.back)).name, "b");
}

TEST(Materials, PhongTakesTheNamesOfMitsuba0) {
    const auto phong = model_of<Phong>(R"(<bsdf type="phong"><rgb name="diffuseReflectance" value="0.1"/>
        <rgb name="specular_reflectance" value="0.3"/><float name="exponent" value="12"/></bsdf>)");
    EXPECT_EQ(phong.diffuse_reflectance.value, Rgb(0.1F));
    EXPECT_EQ(phong.specular_reflectance.value, Rgb(0.3F));
    EXPECT_EQ(phong.exponent.value.r, 12.0F);
}

TEST(Materials, CheckerboardsSwapAndAverageInScalarUse) {
    const Scene scene = with_bsdf(R"(<bsdf type="roughconductor">
        <texture type="checkerboard" name="specular_reflectance" id="board">
            <rgb name="color0" value="0.1, 0.2, 0.3"/><rgb name="color1" value="0.7, 0.8, 0.9"/></texture>
        <ref name="alpha" id="board"/></bsdf>)");
    const auto& model = std::get<RoughConductor>(scene.materials.at(0).model);
    const auto& colours = std::get<Checkerboard>(model.specular_reflectance.texture->source);
    EXPECT_EQ(colours.color0, Rgb(0.1F, 0.2F, 0.3F));
    const auto& scalars = std::get<Checkerboard>(model.alpha_u.texture->source);
    EXPECT_NEAR(scalars.color0.r, 0.8F, 1e-6F);
    EXPECT_NEAR(scalars.color1.g, 0.2F, 1e-6F);
}

TEST(Materials, UnusedMaterialsStayOut) {
    const Scene scene = SceneFolder().elements(R"(<bsdf type="conductor" id="unused"/>
        <shape type="sphere"/><shape type="disk"/><bsdf type="diffuse" id="also-unused"/>)");
    EXPECT_EQ(scene.materials.size(), 1U);
}

// ---- mask and null ----------------------------------------------------------------------------------------------

SurfaceMaterial surface_of(const std::string& xml) { return with_bsdf(xml).shapes.at(0).material; }

TEST(Materials, MaskHoldsItsOpacityBesideTheMaterial) {
    EXPECT_EQ(surface_of(R"(<bsdf type="diffuse"/>)").opacity.value.value, Rgb(1.0F));
    const SurfaceMaterial plain = surface_of(R"(<bsdf type="mask"><bsdf type="diffuse"/></bsdf>)");
    EXPECT_EQ(plain.opacity.value.value, Rgb(0.5F));
    EXPECT_EQ(plain.front, 0);
    EXPECT_EQ(plain.back, -1);
    const SurfaceMaterial both = surface_of(
        R"(<bsdf type="mask"><float name="opacity" value="0.25"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>)");
    EXPECT_EQ(both.opacity.value.value, Rgb(0.25F));
    EXPECT_EQ(both.back, 0);
    EXPECT_FALSE(both.opacity.cutoff.has_value());
    const SurfaceMaterial textured = surface_of(
        R"(<bsdf type="mask"><texture type="checkerboard" name="opacity"/><bsdf type="dielectric"/></bsdf>)");
    ASSERT_TRUE(textured.opacity.value.texture != nullptr);
    EXPECT_EQ(textured.opacity.texture_scale, 1.0F);
}

// One nested BSDF is shared by a shape with a mask and one without.
TEST(Materials, MaskDoesNotMarkTheMaterialItHolds) {
    const Scene scene = SceneFolder().elements(R"(<bsdf type="diffuse" id="d"/>
        <shape type="sphere"><ref id="d"/></shape>
        <shape type="sphere"><bsdf type="mask"><ref id="d"/></bsdf></shape>)");
    EXPECT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.shapes.at(0).material.opacity.value.value, Rgb(1.0F));
    EXPECT_EQ(scene.shapes.at(1).material.opacity.value.value, Rgb(0.5F));
}

TEST(Materials, NullIsNotThere) {
    EXPECT_EQ(surface_of(R"(<bsdf type="null"/>)").opacity.value.value, Rgb(0.0F));
    EXPECT_EQ(surface_of(R"(<bsdf type="mask"><float name="opacity" value="0.75"/><bsdf type="null"/></bsdf>)").opacity.value.value,
              Rgb(0.0F));
}

TEST(Materials, MaskFaults) {
    const auto faults = [](const std::string& xml) {
        return SceneFolder().element_faults("<shape type=\"sphere\">" + xml + "</shape>");
    };
    EXPECT_TRUE(has_text(faults(R"(<bsdf type="mask"/>)"), "holds 0 nested BSDFs; expected one"));
    EXPECT_TRUE(has_text(faults(R"(<bsdf type="mask"><bsdf type="diffuse"/><bsdf type="diffuse"/></bsdf>)"),
                         "holds 2 nested BSDFs; expected one"));
    EXPECT_TRUE(has_text(faults(R"(<bsdf type="mask"><bsdf type="mask"><bsdf type="diffuse"/></bsdf></bsdf>)"),
                         "holds another mask"));
    EXPECT_TRUE(has_text(faults(R"(<bsdf type="twosided"><bsdf type="mask"><bsdf type="diffuse"/></bsdf></bsdf>)"),
                         "holds a BSDF that transmits light"));
    EXPECT_TRUE(has_text(faults(R"(<bsdf type="null"><float name="opacity" value="1"/></bsdf>)"), "opacity"));
}

}  // namespace
}  // namespace wavelobe::test
