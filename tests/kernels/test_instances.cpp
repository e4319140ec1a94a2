// Rays and surfaces in instances: what is hit and where, at any scale; rays that leave never come back to what they left.
#include <gtest/gtest.h>

#include "support/instances.h"
#include "support/ray_sets.h"
#include "support/surface_bench.h"

namespace wavelobe::test {
namespace {

double size_of(const InstancePlacement& placement) {
    const glm::vec3 s = glm::abs(placement.scale);
    return static_cast<double>(std::max({s.x, s.y, s.z}));
}

class Instances : public testing::TestWithParam<InstancePlacement> {
protected:
    glm::mat4 map() const { return map_of(GetParam()); }
    // Another instance beyond reach, so that the numbers of instances matter.
    void place(Scene& scene) const {
        add_instance(scene, glm::translate(glm::mat4(1.0F), glm::vec3(1e9F)));
        add_instance(scene, map());
    }
};

// Rays from outside to the inner parts of the triangles of a convex mesh hit these, where double precision says.
TEST_P(Instances, HitWhatTheyAreAimedAt) {
    const ClosedMesh ball = sphere_mesh(3, 1.0F, {0.2F, -0.1F, 0.3F});
    const Triangles triangles = ball.triangles();
    Scene scene = empty_scene(16);
    add_group(scene, mesh_of(triangles), add_diffuse(scene, Rgb{0.5F}));
    place(scene);
    SurfaceBench bench(scene);
    Generator random(5);
    std::vector<TestPath> rays;
    std::vector<std::uint32_t> aimed;
    std::vector<double> distance;
    std::vector<double> slope;
    while (rays.size() < surface_batch) {
        const auto index = static_cast<std::uint32_t>(random() % triangles.size());
        const TriangleVertices& t = triangles[index];
        const float b = uniform(random, 0.1F, 0.4F);
        const float c = uniform(random, 0.1F, 0.4F);
        const glm::vec3 target = t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]);
        // On the triangle's side, within 60 degrees of its normal.
        const glm::vec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
        const glm::vec3 from = target + uniform(random, 0.5F, 3.0F) * (n + 1.7F * uniform(random, 0.0F, 1.0F) * uniform_direction(random));
        if (glm::dot(from - target, n) < 0.5F * glm::length(from - target)) continue;
        const glm::vec3 origin(placed(map(), from));
        const glm::dvec3 way = placed(map(), target) - glm::dvec3(origin);
        rays.push_back(untraced(origin, glm::vec3(glm::normalize(way))));
        aimed.push_back(index);
        // Of the ray as floats have it; how much a step aside changes it.
        const glm::dvec3 a = placed(map(), t[0]);
        const glm::dvec3 normal = glm::normalize(glm::cross(placed(map(), t[1]) - a, placed(map(), t[2]) - a));
        const double cosine = glm::dot(normal, glm::dvec3(rays.back().direction));
        distance.push_back(glm::dot(normal, a - glm::dvec3(origin)) / cosine);
        slope.push_back(1.0 / std::abs(cosine));
    }
    bench.hit(rays, std::vector<glm::vec3>(rays.size(), glm::vec3(0, 0, 1)));
    // Roundings of the ray's way to the group move it aside.
    const double aside = 2e-6 * (glm::length(glm::dvec3(GetParam().offset)) * 0.1 + 4.0 * size_of(GetParam()));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_NE(bench.path(i).hit, HIT_NONE) << "ray " << i;
        ASSERT_EQ(bench.primitive(i), aimed[i]) << "ray " << i;
        ASSERT_EQ(bench.path(i).instance, 1U);
        ASSERT_NEAR(static_cast<double>(bench.path(i).t), distance[i], aside * slope[i]);
        // The normal of the ball's outside, mirrored or not.
        ASSERT_GT(bench.wi(i).z, 0.0F);
        ASSERT_LT(glm::dot(bench.normal(i), rays[i].direction), 0.0F);
    }
}

