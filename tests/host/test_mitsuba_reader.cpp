// Scenes as a whole: substitution, references, includes, sensor, film, integrator and emitters.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

TEST(MitsubaReader, EmptySceneHasTheDefaults) {
    const Scene scene = SceneFolder().elements("");
    EXPECT_EQ(scene.name, "scene");
    EXPECT_EQ(scene.film.width, 768);
    EXPECT_EQ(scene.film.height, 576);
    EXPECT_EQ(scene.film.crop_width, 768);
    EXPECT_EQ(scene.film.filter.kind, ReconstructionFilter::Kind::gaussian);
    EXPECT_FLOAT_EQ(scene.film.filter.radius, 2.0F);
    EXPECT_EQ(scene.sample_count, 4);
    EXPECT_EQ(scene.integrator.max_depth, -1);
    EXPECT_EQ(scene.integrator.rr_depth, 1);
    EXPECT_FALSE(scene.integrator.hide_emitters);
    EXPECT_FLOAT_EQ(scene.camera.near_clip, 0.01F);
    EXPECT_FLOAT_EQ(scene.camera.far_clip, 10000.0F);
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(MitsubaReader, SubstitutesDefaultsAndDefinitions) {
    const std::string xml = R"(<scene version="3.0.0">
        <default name="depth" value="7"/>
        <default name="depth_rr" value="3"/>
        <default name="kind" value="path"/>
        <integrator type="$kind">
            <integer name="max_depth" value="$depth"/>
            <integer name="rr_depth" value="$depth_rr"/>
        </integrator>
        <sensor type="perspective"/>
        <shape type="sphere" id="a\$b"/>
    </scene>)";
    const SceneFolder folder;
    const Scene plain = folder.read(xml);
    EXPECT_EQ(plain.integrator.max_depth, 7);
    EXPECT_EQ(plain.integrator.rr_depth, 3);
    EXPECT_EQ(plain.shapes.at(0).name, "a$b");
    const Scene defined = folder.read(xml, {{"depth", "11"}, {"kind", "volpath"}, {"depth_rr", "4"}});
    EXPECT_EQ(defined.integrator.max_depth, 11);
    EXPECT_EQ(defined.integrator.rr_depth, 4);
}

TEST(MitsubaReader, DirectIntegratorRefusesDepthAndIsTwoEdgesDeep) {
    const SceneFolder folder;
    const Scene scene = folder.elements(
        R"(<integrator type="direct"><integer name="emitter_samples" value="4"/><boolean name="hide_emitters" value="true"/></integrator>)");
    EXPECT_EQ(scene.integrator.max_depth, 2);
    EXPECT_TRUE(scene.integrator.hide_emitters);
    EXPECT_FALSE(scene.integrator.environment_covers);
    EXPECT_TRUE(has_text(
        folder.element_faults(R"(<integrator type="direct"><integer name="max_depth" value="3"/></integrator>)"),
        "unknown property `max_depth`"));
}

// Mitsuba's own pictures are then brighter.
TEST(MitsubaReader, TellsOfManySamplesOfLightsWithoutExtent) {
    const SceneFolder folder;
    const auto warnings = [&](const char* samples, const char* light) {
        return folder.elements(std::string(R"(<integrator type="direct"><integer name="emitter_samples" value=")") + samples + R"("/></integrator>)" + light).warnings;
    };
    ASSERT_EQ(warnings("4", R"(<emitter type="point"/>)").size(), 1U);
    EXPECT_NE(warnings("4", R"(<emitter type="point"/>)")[0].find("as many times as bright"), std::string::npos);
    EXPECT_TRUE(warnings("1", R"(<emitter type="point"/>)").empty());
    EXPECT_TRUE(warnings("4", R"(<emitter type="constant"/>)").empty());
}

TEST(MitsubaReader, ReferencesMayComeFirst) {
    const Scene scene = SceneFolder().elements(R"(
        <shape type="sphere"><ref id="red"/></shape>
        <shape type="disk"><ref id="also-red"/></shape>
        <bsdf type="diffuse" id="red"><rgb name="reflectance" value="0.5, 0.25, 0"/></bsdf>
        <bsdf type="diffuse" id="unused"/>
        <alias id="red" as="also-red"/>)");
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "red");
    EXPECT_EQ(std::get<Diffuse>(scene.materials[0].model).reflectance.value, Rgb(0.5F, 0.25F, 0.0F));
    EXPECT_EQ(scene.shapes.at(0).material.front, 0);
    EXPECT_EQ(scene.shapes.at(0).material.back, -1);
    EXPECT_EQ(scene.shapes.at(1).material.front, 0);
}

