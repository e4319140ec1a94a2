// glTF: accessors, primitives, nodes, cameras.
#include <gtest/gtest.h>

#include "support/gltf_files.h"

namespace wavelobe::test {
namespace {

glm::vec3 normal_of(const TriangleMesh& mesh, std::size_t triangle = 0) {
    const glm::uvec3 t = mesh.triangles.at(triangle);
    return glm::normalize(glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

void expect_near(const glm::vec3& found, const glm::vec3& expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-5F) << "component " << i;
}

TEST(GltfGeometry, NonIndexedTriangleIsFlat) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    const Scene scene = file.read();
    const TriangleMesh& mesh = mesh_of(scene);
    ASSERT_EQ(mesh.triangles.size(), 1U);
    EXPECT_TRUE(mesh.normals.empty());
    expect_near(normal_of(mesh), {0, 0, 1});
    EXPECT_EQ(scene.film.width, 1280);
    EXPECT_EQ(scene.film.height, 720);
}

TEST(GltfGeometry, BinaryFilesHoldTheSame) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    const Scene scene = read_gltf_scene(file.folder.write("scene.glb", file.binary()));
    EXPECT_EQ(mesh_of(scene).positions, mesh_of(file.read()).positions);
}

TEST(GltfGeometry, ExternalBuffersMayBeLongerThanStated) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    file.folder.write("my data.bin", file.buffer + "more");
    file.json["buffers"] = Json::array({{{"byteLength", file.buffer.size()}, {"uri", "my%20data.bin"}}});
    EXPECT_EQ(mesh_of(file.read()).positions[1], glm::vec3(1, 0, 0));
}

TEST(GltfGeometry, NegativeScaleTurnsTheWindingOver) {
    for (const bool with_normals : {false, true}) {
        GltfFile file;
        Json& primitive = file.add_mesh(unit_triangle());
        if (with_normals) primitive["attributes"]["NORMAL"] = file.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
        file.json["nodes"][0]["scale"] = {-1, 1, 1};
        const Scene scene = file.read();
        // Mirrored along x, the front still faces +z.
        expect_near(normal_of(mesh_of(scene)), {0, 0, 1});
    }
}

TEST(GltfGeometry, NodesNest) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    file.json["nodes"] = Json::array({{{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, 0.70710678, 0.70710678}}},
                                      {{"mesh", 0}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 3, 0, 1}}}});
    // (1, 0, 0) is scaled to (2, 3, 0), turned by 90 degrees to (-3, 2, 0), moved to (7, 2, 0).
    expect_near(mesh_of(file.read()).positions[1], {7, 2, 0});
}

TEST(GltfGeometry, StripsAndFansKeepTheirWinding) {
    for (const int mode : {5, 6}) {
        GltfFile file;
        const std::vector<float> strip{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
        const std::vector<float> fan{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
        file.add_mesh(mode == 5 ? strip : fan)["mode"] = mode;
        const Scene scene = file.read();
        ASSERT_EQ(mesh_of(scene).triangles.size(), 2U);
        for (const std::size_t t : {0U, 1U}) expect_near(normal_of(mesh_of(scene), t), {0, 0, 1});
    }
}

TEST(GltfGeometry, PointsAndLinesAreNamedAndPassedOver) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    Json lines = file.json["meshes"][0]["primitives"][0];
    lines["mode"] = 3;
    file.json["meshes"][0]["primitives"].push_back(lines);
    const Scene scene = file.read();
    EXPECT_EQ(scene.shapes.size(), 1U);
    ASSERT_FALSE(scene.warnings.empty());
    EXPECT_NE(scene.warnings[0].find("/meshes/0/primitives/1: lines are passed over"), std::string::npos);
}

TEST(GltfGeometry, InterleavedStridedAndNormalized) {
    GltfFile file;
    // Position as floats, then a texture coordinate as two normalized bytes and two bytes of padding: 16 bytes a vertex.
    std::string bytes;
    for (int i = 0; i < 3; ++i) {
        bytes += bytes_of(std::vector<float>(unit_triangle().begin() + 3 * i, unit_triangle().begin() + 3 * i + 3));
        bytes += std::string{static_cast<char>(i == 1 ? 255 : 0), static_cast<char>(i == 2 ? 51 : 0), 0, 0};
    }
    const int view = file.add_view(bytes);
    file.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 16;
    file.json["accessors"] = Json::array(
        {{{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"min", {0, 0, 0}}, {"max", {1, 1, 0}}},
         {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5121}, {"normalized", true}, {"count", 3}, {"type", "VEC2"}}});
    file.json["meshes"] = Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}}})}}});
    const Scene scene = file.read();
    EXPECT_EQ(mesh_of(scene).positions[2], glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh_of(scene).uvs[1], glm::vec2(1, 0));
    EXPECT_FLOAT_EQ(mesh_of(scene).uvs[2].y, 0.2F);
}

