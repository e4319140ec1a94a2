#include <gtest/gtest.h>

#include "support/lobe_reference.h"
#include "support/stage.h"

namespace wavelobe::test {
namespace {

class ScatterGlossy : public StageTest {};

constexpr std::uint32_t count = 64;
const Rgb intensity{4.0F, 8.0F, 2.0F};

// Triangles 0, 1: [0, 2] x [0, 3] in z = 1, normal +z; a point light in front.
Scene wall_scene(MaterialModel model) {
    Scene scene = empty_scene(16);
    scene.integrator.rr_depth = 1000;
    add_quad(scene, {0, 0, 1}, {2, 0, 0}, {0, 3, 0}, add_material(scene, std::move(model)));
    scene.emitters.emplace_back(PointEmitter{{2.5F, 2.0F, 3}, intensity});
    return scene;
}

std::vector<TestPath> arriving(const StageBench& bench) {
    std::vector<TestPath> paths(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        paths[i].hit = bench.slot_of(0);
        paths[i].u = 0.25F;
        paths[i].v = 0.5F;
        paths[i].t = 2.0F;
        paths[i].direction = glm::normalize(glm::vec3{1, 0.5F, -2});
        paths[i].throughput = glm::vec3(1, 0.5F, 0.25F) * static_cast<float>(i + 1);
        paths[i].id = i;
    }
    return paths;
}

// World directions are local ones up to a turn about z, which these lobes do not see.
void expect_lobe(StageBench& bench, const std::vector<TestPath>& paths,
                 const std::function<ReferenceValue(const glm::dvec3&, const glm::dvec3&)>& lobe) {
    const glm::dvec3 wi = -glm::normalize(glm::dvec3(paths[0].direction));
    ASSERT_EQ(bench.header().count[QUEUE_SHADOW], count);
    const glm::dvec3 way = glm::dvec3{2.5, 2.0, 3} - glm::dvec3{1.5, 1.5, 1};
    const double d2 = glm::dot(way, way);
    const glm::dvec3 light = lobe(wi, glm::normalize(way)).f_cos * glm::dvec3(intensity) / d2;
    for (std::uint32_t i = 0; i < count; ++i) {
        expect_close(bench.shadow(i).contribution, glm::dvec3(paths[i].throughput) * light, 4.0 * stage_rounding);
    }
    // Directions below the surface are failed samples.
    ASSERT_GT(bench.header().count[QUEUE_RAYS], count / 2);
    ASSERT_LE(bench.header().count[QUEUE_RAYS], count);
    for (std::uint32_t i = 0; i < bench.header().count[QUEUE_RAYS]; ++i) {
        const TestPath p = bench.path(QUEUE_RAYS, i);
        const ReferenceValue value = lobe(wi, glm::normalize(glm::dvec3(p.direction)));
        // A lobe of roughness 0.2 changes by some tens of its value a radian: a direction's rounding counts that often.
        EXPECT_NEAR(p.pdf, value.pdf, 20.0 * stage_rounding * value.pdf);
        expect_close(p.throughput, glm::dvec3(paths[p.id].throughput) * value.f_cos / value.pdf, 20.0 * stage_rounding);
        EXPECT_EQ(p.depth, 1U);
    }
}

TEST_P(ScatterGlossy, RoughConductor) {
    const RoughConductor metal{{0.2F, 0.9F, 1.1F}, {3.9F, 2.4F, 2.2F}, constant(0.9F),
                               constant(0.2F),     constant(0.2F),     Distribution::ggx};
    StageBench bench(wall_scene(metal), GetParam());
    const std::vector<TestPath> paths = arriving(bench);
    bench.fill(QUEUE_GLOSSY, paths);
    bench.run("scatter_glossy");
    EXPECT_EQ(bench.header().count[QUEUE_GLOSSY], 0U);
    const ::Material material = bench.scene().materials[0];
    expect_lobe(bench, paths, [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return reference_rough_conductor(material, wi, wo);
    });
}

// A material of two smooth lobes has one mixture density, whichever lobe proposes.
TEST_P(ScatterGlossy, MixtureWithADiffuseLobe) {
    StageBench bench(wall_scene(Phong{constant(0.5F), constant(0.25F), constant(20.0F)}), GetParam());
    const std::vector<TestPath> paths = arriving(bench);
    bench.fill(QUEUE_GLOSSY, paths);
    bench.run("scatter_glossy");
    const ::Material material = bench.scene().materials[0];
    expect_lobe(bench, paths, [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        const ReferenceValue glossy = reference_phong(material, wi, wo);
        const ReferenceValue diffuse = reference_lambert(material, wi, wo);
        const double share = 0.25 / 0.75;
        return ReferenceValue{glossy.f_cos + diffuse.f_cos, share * glossy.pdf + (1.0 - share) * diffuse.pdf};
    });
}

WAVELOBE_AT_EACH_WIDTH(ScatterGlossy);

}  // namespace
}  // namespace wavelobe::test