TEST(MitsubaReader, ReadsIncludes) {
    const SceneFolder folder;
    folder.write(
        "parts/inner.xml",
        R"(<scene version="3.0.0"><shape type="ply"><string name="filename" value="mesh.ply"/></shape></scene>)");
    folder.write(
        "parts/mesh.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    folder.write("parts/material.xml",
                 R"(<bsdf version="3.0.0" type="diffuse" id="m"><float name="reflectance" value="$grey"/></bsdf>)");
    const Scene scene = folder.elements(R"(
        <default name="grey" value="0.25"/>
        <include filename="parts/inner.xml"/>
        <path value="parts"/>
        <include filename="material.xml"/>
        <shape type="cube"><ref id="m"/></shape>)");
    ASSERT_EQ(scene.shapes.size(), 2U);
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(std::get<Diffuse>(scene.materials[1].model).reflectance.value, Rgb(0.25F));
}

TEST(MitsubaReader, AppliesTransformsInOrder) {
    const Scene scene = SceneFolder().elements(R"(
        <shape type="sphere"><transform name="to_world"><scale value="2"/><translate x="1" y="2" z="3"/></transform></shape>
        <shape type="disk"><transform name="to_world"><translate x="1"/><scale x="2" y="3"/></transform></shape>
        <shape type="disk"><transform name="to_world"><rotate z="2" angle="90"/></transform></shape>
        <shape type="disk"><transform name="to_world"><matrix value="1 2 3 4  0 1 0 5  0 0 1 6  0 0 0 1"/></transform></shape>
        <shape type="disk"><transform name="to_world"><matrix value="1, 2, 3, 0, 1, 0, 0, 0, -4.5e-001"/></transform></shape>
        <shape type="disk"><transform name="to_world"><lookat origin="1, 2, 3" target="1, 2, 8" up="0, 1, 0"/></transform></shape>)");
    const auto matrix = [&](std::size_t i) {
        return std::get<AnalyticShape>(scene.shapes.at(i).geometry).to_world;
    };
    EXPECT_EQ(matrix(0), glm::mat4(glm::vec4(2, 0, 0, 0), glm::vec4(0, 2, 0, 0), glm::vec4(0, 0, 2, 0),
                                   glm::vec4(1, 2, 3, 1)));
    EXPECT_EQ(matrix(1), glm::mat4(glm::vec4(2, 0, 0, 0), glm::vec4(0, 3, 0, 0), glm::vec4(0, 0, 1, 0),
                                   glm::vec4(2, 0, 0, 1)));
    EXPECT_NEAR(glm::distance(matrix(2) * glm::vec4(1, 0, 0, 1), glm::vec4(0, 2, 0, 1)), 0.0F, 1e-6F);
    EXPECT_EQ(matrix(3) * glm::vec4(0, 1, 0, 1), glm::vec4(6, 6, 6, 1));
    EXPECT_EQ(matrix(4) * glm::vec4(0, 0, 1, 1), glm::vec4(3, 0, -0.45F, 1));
    EXPECT_EQ(matrix(5) * glm::vec4(1, 0, 1, 1), glm::vec4(2, 2, 4, 1));
}