TEST(GltfGeometry, QuantizedPositionsAndShortIndices) {
    GltfFile file;
    const int positions = file.add(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, -32768, 16384, 0, 0}, "VEC3", 5122, 4);
    Json& accessor = file.json["accessors"][static_cast<std::size_t>(positions)];
    accessor["normalized"] = true;
    accessor["min"] = {-32768, 0, 0}, accessor["max"] = {32767, 16384, 0};
    file.json["bufferViews"][0]["byteStride"] = 8;
    const int order = file.add(std::vector<std::uint8_t>{2, 0, 1}, "SCALAR", 5121, 1);
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.json["meshes"] =
        Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", order}}})}}});
    const TriangleMesh mesh = mesh_of(file.read());
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.positions[2].x, -1.0F);  // the most negative number is held to -1
    EXPECT_EQ(mesh.triangles[0], glm::uvec3(2, 0, 1));
}

TEST(GltfGeometry, SparseAccessorsReplaceElements) {
    for (const bool from_zeros : {false, true}) {
        GltfFile file;
        file.add_mesh(unit_triangle());
        const int indices = file.add_view(bytes_of(std::vector<std::uint16_t>{0, 2}));
        const int values = file.add_view(bytes_of(std::vector<float>{5, 0, 0, 0, 7, 0}));
        Json& accessor = file.json["accessors"][0];
        accessor["max"] = {5, 7, 0};
        if (from_zeros) accessor.erase("bufferView");
        accessor["sparse"] = {{"count", 2},
                              {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                              {"values", {{"bufferView", values}}}};
        const TriangleMesh mesh = mesh_of(file.read());
        EXPECT_EQ(mesh.positions[0], glm::vec3(5, 0, 0));
        EXPECT_EQ(mesh.positions[1], from_zeros ? glm::vec3(0) : glm::vec3(1, 0, 0));
        EXPECT_EQ(mesh.positions[2], glm::vec3(0, 7, 0));
    }
}

TEST(GltfGeometry, CamerasLookAlongMinusZ) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    file.json["cameras"] =
        Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}, {"aspectRatio", 1.5}}}}});
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {1, 2, 3}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = file.read();
    expect_near(glm::vec3(scene.camera.to_world[2]), {0, 0, -1});
    expect_near(glm::vec3(scene.camera.to_world[0]), {-1, 0, 0});
    expect_near(glm::vec3(scene.camera.to_world[3]), {1, 2, 3});
    EXPECT_EQ(scene.film.width, 1080);
    EXPECT_EQ(scene.film.height, 720);
    EXPECT_NEAR(std::tan(glm::radians(scene.camera.fov_x_degrees) / 2), 1.5 * std::tan(0.5), 1e-5);
    const Scene wide = file.read({.width = 100, .height = 50});
    EXPECT_EQ(wide.film.width, 100);
    EXPECT_NEAR(std::tan(glm::radians(wide.camera.fov_x_degrees) / 2), 2.0 * std::tan(0.5), 1e-5);
}

TEST(GltfGeometry, OrthographicCameras) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    file.json["cameras"] =
        Json::array({{{"type", "orthographic"}, {"orthographic", {{"xmag", 3.0}, {"ymag", 2.0}, {"znear", 0.0}, {"zfar", 9.0}}}}});
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = file.read();
    EXPECT_EQ(scene.camera.projection, Camera::Projection::orthographic);
    EXPECT_EQ(scene.film.width, 1080);
    EXPECT_EQ(scene.film.height, 720);
    expect_near(glm::vec3(scene.camera.to_world[0]), {-3, 0, 0});
    expect_near(glm::vec3(scene.camera.to_world[1]), {0, 3, 0});
    expect_near(glm::vec3(scene.camera.to_world[2]), {0, 0, -1});
    expect_near(glm::vec3(scene.camera.to_world[3]), {1, 2, 3});
    EXPECT_EQ(scene.camera.near_clip, 0.0F);
    EXPECT_EQ(scene.camera.far_clip, 9.0F);
    expect_near(glm::vec3(file.read({.width = 100, .height = 50}).camera.to_world[0]), {-4, 0, 0});
}

