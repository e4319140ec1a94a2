// Files of Mitsuba 0.x: what they mean under the names of today.
#include <gtest/gtest.h>

#include "host/scene_files.h"
#include "scene/image.h"
#include "scene/mitsuba/upgrade.h"

namespace wavelobe::test {
namespace {

std::string old(const std::string& elements) {
    return "<scene version=\"0.6.0\"><sensor type=\"perspective\"/>\n" + elements + "\n</scene>";
}

const Diffuse& first_diffuse(const Scene& scene) { return std::get<Diffuse>(scene.materials.at(0).model); }

TEST(LegacyScenes, Names) {
    EXPECT_EQ(mitsuba::snake_case("toWorld"), "to_world");
    EXPECT_EQ(mitsuba::snake_case("intIOR"), "int_ior");
    EXPECT_EQ(mitsuba::snake_case("diffuseReflectance"), "diffuse_reflectance");
    EXPECT_EQ(mitsuba::snake_case("to_world"), "to_world");
    EXPECT_EQ(mitsuba::snake_case("fov"), "fov");
}

TEST(LegacyScenes, WholeScene) {
    const Scene scene = SceneFolder().read(R"(<scene version="0.5.0">
        <integrator type="bdpt"><integer name="maxDepth" value="9"/><boolean name="lightImage" value="true"/></integrator>
        <sensor type="perspective">
            <float name="fov" value="30"/><string name="fovAxis" value="y"/>
            <transform name="toWorld"><lookAt origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
            <sampler type="sobol"><integer name="sampleCount" value="16"/></sampler>
            <film type="ldrfilm">
                <integer name="width" value="64"/><integer name="height" value="32"/>
                <string name="fileFormat" value="png"/><float name="gamma" value="2.2"/><boolean name="banner" value="false"/>
                <rfilter type="gaussian"/>
            </film>
        </sensor>
        <bsdf type="diffuse" id="wall"><srgb name="diffuseReflectance" value="0.5, 0.5, 0.5"/></bsdf>
        <shape type="sphere"><point name="center" x="0" y="0" z="0"/><boolean name="flipNormals" value="true"/>
            <ref id="wall"/></shape>
        <shape type="rectangle"><emitter type="area"><spectrum name="radiance" value="17, 12, 4"/></emitter></shape>
    </scene>)");
    EXPECT_EQ(scene.integrator.max_depth, 9);
    EXPECT_EQ(scene.sample_count, 16);
    EXPECT_EQ(scene.film.width, 64);
    EXPECT_FLOAT_EQ(scene.camera.to_world[3].z, 5.0F);
    EXPECT_FLOAT_EQ(scene.camera.to_world[2].z, -1.0F);
    EXPECT_TRUE(scene.shapes.at(0).flip_normals);
    EXPECT_FLOAT_EQ(first_diffuse(scene).reflectance.value.r, srgb_to_linear(0.5F));
    EXPECT_EQ(scene.shapes.at(1).emitter->radiance.value, Rgb(17.0F, 12.0F, 4.0F));
    EXPECT_FALSE(scene.warnings.empty());
}

TEST(LegacyScenes, ChoicesThatAreNoMore) {
    const SceneFolder folder;
    folder.write("a.ppm", "P3 1 1 255 255 0 0");
    const Scene scene = folder.read(old(R"(<shape type="rectangle"><bsdf type="roughconductor">
        <string name="distribution" value="phong"/><rgb name="eta" value="-0.05, 4, 5"/>
        <texture name="specularReflectance" type="bitmap"><string name="filename" value="a.ppm"/>
            <string name="filterType" value="trilinear"/></texture></bsdf></shape>)"));
    const auto& metal = std::get<RoughConductor>(scene.materials.at(0).model);
    EXPECT_EQ(metal.distribution, Distribution::beckmann);
    EXPECT_EQ(metal.eta, Rgb(0.0F, 4.0F, 5.0F));
    EXPECT_EQ(std::get<Bitmap>(metal.specular_reflectance.texture->source).filter, Filter::bilinear);
    EXPECT_EQ(scene.warnings.size(), 2U);
}

TEST(LegacyScenes, PlacementOfTextures) {
    const Scene scene = SceneFolder().read(old(R"(<shape type="rectangle"><bsdf type="diffuse">
        <texture name="reflectance" type="checkerboard">
            <float name="uscale" value="4"/><float name="vscale" value="3"/><float name="uoffset" value="0.5"/>
        </texture></bsdf></shape>)"));
    const glm::mat3 to_uv = first_diffuse(scene).reflectance.texture->to_uv;
    EXPECT_EQ(to_uv * glm::vec3(0.0F, 0.0F, 1.0F), glm::vec3(2.0F, 0.0F, 1.0F));
    EXPECT_EQ(to_uv * glm::vec3(1.0F, 1.0F, 1.0F), glm::vec3(6.0F, 3.0F, 1.0F));
}

TEST(LegacyScenes, WhatIsUnknownIsPassedOverWithAWord) {
    const Scene scene = SceneFolder().read(old(R"(<shape type="sphere"><float name="maxSmoothAngle" value="3"/></shape>)"));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find("`max_smooth_angle` is ignored"), std::string::npos);
    const Scene bright = SceneFolder().read(
        old(R"(<shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="2, 0.5, 0"/></bsdf></shape>)"));
    EXPECT_EQ(first_diffuse(bright).reflectance.value, Rgb(1.0F, 0.5F, 0.0F));
    EXPECT_EQ(bright.warnings.size(), 1U);
}

TEST(LegacyScenes, WhatIsMisspelledIsNot) {
    const auto sphere = [](const std::string& name) {
        return SceneFolder().faults(old("<shape type=\"sphere\"><float name=\"" + name + "\" value=\"3\"/></shape>"));
    };
    for (const char* name : {"raduis", "radiuss", "radius_scale"}) EXPECT_TRUE(sphere(name).empty()) << name;  // too far, or a variant
    for (const char* name : {"ridius", "rdius", "raddius"}) EXPECT_TRUE(has_text(sphere(name), "did you mean `radius`?")) << name;
}

TEST(LegacyScenes, WhatChangesThePictureIsRefused) {
    const SceneFolder folder;
    EXPECT_TRUE(has_text(folder.faults(old(R"(<integrator type="ao"/>)")), "not supported"));
    EXPECT_TRUE(has_text(folder.faults(old(R"(<shape type="sphere"><subsurface type="dipole"/></shape>)")), "dipole"));
    EXPECT_TRUE(has_text(folder.faults(old(R"(<shape type="hair"/>)")), "not supported"));
}

TEST(LegacyScenes, VersionsMeanTheFileTheyStandIn) {
    const SceneFolder folder;
    folder.write("old.xml", R"(<scene version="0.6.0"><bsdf type="diffuse" id="a"><rgb name="diffuseReflectance" value="1"/></bsdf></scene>)");
    const std::string includes = R"(<include filename="old.xml"/><shape type="sphere"><ref id="a"/></shape>)";
    EXPECT_EQ(first_diffuse(folder.elements(includes)).reflectance.value, Rgb(1.0F));
    EXPECT_TRUE(has_text(folder.element_faults(includes + R"(<integrator type="path"><integer name="maxDepth" value="3"/></integrator>)"),
                         "did you mean `max_depth`?"));
}

TEST(LegacyScenes, NestingHasALimit) {
    std::string deep, chain, backwards = "<bsdf type=\"diffuse\" id=\"c3000\"/>";
    for (int i = 0; i < 100000; ++i) deep += "<bsdf type=\"twosided\">";
    for (int i = 0; i < 100000; ++i) deep += "</bsdf>";
    for (int i = 0; i < 3000; ++i)
        chain += "<bsdf type=\"twosided\" id=\"b" + std::to_string(i) + "\"><ref id=\"b" + std::to_string(i + 1) + "\"/></bsdf>";
    chain += "<bsdf type=\"diffuse\" id=\"b3000\"/>";
    for (int i = 2999; i >= 0; --i)
        backwards += "<bsdf type=\"twosided\" id=\"c" + std::to_string(i) + "\"><ref id=\"c" + std::to_string(i + 1) + "\"/></bsdf>";
    const SceneFolder folder;
    EXPECT_TRUE(has_text(folder.element_faults(deep), "nested more than 64 deep"));
    EXPECT_TRUE(has_text(folder.element_faults(chain), "nested more than 64 deep"));
    EXPECT_TRUE(has_text(folder.element_faults(backwards), "nested more than 64 deep"));
}

}  // namespace
}  // namespace wavelobe::test