TEST(MitsubaReader, ReadsTheSensor) {
    const Scene scene = SceneFolder().read(R"(<scene version="3.5.2"><sensor type="perspective">
        <float name="fov" value="50"/>
        <float name="near_clip" value="0.5"/>
        <float name="principal_point_offset_x" value="0.25"/>
        <transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
        <sampler type="multijitter"><integer name="sample_count" value="33"/><integer name="seed" value="9"/></sampler>
        <film type="hdrfilm">
            <integer name="width" value="300"/><integer name="height" value="200"/>
            <integer name="crop_offset_x" value="10"/><integer name="crop_width" value="100"/>
            <string name="pixel_format" value="rgba"/><boolean name="banner" value="false"/>
            <rfilter type="gaussian"><float name="stddev" value="0.25"/></rfilter>
        </film></sensor></scene>)");
    EXPECT_FLOAT_EQ(scene.camera.fov_x_degrees, 50.0F);
    EXPECT_FLOAT_EQ(scene.camera.near_clip, 0.5F);
    EXPECT_EQ(scene.camera.principal_point_offset, glm::vec2(0.25F, 0.0F));
    EXPECT_EQ(scene.camera.to_world[3], glm::vec4(0, 0, 5, 1));
    EXPECT_EQ(scene.camera.to_world[2], glm::vec4(0, 0, -1, 0));
    EXPECT_EQ(scene.camera.to_world[0], glm::vec4(-1, 0, 0, 0));
    EXPECT_EQ(scene.sample_count, 33);
    EXPECT_EQ(scene.seed, 9U);
    EXPECT_EQ(scene.film.crop_x, 10);
    EXPECT_EQ(scene.film.crop_width, 100);
    EXPECT_EQ(scene.film.crop_height, 200);
    EXPECT_FLOAT_EQ(scene.film.filter.radius, 1.0F);
    EXPECT_FLOAT_EQ(scene.film.filter.stddev, 0.25F);
}

// Reference values: Mitsuba 3.9.1.
TEST(MitsubaReader, ResolvesTheAxisOfTheFieldOfView) {
    struct Degrees {
        float wide;  // 640 x 480
        float tall;  // 300 x 500
    };
    const std::string fov = R"(<float name="fov" value="50"/><string name="fov_axis" value=")";
    const std::vector<std::pair<std::string, Degrees>> cases{
        {"", {38.18484F, 25.09940F}},
        {R"(<string name="focal_length" value="35mm"/>)", {52.62254F, 35.28205F}},
        {fov + "x\"/>", {50.0F, 50.0F}},
        {fov + "y\"/>", {63.74203F, 31.26160F}},
        {fov + "diagonal\"/>", {40.91567F, 26.98207F}},
        {fov + "smaller\"/>", {63.74203F, 50.0F}},
        {fov + "larger\"/>", {50.0F, 31.26160F}}};
    const SceneFolder folder;
    const auto degrees = [&](const std::string& properties, int width, int height) {
        return folder
            .read("<scene version=\"3.0.0\"><sensor type=\"perspective\">" + properties +
                  "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" + std::to_string(width) +
                  "\"/><integer name=\"height\" value=\"" + std::to_string(height) + "\"/></film></sensor></scene>")
            .camera.fov_x_degrees;
    };
    for (const auto& [properties, expected] : cases) {
        EXPECT_NEAR(degrees(properties, 640, 480), expected.wide, 1e-4F) << properties;
        EXPECT_NEAR(degrees(properties, 300, 500), expected.tall, 1e-4F) << properties;
    }
}

TEST(MitsubaReader, UsesTheFirstOfSeveralSensors) {
    const Scene scene = SceneFolder().read(R"(<scene version="3.0.0">
        <sensor type="perspective"><float name="fov" value="30"/></sensor>
        <sensor type="perspective"><float name="fov" value="60"/></sensor></scene>)");
    EXPECT_FLOAT_EQ(scene.camera.fov_x_degrees, 30.0F);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find("first sensor"), std::string::npos);
}

