// Geometry: the built-in shapes, OBJ and PLY files, and what transforms and flips do to them. Reference
// values: Mitsuba 3.9.1.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/scene_files.h"
#include "scene/mesh.h"

namespace wavelobe::test {
namespace {

const TriangleMesh& mesh_of(const Scene& scene, std::size_t i = 0) {
    return std::get<TriangleMesh>(scene.shapes.at(i).geometry);
}

glm::vec3 geometric_normal(const TriangleMesh& mesh, std::size_t triangle) {
    const glm::uvec3& t = mesh.triangles.at(triangle);
    return glm::normalize(
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5F) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

std::string shape(const std::string& type, const std::string& inside) {
    return "<shape type=\"" + type + "\">" + inside + "</shape>";
}

std::string to_world(const std::string& operations) {
    return "<transform name=\"to_world\">" + operations + "</transform>";
}

const std::string flip = R"(<boolean name="flip_normals" value="true"/>)";
const std::string mirror = to_world(R"(<scale x="-1"/>)");

TEST(Meshes, RectangleFacesPlusZ) {
    const Scene scene = SceneFolder().elements(shape("rectangle", ""));
    const TriangleMesh& mesh = mesh_of(scene);
    EXPECT_TRUE(mesh.parallelogram);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}));
    EXPECT_EQ(mesh.uvs, (std::vector<glm::vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
    EXPECT_EQ(geometric_normal(mesh, 0), glm::vec3(0, 0, 1));
}

TEST(Meshes, RectangleKeepsItsSideUnderMirroringAndItsUvUnderFlips) {
    const Scene scene = SceneFolder().elements(shape("rectangle", mirror) + shape("rectangle", flip) +
                                               shape("rectangle", flip + mirror) +
                                               shape("rectangle", to_world(R"(<scale z="-1"/>)")));
    const std::vector<float> sides{1.0F, -1.0F, -1.0F, -1.0F};
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const TriangleMesh& mesh = mesh_of(scene, i);
        const bool mirrored = i == 0 || i == 2;
        EXPECT_TRUE(mesh.parallelogram);
        EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
        for (std::size_t t = 0; t < 2; ++t) expect_near(geometric_normal(mesh, t), glm::vec3(0, 0, sides[i]));
        for (std::size_t v = 0; v < 4; ++v) {
            EXPECT_EQ(mesh.uvs[v].x, (mirrored ? -mesh.positions[v].x : mesh.positions[v].x) / 2.0F + 0.5F);
            EXPECT_EQ(mesh.uvs[v].y, mesh.positions[v].y / 2.0F + 0.5F);
        }
    }
}

TEST(Meshes, CubeShowsItsOutside) {
    const Scene scene = SceneFolder().elements(shape("cube", "") + shape("cube", mirror) + shape("cube", flip));
    for (std::size_t i = 0; i < 3; ++i) {
        const TriangleMesh& mesh = mesh_of(scene, i);
        ASSERT_EQ(mesh.triangles.size(), 12U);
        EXPECT_FALSE(mesh.parallelogram);
        for (std::size_t t = 0; t < 12; ++t) {
            const glm::vec3 centre = mesh.positions[mesh.triangles[t].x] + mesh.positions[mesh.triangles[t].y] +
                                     mesh.positions[mesh.triangles[t].z];
            EXPECT_EQ(glm::dot(centre, geometric_normal(mesh, t)) > 0.0F, i != 2);
        }
    }
    // The face at y = -1.
    const TriangleMesh& cube = mesh_of(scene);
    EXPECT_EQ(cube.positions[0], glm::vec3(1, -1, -1));
    EXPECT_EQ(cube.uvs[0], glm::vec2(0, 1));
    EXPECT_EQ(cube.positions[2], glm::vec3(-1, -1, 1));
    EXPECT_EQ(cube.uvs[2], glm::vec2(1, 0));
}

TEST(Meshes, AnalyticShapes) {
    const Scene scene = SceneFolder().elements(
        shape("sphere", R"(<point name="center" x="1" y="2" z="3"/><float name="radius" value="0.5"/>)") +
        shape(
            "cylinder",
            R"(<point name="p0" x="1" y="0" z="0"/><point name="p1" x="1" y="3" z="0"/><float name="radius" value="0.25"/>)") +
        shape("disk", flip) + shape("sphere", mirror) + shape("cylinder", mirror) + shape("sphere", mirror + flip));
    const auto matrix = [&](std::size_t i) {
        return std::get<AnalyticShape>(scene.shapes.at(i).geometry).to_world;
    };
    EXPECT_EQ(matrix(0) * glm::vec4(1, 0, 0, 1), glm::vec4(1.5F, 2, 3, 1));
    expect_near(glm::vec3(matrix(1) * glm::vec4(0, 0, 1, 1)), {1, 3, 0});
    EXPECT_NEAR(glm::length(glm::vec3(matrix(1)[0])), 0.25F, 1e-6F);
    EXPECT_GT(glm::determinant(glm::mat3(matrix(1))), 0.0F);
    // A mirrored sphere shows its inside, a mirrored cylinder does not.
    const std::vector<bool> flipped{false, false, true, true, false, false};
    for (std::size_t i = 0; i < flipped.size(); ++i) EXPECT_EQ(scene.shapes[i].flip_normals, flipped[i]) << i;
}

const char* const quad_obj = R"(# a quad with a seam, and a triangle from the end
v 0 0 0
v 1 0 0
v 1 1 0.2
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 0.75
g first
usemtl not-there
f 1/1 2/2 3/3 4/4
o second
f -2/1 -1/4 -4/1
)";

