// The surface at a hit: its frame, normals and texture coordinates, and which side of it is seen.
#include <gtest/gtest.h>

#include "support/surface_bench.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {
namespace {

class SurfaceFrame : public testing::TestWithParam<int> {};

// Two triangles with their own normals and texture coordinates, and an anisotropic material that needs the tangent.
Scene shaded_scene() {
    Scene scene = empty_scene(16);
    const auto board = std::make_shared<Texture>();
    board->source = Checkerboard{};
    RoughConductor metal;
    metal.specular_reflectance = {Rgb{1}, board};
    metal.alpha_v = constant(0.3F);
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0.5F}, {0.5F, 3, 0}, {3, 0, 1}, {5, 0, 1}, {3, 2, 2}};
    for (const glm::vec3& n :
         {glm::vec3{0, 0.2F, 1}, {0.3F, 0, 1}, {-0.2F, 0.1F, 1}, {0, 0, 1}, {0, -0.3F, 1}, {0, 0, 1}}) {
        mesh.normals.push_back(glm::normalize(n));
    }
    mesh.uvs = {{0.1F, 0.2F}, {0.9F, 0.3F}, {0.2F, 0.8F}, {0, 0}, {0, 2}, {-1, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    add_shape(scene, mesh, add_material(scene, metal), "mesh").material.back = 0;
    return scene;
}

TEST_P(SurfaceFrame, IsInterpolatedAndOrthonormal) {
    const Scene scene = shaded_scene();
    const auto& mesh = std::get<TriangleMesh>(scene.shapes[0].geometry);
    SurfaceBench bench(scene, GetParam());
    Generator random(4);
    std::vector<TestPath> rays;
    for (int i = 0; i < 301; ++i) {
        const glm::uvec3& t = mesh.triangles[static_cast<std::size_t>(i % 2)];
        const float b = uniform(random, 0.0F, 0.9F);
        const float c = uniform(random, 0.0F, 0.9F - b);
        const glm::vec3 target = mesh.positions[t.x] * (1 - b - c) + mesh.positions[t.y] * b + mesh.positions[t.z] * c;
        const glm::vec3 origin =
            target + glm::vec3{uniform(random, -2.0F, 2.0F), uniform(random, -2.0F, 2.0F), i % 4 < 2 ? 4.0F : -4.0F};
        rays.push_back(untraced(origin, glm::normalize(target - origin)));
    }
    bench.hit(rays, std::vector<glm::vec3>(rays.size(), glm::vec3(0, 0, 1)));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(bench.primitive(i), i % 2);
        const glm::uvec3& t = mesh.triangles[i % 2];
        const double b = static_cast<double>(bench.path(i).u);
        const double c = static_cast<double>(bench.path(i).v);
        const auto blend = [&](const auto& values) {
            return glm::dvec3(glm::dvec3(values[t.x]) * (1 - b - c) + glm::dvec3(values[t.y]) * b +
                              glm::dvec3(values[t.z]) * c);
        };
        expect_close(bench.position(i), blend(mesh.positions));
        const glm::dvec3 geometric =
            glm::normalize(glm::cross(glm::dvec3(mesh.positions[t.y]) - glm::dvec3(mesh.positions[t.x]),
                                      glm::dvec3(mesh.positions[t.z]) - glm::dvec3(mesh.positions[t.x])));
        expect_close(bench.normal(i), geometric);
        // Seen from behind the frame is turned.
        glm::dvec3 shading = glm::normalize(blend(mesh.normals));
        if (glm::dot(shading, glm::dvec3(rays[i].direction)) > 0.0) shading = -shading;
        expect_close(bench.vector(15, i), shading);
        const glm::dvec2 uv =
            glm::dvec2(mesh.uvs[t.x]) * (1 - b - c) + glm::dvec2(mesh.uvs[t.y]) * b + glm::dvec2(mesh.uvs[t.z]) * c;
        EXPECT_NEAR(bench.field(24, i), uv.x, 2.0 * stage_rounding);
        EXPECT_NEAR(bench.field(25, i), uv.y, 2.0 * stage_rounding);
        // Unit, perpendicular, and the way to the camera in it.
        const glm::dvec3 s{bench.vector(9, i)};
        const glm::dvec3 f{bench.vector(12, i)};
        const glm::dvec3 n{bench.vector(15, i)};
        EXPECT_NEAR(glm::dot(s, s), 1.0, stage_rounding);
        EXPECT_NEAR(glm::dot(f, f), 1.0, stage_rounding);
        EXPECT_NEAR(glm::dot(s, f), 0.0, stage_rounding);
        EXPECT_NEAR(glm::dot(s, n), 0.0, stage_rounding);
        EXPECT_NEAR(glm::dot(f, n), 0.0, stage_rounding);
        const glm::dvec3 wi{bench.wi(i)};
        EXPECT_GT(wi.z, 0.0);
        expect_close(glm::vec3(wi.x * s + wi.y * f + wi.z * n), -glm::dvec3(rays[i].direction));
        // The tangent lies along the change of position with u, as far as the normal allows.
        const glm::dvec2 d1 = glm::dvec2(mesh.uvs[t.y]) - glm::dvec2(mesh.uvs[t.x]);
        const glm::dvec2 d2 = glm::dvec2(mesh.uvs[t.z]) - glm::dvec2(mesh.uvs[t.x]);
        const glm::dvec3 e1 = glm::dvec3(mesh.positions[t.y]) - glm::dvec3(mesh.positions[t.x]);
        const glm::dvec3 e2 = glm::dvec3(mesh.positions[t.z]) - glm::dvec3(mesh.positions[t.x]);
        glm::dvec3 along = (e1 * d2.y - e2 * d1.y) / (d1.x * d2.y - d1.y * d2.x);
        along = glm::normalize(along - n * glm::dot(n, along));
        expect_close(glm::vec3(s), along, 2.0 * stage_rounding);
    }
}

