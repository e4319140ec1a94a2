// Attributes of meshes as textures: their names in PLY files, and what is seen of them.
#include <gtest/gtest.h>

#include "host/scene_files.h"
#include "scene/mesh.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

// A square of [-1, 1]^2 in z = 0; columns behind the positions, and behind the lists of the two faces.
std::string square(const std::string& vertex_header, const std::vector<std::string>& vertices, const std::string& face_header = "",
                   const std::vector<std::string>& faces = {"", ""}) {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + vertex_header +
           "element face 2\nproperty list uchar int vertex_indices\n" + face_header + "end_header\n-1 -1 0 " + vertices.at(0) + "\n1 -1 0 " +
           vertices.at(1) + "\n1 1 0 " + vertices.at(2) + "\n-1 1 0 " + vertices.at(3) + "\n3 0 1 2 " + faces.at(0) + "\n3 0 2 3 " +
           faces.at(1) + "\n";
}

std::string columns(const std::vector<std::string>& names, const std::string& type = "float") {
    std::string all;
    for (const std::string& name : names) all += "property " + type + " " + name + "\n";
    return all;
}

// Red rises along x, green along y, blue is 1 at one corner.
const std::vector<std::string> ramps{"0 0 0", "1 0 0", "1 1 1", "0 1 0"};

TEST(MeshAttributes, NamesAreThoseOfMitsuba) {
    const SceneFolder folder;
    const auto read = [&](const std::string& ply, const std::string& name) {
        return load_ply(folder.write("m.ply", ply), false, {name}).attributes;
    };
    for (const auto& names : {std::vector<std::string>{"r", "g", "b"}, {"red", "green", "blue"}}) {
        const auto found = read(square(columns(names), ramps), "vertex_color");
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].values, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}));
    }
    EXPECT_EQ(read(square(columns({"red", "green", "blue"}, "uchar"), {"0 0 0", "255 0 0", "1 1 1", "0 1 0"}), "vertex_color").at(0).values[1],
              glm::vec3(255, 0, 0));
    EXPECT_EQ(read(square(columns({"a_r", "a_g", "a_b"}), ramps), "vertex_a_color").size(), 1U);
    EXPECT_EQ(read(square(columns({"a_1", "a_2", "a_3"}), ramps), "vertex_a").at(0).channels, 3);
    EXPECT_EQ(read(square(columns({"b_x", "a_0", "c_x"}), ramps), "vertex_a").at(0).channels, 1);
    for (const auto& names : {std::vector<std::string>{"a_x", "a_y", "b"}, {"a", "b", "c"}, {"a_r", "a_g", "a_b"}})
        EXPECT_TRUE(read(square(columns(names), ramps), "vertex_a").empty());
    const auto faces = read(square("", {"", "", "", ""}, columns({"v_x", "v_y", "v_z"}), {"1 2 3", "4 5 6"}), "face_v");
    EXPECT_EQ(faces.at(0).values, (std::vector<glm::vec3>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_TRUE(read(square("", {"", "", "", ""}), "face_v").empty());
}

std::string attribute(const std::string& parameter, const std::string& name, double scale = 1.0) {
    return "<texture type=\"mesh_attribute\" name=\"" + parameter + "\"><string name=\"name\" value=\"" + name +
           "\"/><float name=\"scale\" value=\"" + std::to_string(scale) + "\"/></texture>";
}

// The square fills the picture, seen along -z; its left is the picture's.
std::string seen(const std::string& elements) {
    return R"(<scene version="3.0.0"><sensor type="orthographic"><transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/>
        </transform><film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/><rfilter type="box"/></film></sensor>)" +
           elements + "</scene>";
}

std::string plate(const std::string& shown, const std::string& moved = "") {
    return "<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/>" + moved + shown + "</shape>";
}

// Mean over a pixel, 1/8 wide. Blue is 1 at the corner (1, 1), 0 at the others, linear over each triangle.
glm::dvec3 ramp_at(double x, double y) {
    const double lower = std::min(x, y) - (x == y ? 1.0 / 8 / 6 : 0.0);
    return {0.5 * (x + 1.0), 0.5 * (y + 1.0), 0.5 * (lower + 1.0)};
}

