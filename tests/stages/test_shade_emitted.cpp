#include <gtest/gtest.h>

#include "support/light_tree_reference.h"
#include "support/stage.h"

namespace wavelobe::test {
namespace {

class ShadeEmitted : public StageTest {};

const Rgb first_radiance{2.0F, 1.0F, 0.5F};
const Rgb second_radiance{0.25F, 4.0F, 8.0F};

// Triangles 0, 1: a parallelogram in z = 0 that shines towards +z, 2 x 3. Triangles 2, 3: a mesh of two triangles in z
// = -1, of areas 0.5 and 2, which shine towards +z.
Scene two_lights() {
    Scene scene = empty_scene(16);
    const int black = add_diffuse(scene, Rgb{0});
    make_emitter(add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0.5F, 3, 0}, black), first_radiance);
    TriangleMesh mesh;
    mesh.positions = {{5, 0, -1}, {6, 0, -1}, {5, 1, -1}, {7, 0, -1}, {9, 0, -1}, {7, 2, -1}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    make_emitter(add_shape(scene, mesh, black, "mesh"), second_radiance);
    return scene;
}

TestPath arriving(const StageBench& bench, std::uint32_t triangle, std::uint32_t id, const glm::vec3& direction,
                  float pdf) {
    TestPath p;
    p.hit = bench.slot_of(triangle);
    p.t = 4.0F;
    p.u = 0.25F;
    p.v = 0.25F;
    p.direction = glm::normalize(direction);
    p.id = id;
    p.pdf = pdf;
    p.throughput = {0.5F, 0.25F, 1.0F};
    return p;
}

TEST_P(ShadeEmitted, ShowsTheSideOfTheNormal) {
    StageBench bench(two_lights(), GetParam());
    std::vector<TestPath> paths;
    for (std::uint32_t id = 0; id < 24; ++id) {
        paths.push_back(arriving(bench, id % 4, id, {0.5F, 0, id < 12 ? -1.0F : 1.0F}, -1.0F));
    }
    bench.radiance(3, 1) = 7.0F;
    bench.fill(QUEUE_EMITTED, paths);
    bench.run("shade_emitted");
    EXPECT_EQ(bench.header().count[QUEUE_EMITTED], 0U);
    for (std::uint32_t id = 0; id < 24; ++id) {
        glm::vec3 expected = paths[id].throughput * (id % 4 < 2 ? first_radiance : second_radiance);
        if (id >= 12) expected = glm::vec3(0);
        if (id == 3) expected.y += 7.0F;
        EXPECT_EQ(bench.radiance(id), expected) << "path " << id;
    }
}

// More lights far off, so that a tree chooses.
Scene many_lights() {
    Scene scene = two_lights();
    for (int i = 0; i < 8; ++i) scene.emitters.emplace_back(PointEmitter{{0, 50, 10.0F * static_cast<float>(i)}, {1, 1, 1}});
    return scene;
}

// Of a triangle: van Oosterom and Strackee 1983.
double solid_angle(std::span<const glm::vec3, 3> t, const glm::dvec3& from) {
    const glm::dvec3 a = glm::normalize(glm::dvec3(t[0]) - from), b = glm::normalize(glm::dvec3(t[1]) - from), c = glm::normalize(glm::dvec3(t[2]) - from);
    return 2.0 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))), 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

void expect_weighted_against_light_sample(StageBench& bench) {
    const glm::vec3 direction{0.5F, 0.25F, -1};
    const double cosine = 1.0 / glm::length(glm::dvec3(direction));
    const double areas[] = {6.0, 6.0, 0.5, 2.0};
    const std::size_t lights[] = {0, 0, 1, 2};
    for (const float pdf : {0.05F, 3.0F}) {
        for (std::uint32_t triangle = 0; triangle < 4; ++triangle) {
            const TestPath p = arriving(bench, triangle, 8, direction, pdf);
            for (std::uint32_t c = 0; c < 3; ++c) bench.radiance(8, c) = 0.0F;
            bench.fill(QUEUE_EMITTED, {p});
            bench.run("shade_emitted");
            // Its place is that of barycentric coordinates of a quarter each.
            const std::span<const glm::vec3, 3> t = bench.scene().triangles[triangle];
            const glm::dvec3 hit = 0.5 * glm::dvec3(t[0]) + 0.25 * glm::dvec3(t[1]) + 0.25 * glm::dvec3(t[2]);
            const struct Light& chosen = bench.scene().lights[lights[triangle]];
            const glm::dvec3 from = hit - 4.0 * glm::normalize(glm::dvec3(direction));
            const double choice = reference_probability(bench.scene().light_tree, chosen.place, ReferenceReceiver{from, {}});
            ASSERT_GT(choice, 0.0);
            // Large triangles are sampled by solid angle.
            const bool wide = chosen.kind == LIGHT_SPHERICAL_TRIANGLE;
            const double light = choice * (wide ? 1.0 / solid_angle(t, from) : 16.0 / (cosine * areas[triangle]));
            const double p2 = static_cast<double>(pdf) * static_cast<double>(pdf);
            const Rgb radiance = triangle < 2 ? first_radiance : second_radiance;
            expect_close(bench.radiance(8),
                         glm::dvec3(p.throughput) * glm::dvec3(radiance) * p2 / (p2 + light * light));
        }
    }
}

TEST_P(ShadeEmitted, WeighsAgainstTheLightSample) {
    StageBench bench(two_lights(), GetParam());
    ASSERT_EQ(bench.scene().light_tree.size(), 1U);
    expect_weighted_against_light_sample(bench);
}

TEST_P(ShadeEmitted, WeighsAgainstTheLightSampleOfATree) {
    StageBench bench(many_lights(), GetParam());
    ASSERT_GT(bench.scene().light_tree.size(), 1U);
    expect_weighted_against_light_sample(bench);
}

WAVELOBE_AT_EACH_WIDTH(ShadeEmitted);

}  // namespace
}  // namespace wavelobe::test