// A point-like uv triangle has no tangent, a zero normal no direction: the frame is sound all the same.
TEST_P(SurfaceFrame, DegenerateDataFallsBack) {
    Scene scene = shaded_scene();
    auto& mesh = std::get<TriangleMesh>(scene.shapes[0].geometry);
    for (glm::vec2& uv : mesh.uvs) uv = {0.25F, 0.5F};
    for (std::size_t i = 0; i < 3; ++i) mesh.normals[i] = glm::vec3(0);
    SurfaceBench bench(scene, GetParam());
    bench.hit({untraced({0.75F, 0.75F, 4}, {0, 0, -1}), untraced({3.5F, 0.5F, 4}, {0, 0, -1})}, {{0, 0, 1}, {0, 0, 1}});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(bench.primitive(i), i);
        for (const std::size_t axis : {std::size_t{9}, std::size_t{12}, std::size_t{15}})
            EXPECT_NEAR(glm::length(bench.vector(axis, i)), 1.0, 1e-5);
        EXPECT_EQ(bench.field(24, i), 0.25F);
    }
    EXPECT_EQ(bench.vector(15, 0), bench.normal(0)) << "the geometric normal stands in";
}

// ---- sides ---------------------------------------------------------------------------------------------------

TEST_P(SurfaceFrame, ShowsTheMaterialOfItsSide) {
    struct Case {
        MaterialModel front;
        bool back;
        bool turned;
    };
    const Case cases[] = {{Diffuse{}, false, true}, {Diffuse{}, true, true}, {Dielectric{}, true, false}};
    for (const Case& c : cases) {
        Scene scene = empty_scene(16);
        const int front = add_material(scene, c.front);
        const bool transmissive = std::holds_alternative<Dielectric>(c.front);
        const int back = transmissive ? front : add_diffuse(scene, Rgb{0.1F});
        Shape& quad = add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, front);
        if (c.back) quad.material.back = back;
        SurfaceBench bench(scene, GetParam());
        bench.hit({untraced({0.25F, 0.5F, 2}, {0, 0, -1}), untraced({0.25F, 0.5F, -2}, {0, 0, 1})},
                  {{0, 0, 1}, {0, 0, 1}});
        EXPECT_EQ(bench.material(0), 0U);
        EXPECT_EQ(bench.material(1), bench.back_material());
        EXPECT_EQ(bench.back_material() == WAVELOBE_NONE, !c.back);
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_EQ(bench.normal(i), glm::vec3(0, 0, 1)) << "the geometric normal never turns";
        EXPECT_EQ(bench.wi(0).z, 1.0F);
        EXPECT_EQ(bench.wi(1).z, c.turned ? 1.0F : -1.0F);
        EXPECT_EQ(bench.vector(15, 1), glm::vec3(0, 0, c.turned ? -1 : 1));
    }
}

INSTANTIATE_TEST_SUITE_P(Lanes, SurfaceFrame, testing::Values(1, 8, 16), testing::PrintToStringParamName());

}  // namespace
}  // namespace wavelobe::test
