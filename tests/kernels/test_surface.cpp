// The surface at a hit: where it is and how well that is known, its frame, its side; and rays that leave it.
#include <gtest/gtest.h>

#include <tuple>

#include "support/stage.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {
namespace {

constexpr std::uint32_t batch = 4096;
constexpr float infinity = std::numeric_limits<float>::infinity();

const char* const surface_kernel = R"(
#define STORE_SURFACE(field, value) store(surfaces + (field) * 4096u + i, value)
#define STORE_VECTOR(field, v) STORE_SURFACE(field, (v).x); STORE_SURFACE(field + 1u, (v).y); STORE_SURFACE(field + 2u, (v).z)

// The surface of each path of the ray queue, and the origin of a ray that leaves it along `leave`.
kernel void load_surfaces(global struct BlockHeader *headers, global float *blocks, SURFACE_PARAMETERS,
                          global const float *leave, global float *surfaces) {
    Block block = block_of(headers, blocks, 0);
    SurfaceView view = SURFACE_VIEW;
    Queue rays = QUEUE(block, RAYS);
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(rays, i);
        Surface s = load_surface(view, &path);
        Vec3 away = vec3(load(leave + i), load(leave + 4096u + i), load(leave + 8192u + i));
        STORE_VECTOR(0u, s.position);
        STORE_VECTOR(3u, s.error);
        STORE_VECTOR(6u, s.normal);
        STORE_VECTOR(9u, s.frame.s);
        STORE_VECTOR(12u, s.frame.t);
        STORE_VECTOR(15u, s.frame.n);
        STORE_VECTOR(18u, s.wi);
        STORE_VECTOR(21u, offset_ray_origin(s.position, s.error, s.normal, away));
        STORE_SURFACE(24u, s.u);
        STORE_SURFACE(25u, s.v);
        STORE_SURFACE(26u, as_Float(s.material));
        STORE_SURFACE(27u, as_Float(s.primitive));
    }
}
)";
constexpr std::size_t surface_fields = 28;

class SurfaceBench {
public:
    explicit SurfaceBench(const Scene& scene, int lanes = 16, bool few = false)
        : bench_(scene, lanes, batch, few, surface_kernel),
          leave_(device(), 3 * batch * sizeof(float)),
          surfaces_(device(), surface_fields * (batch + 16) * sizeof(float)) {}

    // Traces rays; `leave` are the directions in which they will go on.
    void hit(const std::vector<TestPath>& rays, const std::vector<glm::vec3>& leave) {
        trace(rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) leave_.view<float>()[k * batch + i] = leave[i][static_cast<glm::length_t>(k)];
        }
        bench_.run("load_surfaces", {{"leave", &leave_}, {"surfaces", &surfaces_}});
    }

    void trace(const std::vector<TestPath>& rays) {
        bench_.fill(QUEUE_RAYS, rays);
        bench_.run("intersect_closest");
    }

    TestPath path(std::size_t i) { return bench_.path(QUEUE_RAYS, static_cast<std::uint32_t>(i)); }
    float field(std::size_t f, std::size_t i) const { return surfaces_.view<float>()[f * batch + i]; }
    glm::vec3 vector(std::size_t f, std::size_t i) const { return {field(f, i), field(f + 1, i), field(f + 2, i)}; }
    std::uint32_t bits(std::size_t f, std::size_t i) const { return surfaces_.view<std::uint32_t>()[f * batch + i]; }

    glm::vec3 position(std::size_t i) const { return vector(0, i); }
    glm::vec3 error(std::size_t i) const { return vector(3, i); }
    glm::vec3 normal(std::size_t i) const { return vector(6, i); }
    glm::vec3 wi(std::size_t i) const { return vector(18, i); }
    glm::vec3 leaving_origin(std::size_t i) const { return vector(21, i); }
    std::uint32_t material(std::size_t i) const { return bits(26, i); }
    std::uint32_t primitive(std::size_t i) const { return bits(27, i); }
    std::uint32_t slot_of(std::uint32_t triangle) const { return bench_.slot_of(triangle); }
    std::uint32_t back_material() const { return bench_.scene().shapes[0].back_material; }

private:
    StageBench bench_;
    Buffer leave_;
    Buffer surfaces_;
};

TestPath ray(const glm::vec3& origin, const glm::vec3& direction) {
    TestPath p;
    p.origin = origin;
    p.direction = direction;
    p.t = infinity;
    return p;
}

