// BSDFs that hold others, as a file nests them.
#include <gtest/gtest.h>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

const std::string diffuse = R"(<bsdf type="diffuse"/>)";
const std::string glass = R"(<bsdf type="dielectric"/>)";
const std::string up = R"(<rgb name="normalmap" value="0.5, 0.5, 1"/>)";

Scene with_bsdf(const std::string& xml) { return SceneFolder().elements("<shape type=\"sphere\">" + xml + "</shape>"); }

std::string bsdf(const std::string& type, const std::string& inside) { return "<bsdf type=\"" + type + "\">" + inside + "</bsdf>"; }

template <typename Model>
Model model_of(const Scene& scene) {
    return std::get<Model>(scene.materials.at(0).model);
}

std::vector<Fault> faults(const std::string& xml) { return SceneFolder().element_faults("<shape type=\"sphere\">" + xml + "</shape>"); }

TEST(NestedBsdfs, NormalMapShowsOnBothSides) {
    const Scene scene = with_bsdf(bsdf("normalmap", up + diffuse));
    const SurfaceMaterial surface = scene.shapes.at(0).material;
    EXPECT_EQ(surface.front, 0);
    EXPECT_EQ(surface.back, 0);
    const auto map = model_of<NormalMapped>(scene);
    EXPECT_TRUE(map.perturbation.flip_invalid && map.perturbation.soften_terminator);
    EXPECT_EQ(map.normals.value, Rgb(0.5F, 0.5F, 1.0F));
    EXPECT_TRUE(std::holds_alternative<Diffuse>(map.nested->model));
    const auto plain = model_of<NormalMapped>(with_bsdf(bsdf(
        "normalmap", up + diffuse +
                         R"(<boolean name="flip_invalid_normals" value="false"/><boolean name="use_shadowing_function" value="false"/>)")));
    EXPECT_FALSE(plain.perturbation.flip_invalid || plain.perturbation.soften_terminator);
    const auto raw = model_of<NormalMapped>(with_bsdf(bsdf(
        "normalmap", R"(<texture type="rawconstant" name="normalmap"><vector name="value" x="-0.5" y="0.5" z="2"/></texture>)" + diffuse)));
    EXPECT_EQ(raw.normals.value, Rgb(-0.5F, 0.5F, 2.0F));
    EXPECT_TRUE(has_text(faults(bsdf("normalmap", R"(<texture type="rawconstant" name="normalmap"/>)" + diffuse)), "`value` is missing"));
}

TEST(NestedBsdfs, SidesKeepTheirPlace) {
    // Inside a map the two sides are a material; around one it is the outermost.
    const auto map = model_of<NormalMapped>(with_bsdf(bsdf("normalmap", up + bsdf("twosided", diffuse))));
    EXPECT_TRUE(std::holds_alternative<TwoSided>(map.nested->model));
    const auto sides = model_of<TwoSided>(with_bsdf(bsdf("twosided", bsdf("normalmap", up + diffuse))));
    EXPECT_TRUE(std::holds_alternative<NormalMapped>(sides.front->model));
    EXPECT_EQ(sides.front, sides.back);
    // Without any map they are the surface's own.
    const Scene plain = with_bsdf(bsdf("twosided", diffuse));
    EXPECT_TRUE(std::holds_alternative<Diffuse>(plain.materials.at(0).model));
}

TEST(NestedBsdfs, BumpMapTakesOneTexture) {
    const std::string board = R"(<texture type="checkerboard" name="any"/>)";
    const Scene flat = with_bsdf(bsdf("bumpmap", board + R"(<float name="scale" value="-2"/>)" + diffuse));
    EXPECT_EQ(model_of<BumpMapped>(flat).scale, -2.0F);
    ASSERT_EQ(flat.warnings.size(), 1U);
    EXPECT_NE(flat.warnings[0].find("of no slope"), std::string::npos);
    EXPECT_TRUE(has_text(faults(bsdf("bumpmap", diffuse)), "holds 0 nested textures; expected one"));
    EXPECT_TRUE(has_text(faults(bsdf("bumpmap", board)), "holds 0 nested BSDFs; expected one"));
}

TEST(NestedBsdfs, BlendOfOneSidedBsdfsHasNoBack) {
    const std::string half = R"(<float name="weight" value="0.25"/>)";
    const Scene scene = with_bsdf(bsdf("blendbsdf", half + diffuse + R"(<bsdf type="plastic"/>)"));
    EXPECT_EQ(scene.shapes.at(0).material.back, -1);
    const auto blend = model_of<Blend>(scene);
    EXPECT_EQ(blend.weight.value.x, 0.25F);
    EXPECT_TRUE(std::holds_alternative<Diffuse>(blend.first->model));
    EXPECT_TRUE(std::holds_alternative<Plastic>(blend.second->model));
    EXPECT_EQ(with_bsdf(bsdf("blendbsdf", half + diffuse + glass)).shapes.at(0).material.back, 0);
}

// What is not there of a blend is a matter of its opacity.
TEST(NestedBsdfs, BlendWithNothing) {
    const std::string nothing = R"(<bsdf type="null"/>)";
    const Scene constant = with_bsdf(bsdf("blendbsdf", R"(<float name="weight" value="0.25"/>)" + nothing + diffuse));
    EXPECT_EQ(constant.shapes.at(0).material.opacity.value.value.x, 0.25F);
    EXPECT_EQ(model_of<Blend>(constant).weight.value.x, 1.0F);
    const std::string board = R"(<texture type="checkerboard" name="weight"/>)";
    const Scene textured = with_bsdf(bsdf("blendbsdf", board + diffuse + nothing));
    const Opacity opacity = textured.shapes.at(0).material.opacity;
    EXPECT_FLOAT_EQ(std::get<Checkerboard>(opacity.value.texture->source).color0.x, 0.8F);
    EXPECT_EQ(model_of<Blend>(textured).weight.value.x, 0.0F);
    EXPECT_TRUE(has_text(faults(bsdf("blendbsdf", board + diffuse + bsdf("mask", R"(<float name="opacity" value="0.5"/>)" + diffuse))),
                         "how much of the blend is there cannot be told"));
}

TEST(NestedBsdfs, Faults) {
    EXPECT_TRUE(has_text(faults(bsdf("normalmap", diffuse)), "`normalmap` is missing"));
    EXPECT_TRUE(has_text(faults(bsdf("normalmap", up + diffuse + diffuse)), "holds 2 nested BSDFs; expected one"));
    EXPECT_TRUE(has_text(faults(bsdf("blendbsdf", diffuse + diffuse)), "`weight` is missing"));
    EXPECT_TRUE(has_text(faults(bsdf("blendbsdf", R"(<float name="weight" value="1"/>)" + diffuse)), "expected two"));
    EXPECT_TRUE(has_text(faults(bsdf("twosided", bsdf("normalmap", up + glass))), "transmits light"));
    std::string deep = diffuse;
    for (int i = 0; i < 20; ++i) deep = bsdf("normalmap", up + deep);
    EXPECT_TRUE(has_text(faults(deep), "nested more than 16 deep"));
}

TEST(NestedBsdfs, TwoSidedGlassWhereItIsAllowed) {
    const Scene scene = with_bsdf(bsdf("twosided", R"(<boolean name="allow_transmission" value="true"/>)" + glass));
    EXPECT_TRUE(std::holds_alternative<Dielectric>(model_of<TwoSided>(scene).back->model));
}

}  // namespace
}  // namespace wavelobe::test
