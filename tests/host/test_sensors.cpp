// What Mitsuba files say of cameras, films, and the channels of the picture.
#include <gtest/gtest.h>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

Scene with_sensor(const std::string& type, const std::string& body) {
    return SceneFolder().read("<scene version=\"3.0.0\"><sensor type=\"" + type + "\">" + body + "</sensor></scene>");
}

std::string first_fault(const std::string& xml) {
    const std::vector<Fault> faults = SceneFolder().faults("<scene version=\"3.0.0\">" + xml + "</scene>");
    return faults.empty() ? "" : faults.front().text();
}

TEST(Sensors, Orthographic) {
    const Scene scene = with_sensor("orthographic", R"(<transform name="to_world"><scale x="3" y="2"/></transform>)");
    EXPECT_EQ(scene.camera.projection, Camera::Projection::orthographic);
    EXPECT_EQ(scene.camera.to_world[0].x, 3.0F);
    EXPECT_EQ(scene.camera.aperture_radius, 0.0F);
}

TEST(Sensors, ThinLens) {
    const Scene scene = with_sensor("thinlens", R"(<float name="aperture_radius" value="0.2"/><float name="far_clip" value="50"/>)");
    EXPECT_FLOAT_EQ(scene.camera.aperture_radius, 0.2F);
    EXPECT_FLOAT_EQ(scene.camera.focus_distance, 50.0F) << "the far plane by default, as Mitsuba's";
    EXPECT_NE(first_fault("<sensor type=\"thinlens\"/>").find("`aperture_radius` is missing"), std::string::npos);
    EXPECT_NE(first_fault("<sensor type=\"thinlens\"><float name=\"aperture_radius\" value=\"1\"/><float name=\"focus_distance\" value=\"0\"/></sensor>")
                  .find("`focus_distance` is 0"),
              std::string::npos);
    EXPECT_NE(first_fault("<sensor type=\"thinlens\"><float name=\"aperture_radius\" value=\"1\"/><transform name=\"to_world\"><scale value=\"2\"/>"
                          "</transform></sensor>")
                  .find("cannot scale"),
              std::string::npos);
}

TEST(Films, FiltersAndTheirDefaults) {
    using Kind = ReconstructionFilter::Kind;
    const auto filter = [](const std::string& xml) { return with_sensor("perspective", "<film type=\"hdrfilm\">" + xml + "</film>").film.filter; };
    EXPECT_EQ(filter("").kind, Kind::gaussian);
    EXPECT_EQ(filter("<rfilter type=\"mitchell\"/>").kind, Kind::mitchell);
    EXPECT_FLOAT_EQ(filter("<rfilter type=\"mitchell\"/>").b, 1.0F / 3.0F);
    EXPECT_FLOAT_EQ(filter("<rfilter type=\"mitchell\"><float name=\"C\" value=\"0.6\"/></rfilter>").c, 0.6F);
    EXPECT_EQ(filter("<rfilter type=\"catmullrom\"/>").b, 0.0F);
    EXPECT_EQ(filter("<rfilter type=\"catmullrom\"/>").c, 0.5F);
    EXPECT_EQ(filter("<rfilter type=\"lanczos\"/>").radius, 3.0F);
    EXPECT_EQ(filter("<rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"2\"/></rfilter>").radius, 2.0F);
    EXPECT_FLOAT_EQ(filter("<rfilter type=\"tent\"><float name=\"radius\" value=\"1.5\"/></rfilter>").radius, 1.5F);
    EXPECT_NE(first_fault("<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"0\"/>"
                          "</rfilter></film></sensor>")
                  .find("from 1 to 32"),
              std::string::npos);
}

TEST(Samplers, OfEveryName) {
    for (const char* name : {"independent", "stratified", "multijitter", "orthogonal", "ldsampler", "sobol", "halton", "hammersley"}) {
        EXPECT_EQ(with_sensor("perspective", std::string("<sampler type=\"") + name + "\"><integer name=\"sample_count\" value=\"7\"/></sampler>")
                      .sample_count,
                  7);
    }
}

std::vector<std::string> channel_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const PictureChannel& channel : scene.integrator.channels) names.push_back(channel.name);
    return names;
}

using Names = std::vector<std::string>;

// The names of Mitsuba 3.9.1's integrator.aov_names().
TEST(Integrators, LayersAreNamedAsMitsubaDoes) {
    const Scene scene = SceneFolder().elements(R"(<integrator type="aov"><string name="aovs" value="dd.y:depth, nn:sh_normal,i:shape_index"/>
        <integrator type="path" name="image"><integer name="max_depth" value="3"/></integrator></integrator>)");
    EXPECT_EQ(channel_names(scene), (Names{"image.R", "image.G", "image.B", "image.A", "dd.y.T", "nn.X", "nn.Y", "nn.Z", "i.I"}));
    EXPECT_EQ(scene.integrator.max_depth, 3);
    EXPECT_TRUE(scene.integrator.radiance);
    EXPECT_EQ(scene.integrator.channels[6].kind, LayerKind::sh_normal);
    EXPECT_EQ(scene.integrator.channels[6].component, 1);
}