std::string obj(const std::string& file, const std::string& more = "") {
    return shape("obj", "<string name=\"filename\" value=\"" + file + "\"/>" + more);
}

TEST(Meshes, ObjQuadsNegativeIndicesAndSeams) {
    const SceneFolder folder;
    folder.write("a.obj", quad_obj);
    const Scene scene =
        folder.elements(obj("a.obj") + obj("a.obj", R"(<boolean name="flip_tex_coords" value="false"/>)") +
                        obj("a.obj", R"(<boolean name="face_normals" value="true"/>)"));
    const TriangleMesh& mesh = mesh_of(scene);
    // 3/3 and 3/1 are two vertices, 1/1 and 4/4 are shared.
    EXPECT_EQ(mesh.positions.size(), 5U);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {4, 3, 0}}));
    EXPECT_EQ(mesh.uvs[3], glm::vec2(0, 0.25F));
    EXPECT_EQ(mesh_of(scene, 1).uvs[3], glm::vec2(0, 0.75F));
    EXPECT_EQ(mesh.normals.size(), 5U);
    EXPECT_TRUE(mesh_of(scene, 2).normals.empty());
}

TEST(Meshes, ComputedNormalsAreWeightedByAngle) {
    const SceneFolder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nv 0.5 1.7 0.6\nf 1 2 3 4\nf 4 3 5\n");
    const Scene scene = folder.elements(obj("a.obj") + obj("a.obj", flip) + obj("a.obj", mirror));
    const std::vector<glm::vec3> expected{{-0.0990147F, -0.0990147F, 0.990147F},
                                          {0.0F, -0.196116F, 0.980581F},
                                          {-0.129252F, -0.309476F, 0.942082F},
                                          {-0.191024F, -0.226394F, 0.955121F},
                                          {-0.160633F, -0.57369F, 0.803166F}};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        expect_near(mesh_of(scene).normals[i], expected[i]);
        expect_near(mesh_of(scene, 1).normals[i], -expected[i]);
        // Without normals in the file a mirrored mesh is seen from its other side.
        expect_near(mesh_of(scene, 2).normals[i], glm::vec3(1, -1, -1) * expected[i]);
    }
    expect_near(geometric_normal(mesh_of(scene, 1), 0), -geometric_normal(mesh_of(scene), 0));
}