void expect_ramps(const Image& image, double scale, double tolerance) {
    for (int row = 0; row < 16; ++row)
        for (int column = 0; column < 16; ++column) {
            const glm::dvec3 expected = scale * ramp_at((column + 0.5) / 8.0 - 1.0, 1.0 - (row + 0.5) / 8.0);
            const glm::dvec3 found = pixel(image, static_cast<std::size_t>(16 * row + column));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << column << ", " << row << ", " << c;
        }
}

TEST(MeshAttributes, EmissionIsInterpolated) {
    const SceneFolder folder;
    folder.write("m.ply", square(columns({"r", "g", "b"}), ramps));
    const Scene scene = folder.read(seen(plate("<emitter type=\"area\">" + attribute("radiance", "vertex_color", 3.0) + "</emitter>")));
    expect_ramps(render(scene, 256).image, 3.0, 0.02);
}

// Two meshes of one BSDF under an even sky, one of them out of sight and before the other in the texture.
TEST(MeshAttributes, ReflectanceOfEachMesh) {
    const SceneFolder folder;
    folder.write("m.ply", square(columns({"r", "g", "b"}), ramps));
    const std::string away = "<transform name=\"to_world\"><translate z=\"9\"/></transform>";
    const Scene scene = folder.read(seen("<emitter type=\"constant\"/><integrator type=\"direct\"/><bsdf type=\"twosided\" id=\"b\"><bsdf type=\"diffuse\">" +
                                         attribute("reflectance", "vertex_color") + "</bsdf></bsdf>" + plate("<ref id=\"b\"/>", away) +
                                         plate("<ref id=\"b\"/>")));
    EXPECT_EQ(scene.materials.size(), 1U);
    expect_ramps(render(scene, 1024).image, 1.0, 0.02);
}

TEST(MeshAttributes, FacesAndOpacity) {
    const SceneFolder folder;
    folder.write("m.ply", square("", {"", "", "", ""}, columns({"a_x"}), {"0.25", "0.75"}));
    const std::string sky = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"2, 2, 2\"/></emitter>";
    const std::string black = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>";
    const Scene scene =
        folder.read(seen(sky + plate("<bsdf type=\"mask\">" + attribute("opacity", "face_a") + black + "</bsdf>")));
    const Image image = render(scene, 256).image;
    EXPECT_NEAR(pixel(image, 16 * 15 + 15).r, 2.0 * 0.75, 0.25);
    EXPECT_NEAR(pixel(image, 0).r, 2.0 * 0.25, 0.25);
    // A blend with nothing is there where its weight is not.
    const Scene blend =
        folder.read(seen(sky + plate("<bsdf type=\"blendbsdf\">" + attribute("weight", "face_a") + black + "<bsdf type=\"null\"/></bsdf>")));
    EXPECT_NEAR(pixel(render(blend, 256).image, 0).r, 2.0 * 0.75, 0.25);
}

TEST(MeshAttributes, Faults) {
    const SceneFolder folder;
    folder.write("m.ply", square(columns({"r", "g", "b"}), ramps));
    const auto faults = [&](const std::string& shape) { return texts(folder.element_faults(shape)); };
    const auto diffuse = [](const std::string& name) { return "<bsdf type=\"diffuse\">" + attribute("reflectance", name) + "</bsdf>"; };
    EXPECT_NE(faults(plate(diffuse("vertex_heat"))).find("the mesh has no attribute `vertex_heat`"), std::string::npos);
    EXPECT_NE(faults(plate(diffuse("color"))).find("expected that of an attribute"), std::string::npos);
    EXPECT_NE(faults("<shape type=\"sphere\">" + diffuse("vertex_color") + "</shape>").find("the shape has no attribute"), std::string::npos);
    EXPECT_NE(faults(plate("<bsdf type=\"mask\">" + attribute("opacity", "vertex_color") + "<bsdf type=\"diffuse\"/></bsdf>")).find("one number"),
              std::string::npos);
    EXPECT_NE(faults(plate("<bsdf type=\"bumpmap\">" + attribute("bump", "vertex_color") + "<bsdf type=\"diffuse\"/></bsdf>")).find("no slope"),
              std::string::npos);
    EXPECT_NE(faults("<emitter type=\"projector\">" + attribute("irradiance", "vertex_color") + "</emitter>").find("attributes are of meshes"),
              std::string::npos);
}

}  // namespace
}  // namespace wavelobe::test