TEST(GltfGeometry, AnimationsMoveNodes) {
    struct Case {
        const char* interpolation;
        std::vector<float> values;
        float expected;
    };
    // At a quarter of the way from x = 0 to x = 4; the spline with tangents of zero is 3 t^2 - 2 t^3.
    for (const Case& c : {Case{"LINEAR", {0, 0, 0, 4, 0, 0}, 1.0F}, Case{"STEP", {0, 0, 0, 4, 0, 0}, 0.0F},
                          Case{"CUBICSPLINE", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0}, 0.625F}}) {
        GltfFile file;
        file.add_mesh(unit_triangle());
        const int times = file.add_bounded({1, 3}, "SCALAR", 1);
        const int values = file.add_floats(c.values, "VEC3", 3);
        file.json["animations"] = Json::array(
            {{{"samplers", Json::array({{{"input", times}, {"output", values}, {"interpolation", c.interpolation}}})},
              {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})}}});
        EXPECT_EQ(mesh_of(file.read()).positions[0].x, 0.0F);
        EXPECT_NEAR(mesh_of(file.read({.frame_time = 1.5})).positions[0].x, c.expected, 1e-6F) << c.interpolation;
        EXPECT_NEAR(mesh_of(file.read({.frame_time = 9.0})).positions[0].x, 4.0F, 1e-6F) << c.interpolation;
    }
}

TEST(GltfGeometry, MorphTargetsAddUp) {
    GltfFile file;
    Json& primitive = file.add_mesh(unit_triangle());
    const int delta = file.add_bounded({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3", 3);
    primitive["targets"] = Json::array({{{"POSITION", delta}}});
    file.json["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(mesh_of(file.read()).positions[2], glm::vec3(0, 1, 1.5F));
    file.json["nodes"][0]["weights"] = {2.0};
    EXPECT_EQ(mesh_of(file.read()).positions[1], glm::vec3(1, 0, 4));
}

TEST(GltfGeometry, SkinsFollowTheirJoints) {
    GltfFile file;
    Json& primitive = file.add_mesh(unit_triangle());
    primitive["attributes"]["JOINTS_0"] = file.add(std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", 5121, 4);
    primitive["attributes"]["WEIGHTS_0"] = file.add_floats({1, 0, 0, 0, 0.5F, 0.5F, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    const int matrices = file.add_floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, "MAT4", 16);
    file.json["skins"] = Json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}});
    file.json["nodes"] = Json::array({{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                                      {{"translation", {2, 0, 0}}, {"children", {2}}},
                                      {{"translation", {0, 6, 0}}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    const TriangleMesh mesh = mesh_of(file.read());
    // Joint 0 moves by (2, 0, 0), joint 1 by (2, 5, 0); the node of the mesh by nothing.
    expect_near(mesh.positions[0], {2, 0, 0});
    expect_near(mesh.positions[1], {3, 2.5F, 0});
    expect_near(mesh.positions[2], {2, 6, 0});
    file.json["skins"][0]["joints"] = {1};
    EXPECT_TRUE(has_text(file.faults(), "/meshes/0/primitives/0/attributes: JOINTS_0: vertex 1 follows joint 1; the skin has 1"));
}

TEST(GltfGeometry, GpuInstancesAreCopies) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    const int places = file.add_floats({1, 0, 0, 0, 5, 0}, "VEC3", 3);
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    const Scene scene = file.read();
    ASSERT_EQ(scene.shapes.size(), 2U);
    EXPECT_EQ(mesh_of(scene, 1).positions[0], glm::vec3(0, 5, 0));
}

TEST(GltfGeometry, TheDefaultSceneIsShown) {
    GltfFile file;
    file.add_mesh(unit_triangle());
    file.json["nodes"] = Json::array({{{"mesh", 0}, {"name", "first"}}, {{"mesh", 0}, {"name", "second"}}});
    file.json["scenes"] = Json::array({{{"nodes", {0}}}, {{"nodes", {1}}}});
    file.json["scene"] = 1;
    const Scene scene = file.read();
    ASSERT_EQ(scene.shapes.size(), 1U);
    EXPECT_EQ(scene.shapes[0].name, "second");
    EXPECT_EQ(scene.notes.size(), 1U);  // an environment of ours
    EXPECT_EQ(scene.emitters.size(), 1U);
}

}  // namespace
}  // namespace wavelobe::test