TEST(MitsubaReader, ReadsEmitters) {
    const Scene scene = SceneFolder().elements(R"(
        <emitter type="constant"><spectrum name="radiance" value="2"/></emitter>
        <emitter type="point"><point name="position" x="1" y="2" z="3"/><float name="intensity" value="4"/></emitter>
        <emitter type="point"><transform name="to_world"><translate z="7"/></transform></emitter>
        <emitter type="spot"><float name="cutoff_angle" value="40"/><rgb name="intensity" value="1 2 3"/></emitter>
        <emitter type="directional"><vector name="direction" x="0" y="-3" z="4"/><rgb name="irradiance" value="5"/></emitter>
        <emitter type="directional"><transform name="to_world"><rotate x="1" angle="90"/></transform></emitter>)");
    ASSERT_EQ(scene.emitters.size(), 6U);
    // A uniform spectrum is no neutral white in sRGB.
    const Rgb constant = std::get<ConstantEmitter>(scene.emitters[0]).radiance;
    EXPECT_NEAR(constant.r, 2.409588F, 1e-5F);
    EXPECT_NEAR(constant.g, 1.896582F, 1e-5F);
    EXPECT_NEAR(constant.b, 1.817832F, 1e-5F);
    EXPECT_EQ(std::get<PointEmitter>(scene.emitters[1]).position, glm::vec3(1, 2, 3));
    EXPECT_EQ(std::get<PointEmitter>(scene.emitters[1]).intensity, Rgb(4.0F));
    EXPECT_EQ(std::get<PointEmitter>(scene.emitters[2]).position, glm::vec3(0, 0, 7));
    EXPECT_FLOAT_EQ(std::get<SpotEmitter>(scene.emitters[3]).cutoff_degrees, 40.0F);
    EXPECT_FLOAT_EQ(std::get<SpotEmitter>(scene.emitters[3]).beam_width_degrees, 30.0F);
    const auto direction = std::get<DirectionalEmitter>(scene.emitters[4]).direction;
    EXPECT_NEAR(glm::distance(direction, glm::vec3(0.0F, -0.6F, 0.8F)), 0.0F, 1e-6F);
    const auto turned = std::get<DirectionalEmitter>(scene.emitters[5]).direction;
    EXPECT_NEAR(glm::distance(turned, glm::vec3(0.0F, -1.0F, 0.0F)), 0.0F, 1e-6F);
}

TEST(MitsubaReader, AreaEmitterBelongsToItsShape) {
    const Scene scene = SceneFolder().elements(
        R"(<shape type="rectangle"><emitter type="area"><rgb name="radiance" value="3, 2, 1"/></emitter></shape>)");
    ASSERT_TRUE(scene.shapes.at(0).emitter);
    EXPECT_EQ(scene.shapes[0].emitter->radiance.value, Rgb(3, 2, 1));
    EXPECT_TRUE(scene.emitters.empty());
    // Without a BSDF a light reflects nothing.
    EXPECT_EQ(std::get<Diffuse>(scene.materials.at(0).model).reflectance.value, Rgb(0.0F));
}

TEST(MitsubaReader, LightsThatAreNeverSampledShineOnlyWhereTheyAreMet) {
    const auto lights = [](const char* weight) {
        const std::string inner = std::string("<float name=\"sampling_weight\" value=\"") + weight + "\"/></emitter>";
        return SceneFolder().elements(R"(<emitter type="point">)" + inner + R"(<emitter type="directional">)" + inner +
                                      R"(<emitter type="spot">)" + inner + R"(<emitter type="projector">)" + inner +
                                      R"(<emitter type="constant">)" + inner + R"(<shape type="disk"><emitter type="area">)" + inner + "</shape>");
    };
    EXPECT_EQ(lights("3").emitters.size(), 5U);
    EXPECT_TRUE(lights("3").warnings.empty());
    ASSERT_EQ(lights("0").emitters.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<ConstantEmitter>(lights("0").emitters[0]));
    EXPECT_TRUE(lights("0").shapes.at(0).emitter.has_value());
}

