// The principled BSDFs and Ward's, as files give them.
#include <gtest/gtest.h>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

Scene with_bsdf(const std::string& type, const std::string& inside) {
    return SceneFolder().elements("<shape type=\"sphere\"><bsdf type=\"" + type + "\">" + inside + "</bsdf></shape>");
}

template <typename Model>
Model model_of(const Scene& scene) {
    return std::get<Model>(scene.materials.at(0).model);
}

std::vector<Fault> faults(const std::string& type, const std::string& inside) {
    return SceneFolder().element_faults("<shape type=\"sphere\"><bsdf type=\"" + type + "\">" + inside + "</bsdf></shape>");
}

TEST(PrincipledBsdf, Defaults) {
    const Scene scene = with_bsdf("principled", "");
    EXPECT_EQ(scene.shapes.at(0).material.back, -1);
    const auto m = model_of<Principled>(scene);
    EXPECT_EQ(m.surface.base_color.value, Rgb(0.5F));
    EXPECT_EQ(m.surface.roughness.value.x, 0.5F);
    EXPECT_FALSE(m.transmissive);
    EXPECT_FLOAT_EQ(m.eta, 1.5F);  // of specular 0.5
    for (const Parameter* p : {&m.surface.anisotropic, &m.surface.spec_trans, &m.surface.spec_tint, &m.surface.sheen, &m.surface.sheen_tint,
                               &m.surface.flatness, &m.metallic, &m.clearcoat, &m.clearcoat_gloss})
        EXPECT_EQ(p->value.x, 0.0F);
}

TEST(PrincipledBsdf, IndexAndSpecularSayTheSame) {
    EXPECT_FLOAT_EQ(model_of<Principled>(with_bsdf("principled", R"(<float name="specular" value="0"/>)")).eta, 1.0F);
    const std::string glass = R"(<float name="spec_trans" value="0.5"/>)";
    EXPECT_EQ(model_of<Principled>(with_bsdf("principled", glass + R"(<float name="eta" value="1"/>)")).eta, 1.001F);
    EXPECT_TRUE(has_text(faults("principled", R"(<float name="eta" value="1.5"/><float name="specular" value="0.5"/>)"),
                         "both `eta` and `specular` are given"));
}

TEST(PrincipledBsdf, WhatRefractsHasTwoSides) {
    const Scene scene = with_bsdf("principled", R"(<texture type="checkerboard" name="spec_trans"/>)");
    EXPECT_EQ(scene.shapes.at(0).material.back, 0);
    EXPECT_TRUE(model_of<Principled>(scene).transmissive);
    EXPECT_EQ(with_bsdf("principledthin", "").shapes.at(0).material.back, 0);
    EXPECT_TRUE(has_text(faults("twosided", R"(<bsdf type="principledthin"/>)"), "transmits light"));
}

TEST(PrincipledBsdf, Ranges) {
    EXPECT_TRUE(has_text(faults("principled", R"(<float name="anisotropic" value="1.5"/>)"), "`anisotropic` is 1.5"));
    EXPECT_TRUE(has_text(faults("principledthin", R"(<float name="diff_trans" value="2.5"/>)"), "`diff_trans` is 2.5"));
    EXPECT_EQ(model_of<PrincipledThin>(with_bsdf("principledthin", R"(<float name="diff_trans" value="1.5"/>)")).diff_trans.value.x, 1.5F);
    EXPECT_TRUE(has_text(faults("principled", R"(<float name="diff_trans" value="1"/>)"), "unknown property `diff_trans`"));
}

TEST(WardBsdf, ReadsBothSpellings) {
    const auto m = model_of<Ward>(with_bsdf("ward", R"(<string name="variant" value="ward-duer"/><float name="alpha_u" value="0.2"/>
        <float name="alpha_v" value="0.3"/><rgb name="specularReflectance" value="0.5"/>)"));
    EXPECT_EQ(m.variant, Ward::Variant::ward_duer);
    EXPECT_EQ(m.alpha_v.value.x, 0.3F);
    EXPECT_EQ(m.specular_reflectance.value, Rgb(0.5F));
    const auto plain = model_of<Ward>(with_bsdf("ward", ""));
    EXPECT_EQ(plain.variant, Ward::Variant::balanced);
    EXPECT_EQ(plain.specular_reflectance.value, Rgb(0.2F));
    EXPECT_EQ(plain.alpha_u.value.x, 0.1F);
}

}  // namespace
}  // namespace wavelobe::test