TEST(Meshes, NormalsOfTheFileFollowTheInverseTranspose) {
    const SceneFolder folder;
    folder.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nf 1//1 2//1 3//1\n");
    const Scene scene = folder.elements(obj("n.obj", to_world(R"(<scale x="1" y="3" z="4"/>)")) +
                                        obj("n.obj", mirror) + obj("n.obj", flip));
    const float half = std::sqrt(0.5F);
    expect_near(mesh_of(scene).normals[0], {0, half, half});
    // Normals of the file stay on their side under mirroring, and the winding with them.
    expect_near(mesh_of(scene, 1).normals[0], {0, 0.6F, 0.8F});
    expect_near(geometric_normal(mesh_of(scene, 1), 0), {0, 0, 1});
    expect_near(mesh_of(scene, 2).normals[0], {0, -0.6F, -0.8F});
    expect_near(geometric_normal(mesh_of(scene, 2), 0), {0, 0, -1});
}

TEST(Meshes, CornersWithoutANormalGetAComputedOne) {
    const SceneFolder folder;
    folder.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nvn 0 0 0\nf 1//1 2 3//2\n");
    const Scene scene = folder.elements(obj("n.obj"));
    expect_near(mesh_of(scene).normals[0], {0, 0.6F, 0.8F});
    expect_near(mesh_of(scene).normals[1], {0, 0, 1});
    expect_near(mesh_of(scene).normals[2], {0, 0, 1});
}

TEST(Meshes, TrianglesWithoutAreaAreLeftOutWithAWarning) {
    const SceneFolder folder;
    folder.write(
        "a.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 2 0 0\nv 1e39 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 1 2\nf 1 2 6\n");
    folder.write("none.obj", "v 0 0 0\nf 1 1 1\n");
    const Scene scene = folder.elements(obj("a.obj") + obj("none.obj"));
    ASSERT_EQ(scene.shapes.size(), 1U);
    EXPECT_EQ(mesh_of(scene).triangles.size(), 1U);
    ASSERT_EQ(scene.warnings.size(), 3U);
    EXPECT_NE(scene.warnings[0].find("left out 4 triangles"), std::string::npos);
    EXPECT_NE(scene.warnings[2].find("no triangles"), std::string::npos);
}

// The same two polygons in every encoding: a quad and a triangle, with normals, UVs and extra data.
struct PlyWriter {
    bool ascii = true;
    bool big = false;
    std::string out;

    template <typename T>
    void put(T value) {
        if (ascii) {
            out += std::to_string(value) + " ";
            return;
        }
        std::string bytes(sizeof(T), '\0');
        std::memcpy(bytes.data(), &value, sizeof(T));
        if (big != (std::endian::native == std::endian::big)) bytes.assign(bytes.rbegin(), bytes.rend());
        out += bytes;
    }
};

std::string ply_text(bool ascii, bool big) {
    PlyWriter writer{
        ascii, big,
        "ply\nformat " +
            std::string(ascii ? "ascii"
                        : big ? "binary_big_endian"
                              : "binary_little_endian") +
            " 1.0\ncomment by hand\nelement extra 2\nproperty list uchar short data\nproperty double more\n"
            "element vertex 5\nproperty double x\nproperty float32 y\nproperty float z\nproperty uchar red\n"
            "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
            "element face 2\nproperty int flags\nproperty list uint8 uint vertex_index\nend_header\n"};
    for (int i = 0; i < 2; ++i) {
        writer.put<std::uint8_t>(2);
        writer.put<std::int16_t>(-5);
        writer.put<std::int16_t>(7);
        writer.put(0.5);
    }
    const std::vector<glm::vec2> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 2}};
    for (const glm::vec2& corner : corners) {
        writer.put(static_cast<double>(corner.x));
        writer.put(corner.y);
        writer.put(0.0F);
        writer.put<std::uint8_t>(200);
        for (const float n : {0.0F, 0.0F, 2.0F}) writer.put(n);
        writer.put(corner.x);
        writer.put(0.25F);
    }
    for (const std::vector<std::uint32_t>& face :
         {std::vector<std::uint32_t>{0, 1, 2, 3}, std::vector<std::uint32_t>{1, 4, 2}}) {
        writer.put<std::int32_t>(-1);
        writer.put(static_cast<std::uint8_t>(face.size()));
        for (const std::uint32_t index : face) writer.put(index);
    }
    return writer.out;
}