TriangleMesh mesh_of(const Triangles& triangles) {
    TriangleMesh mesh;
    for (const TriangleVertices& t : triangles) {
        const auto first = static_cast<unsigned>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), t.begin(), t.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

// ---- rays that leave a surface -----------------------------------------------------------------------------

struct Placement {
    const char* name;
    float scale;
    glm::vec3 offset;  // in units of the scale
};

void PrintTo(const Placement& placement, std::ostream* out) { *out << placement.name; }

class Leaving : public testing::TestWithParam<std::tuple<Placement, bool>> {};

// From all over random triangles, in all directions and nearly along the surface: positions are known to within their
// bounds, and the triangle is never met again.
TEST_P(Leaving, NeverMeetsTheSameTriangle) {
    const auto& [placement, few] = GetParam();
    const glm::vec3 offset = placement.offset * placement.scale;
    const Triangles triangles = triangle_soup(few ? 40 : 300, 0.4F, placement.scale, offset, 1);
    Scene scene = empty_scene(16);
    add_shape(scene, mesh_of(triangles), add_diffuse(scene, Rgb{0.5F}), "soup");
    SurfaceBench bench(scene, 16, few);
    Generator random(2);
    std::size_t met = 0;
    for (int round = 0; round < 8; ++round) {
        std::vector<TestPath> rays;
        std::vector<glm::vec3> leave;
        while (rays.size() < batch) {
            const TriangleVertices& t = triangles[random() % triangles.size()];
            const float b = uniform(random, 0.0F, 1.0F);
            const float c = uniform(random, 0.0F, 1.0F - b);
            const glm::vec3 target = t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]);
            const glm::vec3 origin = offset + placement.scale * 3.0F * uniform_direction(random);
            rays.push_back(ray(origin, glm::normalize(target - origin)));
            glm::vec3 away = uniform_direction(random);
            if (rays.size() % 2 == 0) {  // to within 1e-6 of tangential
                const glm::vec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
                away = glm::normalize(away - n * glm::dot(n, away) + n * uniform(random, -1e-6F, 1e-6F));
            }
            leave.push_back(away);
        }
        bench.hit(rays, leave);
        std::vector<TestPath> next;
        std::vector<std::uint32_t> from;
        for (std::size_t i = 0; i < batch; ++i) {
            if (bench.path(i).hit == HIT_NONE) continue;
            const std::uint32_t primitive = bench.primitive(i);
            const TriangleVertices& t = triangles[primitive];
            const glm::dvec3 n = glm::normalize(glm::cross(glm::dvec3(t[1]) - glm::dvec3(t[0]), glm::dvec3(t[2]) - glm::dvec3(t[0])));
            const double distance = glm::dot(n, glm::dvec3(bench.position(i)) - glm::dvec3(t[0]));
            ASSERT_LE(std::abs(distance), glm::dot(glm::abs(n), glm::dvec3(bench.error(i))));
            ASSERT_NEAR(std::abs(glm::dot(n, glm::dvec3(bench.normal(i)))), 1.0, 1e-5) << "of a sliver's normal";
            next.push_back(ray(bench.leaving_origin(i), leave[i]));
            from.push_back(primitive);
        }
        ASSERT_GT(next.size(), batch / 2);
        bench.hit(next, std::vector<glm::vec3>(next.size(), glm::vec3(0, 0, 1)));
        for (std::size_t i = 0; i < next.size(); ++i) {
            if (bench.path(i).hit != HIT_NONE && bench.primitive(i) == from[i]) ++met;
        }
    }
    EXPECT_EQ(met, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    All, Leaving,
    testing::Combine(testing::Values(Placement{"unit", 1.0F, {0, 0, 0}}, Placement{"tiny", 1e-6F, {0, 0, 0}},
                                     Placement{"huge", 1e6F, {0, 0, 0}}, Placement{"away", 1.0F, {1000, -300, 500}},
                                     Placement{"tiny_away", 1e-6F, {100, 50, -80}}, Placement{"huge_away", 1e6F, {20, 30, -10}}),
                     testing::Bool()),
    [](const auto& p) { return std::get<0>(p.param).name + std::string(std::get<1>(p.param) ? "_few" : ""); });

// A flat floor at a height that floats hold exactly: origins stay on their side, at any distance from the middle.
// (That position is known far better than the distances of a test against such large triangles.)
class LeavingFloor : public testing::TestWithParam<bool> {};