// From all over random triangles, in all directions and nearly along the surface.
TEST_P(Instances, LeavingRaysNeverMeetTheSameTriangle) {
    const Triangles triangles = triangle_soup(300, 0.4F, 1.0F, glm::vec3(0.0F), 1);
    Scene scene = empty_scene(16);
    add_group(scene, mesh_of(triangles), add_diffuse(scene, Rgb{0.5F}));
    place(scene);
    SurfaceBench bench(scene);
    Generator random(2);
    std::size_t met = 0;
    std::size_t left = 0;
    for (int round = 0; round < 8; ++round) {
        std::vector<TestPath> rays;
        std::vector<glm::vec3> leave;
        while (rays.size() < surface_batch) {
            const TriangleVertices& t = triangles[random() % triangles.size()];
            const float b = uniform(random, 0.0F, 1.0F);
            const float c = uniform(random, 0.0F, 1.0F - b);
            const glm::dvec3 target = placed(map(), t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]));
            const glm::vec3 origin(placed(map(), 3.0F * uniform_direction(random)));
            rays.push_back(untraced(origin, glm::vec3(glm::normalize(target - glm::dvec3(origin)))));
            glm::dvec3 away = uniform_direction(random);
            if (rays.size() % 2 == 0) {  // to within 1e-6 of tangential
                const glm::dvec3 a = placed(map(), t[0]);
                const glm::dvec3 n = glm::normalize(glm::cross(placed(map(), t[1]) - a, placed(map(), t[2]) - a));
                away = glm::normalize(away - n * glm::dot(n, away) + n * static_cast<double>(uniform(random, -1e-6F, 1e-6F)));
            }
            leave.emplace_back(away);
        }
        bench.hit(rays, leave);
        std::vector<TestPath> next;
        std::vector<std::uint32_t> from;
        for (std::size_t i = 0; i < surface_batch; ++i) {
            if (bench.path(i).hit == HIT_NONE) continue;
            const std::uint32_t primitive = bench.primitive(i);
            const TriangleVertices& t = triangles[primitive];
            const glm::dvec3 a = placed(map(), t[0]);
            const glm::dvec3 n = glm::normalize(glm::cross(placed(map(), t[1]) - a, placed(map(), t[2]) - a));
            const double off = glm::dot(n, glm::dvec3(bench.position(i)) - a);
            ASSERT_LE(std::abs(off), glm::dot(glm::abs(n), glm::dvec3(bench.error(i))));
            next.push_back(untraced(bench.leaving_origin(i), leave[i]));
            from.push_back(primitive);
        }
        ASSERT_GT(next.size(), surface_batch / 2);
        left += next.size();
        bench.hit(next, std::vector<glm::vec3>(next.size(), glm::vec3(0, 0, 1)));
        for (std::size_t i = 0; i < next.size(); ++i) {
            if (bench.path(i).hit != HIT_NONE && bench.primitive(i) == from[i]) ++met;
        }
    }
    EXPECT_EQ(met, 0U) << "of " << left;
}

// Spheres and disks: a ray that leaves outwards meets nothing, one that goes inside a sphere meets it again.
TEST_P(Instances, AnalyticShapesAreLeft) {
    for (const auto kind : {AnalyticShape::Kind::sphere, AnalyticShape::Kind::disk, AnalyticShape::Kind::cylinder}) {
        Scene scene = empty_scene(16);
        const glm::mat4 in_group = glm::scale(glm::translate(glm::mat4(1.0F), {0.3F, -0.2F, 0.1F}), glm::vec3(0.7F));
        add_group(scene, AnalyticShape{kind, in_group}, add_diffuse(scene, Rgb{0.5F}));
        place(scene);
        SurfaceBench bench(scene);
        Generator random(4);
        std::vector<TestPath> rays;
        std::vector<glm::vec3> leave;
        while (rays.size() < surface_batch) {
            const glm::vec3 origin(placed(map(), 4.0F * uniform_direction(random)));
            const glm::vec3 inside = glm::vec3{0.3F, -0.2F, 0.1F} + 0.45F * uniform_direction(random);
            rays.push_back(untraced(origin, glm::vec3(glm::normalize(placed(map(), inside) - glm::dvec3(origin)))));
            leave.push_back(uniform_direction(random));
        }
        // Surfaces are there for hits alone.
        bench.trace(rays);
        std::vector<TestPath> hitting;
        for (std::size_t i = 0; i < surface_batch; ++i) {
            if (bench.path(i).hit != HIT_NONE) hitting.push_back(rays[i]);
        }
        leave.resize(hitting.size());
        bench.hit(hitting, leave);
        std::vector<TestPath> next;
        std::vector<float> cosine;
        for (std::size_t i = 0; i < hitting.size(); ++i) {
            ASSERT_EQ(bench.path(i).instance, 1U);
            next.push_back(untraced(bench.leaving_origin(i), leave[i]));
            cosine.push_back(glm::dot(leave[i], bench.normal(i)));
        }
        ASSERT_GT(next.size(), surface_batch / 4);
        bench.trace(next);
        // Floats out there tell points of the ellipsoid's rim apart: its radius of curvature is well above their steps.
        const glm::vec3 s = glm::abs(GetParam().scale);
        const float least = std::min({s.x, s.y, s.z});
        const bool resolved = 0.7F * least * least / std::max({s.x, s.y, s.z}) > 1e-6F * glm::length(GetParam().offset);
        for (std::size_t i = 0; i < next.size(); ++i) {
            const bool hit = bench.path(i).hit != HIT_NONE;
            if (kind == AnalyticShape::Kind::disk || cosine[i] > 0.0F) {
                ASSERT_FALSE(hit) << "kind " << static_cast<int>(kind) << " ray " << i << " t " << bench.path(i).t;
            } else if (kind == AnalyticShape::Kind::sphere && resolved && cosine[i] < -0.3F) {
                ASSERT_TRUE(hit) << "ray " << i;
            }
        }
    }
}