TEST(Meshes, PlyInEveryEncoding) {
    const SceneFolder folder;
    for (const auto& [ascii, big] : {std::pair(true, false), std::pair(false, false), std::pair(false, true)}) {
        const MeshSource mesh = load_ply(folder.write("m.ply", ply_text(ascii, big)), false);
        EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}));
        ASSERT_EQ(mesh.positions.size(), 5U);
        EXPECT_EQ(mesh.positions[4], glm::vec3(2, 2, 0));
        EXPECT_EQ(mesh.normals.at(4), glm::vec3(0, 0, 2));
        EXPECT_EQ(mesh.uvs.at(4), glm::vec2(2, 0.25F));
        EXPECT_EQ(load_ply(folder.path("m.ply"), true).uvs.at(4), glm::vec2(2, 0.75F));
    }
}

TEST(Meshes, DamagedPlyFilesAreRefused) {
    const SceneFolder folder;
    const auto fault = [&](const std::string& content) {
        try {
            load_ply(folder.write("m.ply", content), false);
        } catch (const InputError& error) {
            return error.faults().at(0);
        }
        return Fault{};
    };
    const std::string binary = ply_text(false, false);
    for (std::size_t size = 0; size < binary.size(); ++size)
        EXPECT_NE(fault(binary.substr(0, size)).message, "") << size;
    const std::string ascii = ply_text(true, false);
    // The last character is a blank, the one before a digit.
    for (std::size_t size = 0; size + 2 < ascii.size(); ++size)
        EXPECT_NE(fault(ascii.substr(0, size)).message, "") << size;

    const Fault type = fault("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n");
    EXPECT_EQ(type.line, 4);
    const std::string start = "ply\nformat ascii 1.0\nelement vertex ";
    const std::string vertices = "\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    EXPECT_NE(fault(start + "999999999999" + vertices + faces + "0 0 0\n").message.find("too short"),
              std::string::npos);
    const Fault index = fault(start + "3" + vertices + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n");
    EXPECT_EQ(index.line, 13);
    EXPECT_NE(index.message.find("face 0"), std::string::npos);
    EXPECT_EQ(fault(start + "3" + vertices + faces + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n").line, 11);
    EXPECT_NE(fault("solid cube\n").message.find("not a PLY"), std::string::npos);
    EXPECT_NE(fault(start + "1" + vertices + "element other 99999999999999\nend_header\n0 0 0\n").message,
              "nothing");
}

TEST(Meshes, DamagedObjFilesAreRefusedByLine) {
    const SceneFolder folder;
    try {
        load_obj(folder.write("m.obj", "v 0 0 0\nv 1 zero 0\n\nv 0 1 0\r\nf 1 2 9\nvt 1\nf 1/7 2 3\nf 0 1 2\n"),
                 true);
        FAIL();
    } catch (const InputError& error) {
        std::vector<int> lines;
        for (const Fault& fault : error.faults()) lines.push_back(fault.line);
        EXPECT_EQ(lines, (std::vector<int>{2, 5, 6, 7, 8})) << texts(error.faults());
    }
}

TEST(Meshes, ObjLinesGoOnBehindABackslash) {
    const SceneFolder folder;
    const std::string start = "v 0 0 0\nv 1 0 \\\n0\nv 1 1 0\r\nv 0 1 0\nf 1 2 \\\r\n 3 \\\n 4\n";
    EXPECT_EQ(load_obj(folder.write("m.obj", start), true).triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    try {
        load_obj(folder.write("bad.obj", start + "f 1 2 9"), true);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.faults().at(0).line, 9);
    }
}

TEST(Meshes, PlyListsOfAbsurdLengthAreRefused) {
    const SceneFolder folder;
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n";
    for (const char* count : {"1e300", "-1", "nan", "4000000000"})
        EXPECT_THROW(load_ply(folder.write("m.ply", head + count + " 0 0 0\n"), false), InputError) << count;
}

}  // namespace
}  // namespace wavelobe::test