TEST_P(LeavingFloor, AtAnyScale) {
    for (const float size : {1e-6F, 1.0F, 1e6F}) {
        for (const float height : {0.0F, 0.25F, -3.0F}) {
            Scene scene = empty_scene(16);
            add_quad(scene, {-size, height * size, size}, {2 * size, 0, 0}, {0, 0, -2 * size}, add_diffuse(scene, Rgb{0.5F}));
            SurfaceBench bench(scene, 16, GetParam());
            Generator random(3);
            std::vector<TestPath> rays;
            std::vector<glm::vec3> leave;
            for (std::uint32_t i = 0; i < batch; ++i) {
                const glm::vec3 target{uniform(random, -size, size), height * size, uniform(random, -size, size)};
                rays.push_back(ray({0.1F * size, (height + 1) * size, 0}, glm::normalize(target - glm::vec3{0.1F * size, (height + 1) * size, 0})));
                leave.push_back(uniform_direction(random));
            }
            bench.hit(rays, leave);
            std::vector<TestPath> next;
            for (std::uint32_t i = 0; i < batch; ++i) {
                if (bench.path(i).hit == HIT_NONE) continue;
                const float y = bench.leaving_origin(i).y;
                if (leave[i].y > 0.0F) {
                    ASSERT_GE(y, height * size);
                } else {
                    ASSERT_LE(y, height * size);
                }
                next.push_back(ray(bench.leaving_origin(i), leave[i]));
            }
            ASSERT_GT(next.size(), batch * 9 / 10);
            bench.trace(next);
            for (std::size_t i = 0; i < next.size(); ++i) ASSERT_EQ(bench.path(i).hit, HIT_NONE) << "size " << size << " height " << height;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, LeavingFloor, testing::Bool(), [](const auto& few) { return few.param ? "few" : "hierarchy"; });

// ---- frames, normals, texture coordinates ---------------------------------------------------------------------

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
    for (const glm::vec3& n : {glm::vec3{0, 0.2F, 1}, {0.3F, 0, 1}, {-0.2F, 0.1F, 1}, {0, 0, 1}, {0, -0.3F, 1}, {0, 0, 1}}) {
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
        const glm::vec3 origin = target + glm::vec3{uniform(random, -2.0F, 2.0F), uniform(random, -2.0F, 2.0F), i % 4 < 2 ? 4.0F : -4.0F};
        rays.push_back(ray(origin, glm::normalize(target - origin)));
    }
    bench.hit(rays, std::vector<glm::vec3>(rays.size(), glm::vec3(0, 0, 1)));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(bench.primitive(i), i % 2);
        const glm::uvec3& t = mesh.triangles[i % 2];
        const double b = static_cast<double>(bench.path(i).u);
        const double c = static_cast<double>(bench.path(i).v);
        const auto blend = [&](const auto& values) { return glm::dvec3(glm::dvec3(values[t.x]) * (1 - b - c) + glm::dvec3(values[t.y]) * b + glm::dvec3(values[t.z]) * c); };
        expect_close(bench.position(i), blend(mesh.positions));
        const glm::dvec3 geometric = glm::normalize(glm::cross(glm::dvec3(mesh.positions[t.y]) - glm::dvec3(mesh.positions[t.x]),
                                                               glm::dvec3(mesh.positions[t.z]) - glm::dvec3(mesh.positions[t.x])));
        expect_close(bench.normal(i), geometric);
        // Seen from behind the frame is turned.
        glm::dvec3 shading = glm::normalize(blend(mesh.normals));
        if (glm::dot(shading, glm::dvec3(rays[i].direction)) > 0.0) shading = -shading;
        expect_close(bench.vector(15, i), shading);
        const glm::dvec2 uv = glm::dvec2(mesh.uvs[t.x]) * (1 - b - c) + glm::dvec2(mesh.uvs[t.y]) * b + glm::dvec2(mesh.uvs[t.z]) * c;
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
    bench.hit({ray({0.75F, 0.75F, 4}, {0, 0, -1}), ray({3.5F, 0.5F, 4}, {0, 0, -1})}, {{0, 0, 1}, {0, 0, 1}});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(bench.primitive(i), i);
        for (const std::size_t axis : {std::size_t{9}, std::size_t{12}, std::size_t{15}}) EXPECT_NEAR(glm::length(bench.vector(axis, i)), 1.0, 1e-5);
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
        bench.hit({ray({0.25F, 0.5F, 2}, {0, 0, -1}), ray({0.25F, 0.5F, -2}, {0, 0, 1})}, {{0, 0, 1}, {0, 0, 1}});
        EXPECT_EQ(bench.material(0), 0U);
        EXPECT_EQ(bench.material(1), bench.back_material());
        EXPECT_EQ(bench.back_material() == WAVELOBE_NONE, !c.back);
        for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(bench.normal(i), glm::vec3(0, 0, 1)) << "the geometric normal never turns";
        EXPECT_EQ(bench.wi(0).z, 1.0F);
        EXPECT_EQ(bench.wi(1).z, c.turned ? 1.0F : -1.0F);
        EXPECT_EQ(bench.vector(15, 1), glm::vec3(0, 0, c.turned ? -1 : 1));
    }
}

INSTANTIATE_TEST_SUITE_P(Lanes, SurfaceFrame, testing::Values(1, 8, 16), testing::PrintToStringParamName());

}  // namespace
}  // namespace wavelobe::test