TEST(MitsubaReader, ShapesShareAnAreaEmitterThatStandsBesideThem) {
    const SceneFolder folder;
    const std::string lamp = R"(<emitter type="area" id="lamp"><rgb name="radiance" value="3, 2, 1"/></emitter>)";
    const std::string shape = R"(<shape type="rectangle"><ref id="lamp"/></shape>)";
    const Scene scene = folder.elements(lamp + shape + shape);
    EXPECT_EQ(scene.shapes.at(1).emitter.value().radiance.value, Rgb(3, 2, 1));
    EXPECT_TRUE(has_text(folder.element_faults(lamp), "an area light needs a shape"));
}

TEST(MitsubaReader, IntegratorsToDifferentiateArePaths) {
    const SceneFolder folder;
    EXPECT_EQ(folder.elements(R"(<integrator type="prb"/>)").integrator.max_depth, 6);
    EXPECT_EQ(folder.elements(R"(<integrator type="direct_projective"><integer name="sppc" value="1"/></integrator>)").integrator.max_depth, 2);
    const Scene particles = folder.elements(R"(<integrator type="ptracer"><integer name="max_depth" value="7"/></integrator>)");
    EXPECT_EQ(particles.integrator.max_depth, 7);
    EXPECT_EQ(particles.warnings.size(), 1U);
}

TEST(MitsubaReader, VolpathIsPathWithoutMedia) {
    const SceneFolder folder;
    EXPECT_EQ(folder.elements(R"(<integrator type="volpath"><integer name="max_depth" value="65"/></integrator>)")
                  .integrator.max_depth,
              65);
    const auto faults = folder.element_faults(
        R"(<integrator type="volpath"/><shape type="cube"><medium type="homogeneous" name="interior"/></shape>)");
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_NE(faults[0].message.find("scattering media"), std::string::npos);
    EXPECT_EQ(faults[0].line, 2);
}

std::string shared_scene(const std::string& name) {
    const char* data = std::getenv("WAVELOBE_DATA");
    return std::string(data != nullptr ? data : WAVELOBE_SOURCE_DIR "/../shared/data") + "/scenes/" + name;
}

TEST(MitsubaReader, CornellBox) {
    const std::string path = shared_scene("cornell-box/scene_v3.xml");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const Scene scene = read_mitsuba_scene(path, {{"spp", "16"}});
    EXPECT_EQ(scene.materials.size(), 8U);
    EXPECT_EQ(scene.shapes.size(), 8U);
    EXPECT_EQ(scene.sample_count, 16);
    EXPECT_EQ(scene.integrator.max_depth, 65);
    EXPECT_FLOAT_EQ(scene.camera.fov_x_degrees, 19.5F);
    EXPECT_EQ(scene.film.filter.kind, ReconstructionFilter::Kind::tent);
    EXPECT_EQ(scene.shapes[7].emitter.value().radiance.value, Rgb(17, 12, 4));
}

TEST(MitsubaReader, VeachBidir) {
    const std::string path = shared_scene("veach-bidir/scene.xml");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const Scene scene = read_mitsuba_scene(path);
    EXPECT_EQ(scene.materials.size(), 4U);
    ASSERT_EQ(scene.shapes.size(), 14U);
    std::size_t triangles = 0;
    for (const Shape& shape : scene.shapes) triangles += std::get<TriangleMesh>(shape.geometry).triangles.size();
    EXPECT_EQ(triangles, 11544U);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_TRUE(std::get<TriangleMesh>(scene.shapes[0].geometry).normals.empty());
    EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[7].geometry).normals.size(), 3970U);
}

TEST(MitsubaReader, ModernHall) {
    const std::string path = shared_scene("modern-hall/scene.xml");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const Scene scene = read_mitsuba_scene(path);
    EXPECT_EQ(scene.shapes.size(), 32U);
    EXPECT_EQ(scene.media.size(), 1U);
    EXPECT_TRUE(std::any_of(scene.materials.begin(), scene.materials.end(),
                            [](const Material& m) { return std::holds_alternative<Principled>(m.model); }));
}

}  // namespace
}  // namespace wavelobe::test