TEST(Integrators, LayersAlone) {
    const Scene scene = SceneFolder().elements(R"(<integrator type="aov"><string name="aovs" value="a:uv"/></integrator>)");
    EXPECT_EQ(channel_names(scene), (Names{"a.U", "a.V"}));
    EXPECT_FALSE(scene.integrator.radiance);
}

TEST(Integrators, Moments) {
    const Scene plain = SceneFolder().elements(R"(<integrator type="moment"><integrator type="direct"/></integrator>)");
    EXPECT_EQ(channel_names(plain), (Names{"_arg_0.X", "_arg_0.Y", "_arg_0.Z", "m2__arg_0.X", "m2__arg_0.Y", "m2__arg_0.Z"}));
    EXPECT_EQ(plain.integrator.max_depth, 2);
    EXPECT_TRUE(plain.integrator.channels[4].squared);
    const Scene both = SceneFolder().elements(R"(<integrator type="moment"><integrator type="aov" name="a"><string name="aovs" value="d:depth"/>
        <integrator type="path" name="p"/></integrator></integrator>)");
    EXPECT_EQ(channel_names(both), (Names{"a.p.R", "a.p.G", "a.p.B", "a.p.A", "a.d.T", "a.X", "a.Y", "a.Z", "m2_a.p.R", "m2_a.p.G", "m2_a.p.B",
                                          "m2_a.p.A", "m2_a.d.T", "m2_a.X", "m2_a.Y", "m2_a.Z"}));
}

TEST(Integrators, FaultsOfLayers) {
    const auto fault = [](const std::string& xml) { return first_fault("<sensor type=\"perspective\"/>" + xml); };
    EXPECT_NE(fault(R"(<integrator type="aov"><string name="aovs" value="d:dept"/></integrator>)").find("did you mean `depth`?"), std::string::npos);
    EXPECT_NE(fault(R"(<integrator type="aov"><string name="aovs" value="depth"/></integrator>)").find("expected name:type"), std::string::npos);
    EXPECT_NE(fault(R"(<integrator type="aov"/>)").find("`aovs` is missing"), std::string::npos);
    EXPECT_NE(fault(R"(<integrator type="moment"/>)").find("holds no integrator"), std::string::npos);
    EXPECT_NE(fault(R"(<integrator type="aov"><string name="aovs" value="d:uv,d:uv"/></integrator>)").find("have the name `d.U`"), std::string::npos);
    EXPECT_NE(fault(R"(<integrator type="moment"><integrator type="moment" name="m"><integrator type="path"/></integrator></integrator>)")
                  .find("moments of moments"),
              std::string::npos);
    EXPECT_NE(fault(R"(<integrator type="aov"><string name="aovs" value="d:uv"/><integrator type="path"/><integrator type="path"/></integrator>)")
                  .find("more than one integrator"),
              std::string::npos);
    EXPECT_NE(fault(R"(<integrator type="ptracing"/>)").find("not supported"), std::string::npos);
}

TEST(Emitters, ProjectorsAndSpotsWithATexture) {
    const Scene scene = SceneFolder().elements(R"(<emitter type="projector"><float name="scale" value="2"/><float name="fov" value="30"/>
        <texture type="checkerboard" name="irradiance"/></emitter>
        <emitter type="spot"><texture type="checkerboard" name="texture"/></emitter>)");
    const auto& projector = std::get<ProjectorEmitter>(scene.emitters.at(0));
    EXPECT_FLOAT_EQ(projector.fov_x_degrees, 30.0F);
    EXPECT_EQ(projector.scale, 2.0F);
    EXPECT_EQ(projector.aspect, 1.0F);
    EXPECT_NE(projector.irradiance.texture, nullptr);
    EXPECT_NE(std::get<SpotEmitter>(scene.emitters.at(1)).texture, nullptr);
    const auto fault = [](const std::string& xml) { return first_fault("<sensor type=\"perspective\"/>" + xml); };
    EXPECT_NE(fault(R"(<emitter type="sunsky"/>)").find("use `constant`"), std::string::npos);
    EXPECT_NE(fault(R"(<emitter type="directionalarea"/>)").find("expected one of `area`"), std::string::npos);
    EXPECT_NE(fault(R"(<emitter type="spot"><float name="texture" value="1"/></emitter>)").find("does not vary"), std::string::npos);
}

TEST(Transforms, BeyondSinglePrecision) {
    const auto fault = [](const std::string& operation) {
        return first_fault("<sensor type=\"orthographic\"><transform name=\"to_world\">" + operation + "</transform></sensor>");
    };
    EXPECT_NE(fault(R"(<scale value="1e39"/>)").find("finite"), std::string::npos);
    EXPECT_NE(fault(R"(<scale value="1e30"/><scale value="1e30"/>)").find("not an invertible"), std::string::npos);
    EXPECT_NE(fault(R"(<scale value="1e-35"/>)").find("not an invertible"), std::string::npos);
    EXPECT_NE(fault(R"(<scale value="0"/>)").find("not an invertible"), std::string::npos);
    EXPECT_NE(fault(R"(<matrix value="1 2 3  2 4 6  0 0 1"/>)").find("not an invertible"), std::string::npos);
    EXPECT_EQ(fault(R"(<scale value="1e-6"/>)"), "");
}

}  // namespace
}  // namespace wavelobe::test