// From inside a closed mesh to its edges and vertices: no ray passes.
TEST_P(Instances, ClosedMeshesLetNoRayPass) {
    const ClosedMesh mesh = cube_mesh(6);
    Scene scene = empty_scene(16);
    add_group(scene, mesh_of(mesh.triangles()), add_diffuse(scene, Rgb{0.5F}));
    place(scene);
    SurfaceBench bench(scene);
    const std::vector<TestRay> aims = rays_from_inside(mesh, 0.4F, glm::vec3(0.0F), 8 * surface_batch);
    std::size_t passed = 0;
    for (std::size_t first = 0; first < aims.size(); first += surface_batch) {
        std::vector<TestPath> rays;
        for (std::size_t i = first; i < first + surface_batch; ++i) {
            const glm::dvec3 way = glm::dmat3(glm::mat3(map())) * glm::dvec3(aims[i].direction);
            rays.push_back(untraced(glm::vec3(placed(map(), aims[i].origin)), glm::vec3(glm::normalize(way))));
        }
        bench.trace(rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (bench.path(i).hit == HIT_NONE) ++passed;
        }
    }
    EXPECT_EQ(passed, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, Instances, testing::ValuesIn(instance_placements()),
                         [](const auto& p) { return std::string(p.param.name); });

// Any-hit rays: a hit before the limit blocks, one behind it does not; world and instances alike.
class InstanceShadows : public StageTest {};

TEST_P(InstanceShadows, AreCastByTheWorldAndByInstances) {
    Scene scene = empty_scene(16);
    const int material = add_diffuse(scene, Rgb{0.5F});
    add_quad(scene, {-1, -1, 9}, {2, 0, 0}, {0, 2, 0}, material);
    add_group(scene, mesh_of(cube_mesh(2).triangles()), material);
    for (int i = 0; i < 3; ++i) {
        const glm::mat4 map = glm::translate(glm::mat4(1.0F), {static_cast<float>(4 * i), 0, 5});
        add_instance(scene, glm::scale(map, {1, 1, i == 1 ? -2.0F : 0.5F}));
    }
    add_sphere(scene, {12, 0, 5}, 1.0F, material);
    scene.emitters.emplace_back(ConstantEmitter{});
    StageBench bench(scene, GetParam());
    // The near sides of cubes (of half size 1 or 2 or 0.5), quad and sphere.
    const float x[] = {0.1F, 4.1F, 8.1F, 12, 16, 0.2F};
    const float near[] = {4.5F, 3, 4.5F, 4, 1000, 4.5F};
    std::vector<TestShadowRay> rays;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const float reach = near[i / 2] * (i % 2 == 0 ? 0.999F : 1.001F);
        rays.push_back({reach, {0, 0, 1}, {1, 2, 3}, i, {x[i / 2], 0.2F * static_cast<float>(i / 2 != 3), 0}});
    }
    bench.fill_shadows(rays);
    bench.run("intersect_shadow");
    for (std::uint32_t i = 0; i < 12; ++i) {
        const bool seen = i % 2 == 0 || i / 2 == 4;
        EXPECT_EQ(bench.radiance(i), seen ? glm::vec3(1, 2, 3) : glm::vec3(0)) << "ray " << i;
    }
}

WAVELOBE_AT_EACH_WIDTH(InstanceShadows);

}  // namespace
}  // namespace wavelobe::test
