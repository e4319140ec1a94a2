#include <gtest/gtest.h>

#include "support/lobe_reference.h"
#include "support/stage.h"

namespace wavelobe::test {
namespace {

class ScatterDelta : public StageTest {};

// Triangles 0, 1: z = 1, normal +z, front a mirror; behind it glass or nothing.
Scene surface_scene(MaterialModel model, bool both_sides) {
    Scene scene = empty_scene(16);
    scene.integrator.rr_depth = 1000;
    Shape& quad = add_quad(scene, {0, 0, 1}, {2, 0, 0}, {0, 3, 0}, add_material(scene, std::move(model)));
    if (both_sides) quad.material.back = 0;
    return scene;
}

std::vector<TestPath> arriving(const StageBench& bench, const glm::vec3& direction, std::uint32_t count) {
    std::vector<TestPath> paths(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        paths[i].hit = bench.slot_of(i % 2);
        paths[i].u = 0.25F;
        paths[i].v = 0.5F;
        paths[i].t = 2.0F;
        paths[i].direction = glm::normalize(direction);
        paths[i].throughput = glm::vec3(1, 0.5F, 0.25F) * static_cast<float>(i + 1);
        paths[i].id = (i * 41) % TILE_PIXELS;
        paths[i].depth = i % 5;
    }
    return paths;
}

// Triangle (0, 0, 1), (2, 0, 1), (2, 3, 1) or (0, 0, 1), (2, 3, 1), (0, 3, 1) at u = 0.25, v = 0.5.
glm::dvec3 position(std::uint32_t i) { return i % 2 == 0 ? glm::dvec3{1.5, 1.5, 1} : glm::dvec3{0.5, 2.25, 1}; }

TEST_P(ScatterDelta, MirrorReflects) {
    StageBench bench(surface_scene(Conductor{}, false), GetParam());
    const std::vector<TestPath> paths = arriving(bench, {1, 0.5F, -2}, 19);
    bench.fill(QUEUE_DELTA, paths);
    // One ray is waiting already.
    TestPath waiting;
    waiting.id = 250;
    bench.fill(QUEUE_RAYS, {waiting});
    bench.run("scatter_delta");
    EXPECT_EQ(bench.header().count[QUEUE_DELTA], 0U);
    ASSERT_EQ(bench.header().count[QUEUE_RAYS], 20U);
    EXPECT_EQ(bench.path(QUEUE_RAYS, 0).id, 250U);
    for (std::uint32_t i = 0; i < 19; ++i) {
        const TestPath p = bench.path(QUEUE_RAYS, i + 1);
        EXPECT_EQ(p.id, paths[i].id);
        EXPECT_EQ(p.depth, paths[i].depth + 1);
        EXPECT_LT(p.pdf, 0.0F);
        EXPECT_EQ(p.t, std::numeric_limits<float>::infinity());
        expect_close(p.throughput, paths[i].throughput);
        expect_close(p.direction, glm::dvec3(paths[i].direction) * glm::dvec3(1, 1, -1));
        expect_close(p.origin, position(i));
        EXPECT_GT(p.origin.z, 1.0F) << "on the side that the ray leaves on";
    }
}

TEST_P(ScatterDelta, PathsEndAtABlackBack) {
    StageBench bench(surface_scene(Conductor{}, false), GetParam());
    bench.fill(QUEUE_DELTA, arriving(bench, {1, 0.5F, 2}, 5));
    bench.run("scatter_delta");
    EXPECT_EQ(bench.header().count[QUEUE_DELTA], 0U);
    EXPECT_EQ(bench.header().count[QUEUE_RAYS], 0U);
}

// Glass: each path is reflected or refracted, in the shares of Fresnel's equations.
TEST_P(ScatterDelta, GlassReflectsOrRefracts) {
    const Scene scene = surface_scene(Dielectric{1.5F, constant(1.0F), constant(1.0F)}, true);
    for (const float side : {-1.0F, 1.0F}) {
        StageBench bench(scene, GetParam(), 256);
        const std::vector<TestPath> paths = arriving(bench, {1.5F, 0.0F, 2.0F * side}, 256);
        bench.fill(QUEUE_DELTA, paths);
        bench.run("scatter_delta");
        ASSERT_EQ(bench.header().count[QUEUE_RAYS], 256U);
        const glm::dvec3 d{paths[0].direction};
        const double eta = side < 0.0F ? 1.5 : 1.0 / 1.5;  // behind the surface over before it
        const double fresnel = reference_fresnel_dielectric(-d.z, 1.5);
        const double cos_t = std::sqrt(1.0 - (1.0 - d.z * d.z) / (eta * eta));
        std::uint32_t reflected = 0;
        for (std::uint32_t i = 0; i < 256; ++i) {
            const TestPath p = bench.path(QUEUE_RAYS, i);
            const bool reflects = p.direction.z * side < 0.0F;
            reflected += reflects ? 1 : 0;
            const glm::dvec3 refracted{d.x / eta, d.y / eta, static_cast<double>(side) * cos_t};
            expect_close(p.direction, reflects ? d * glm::dvec3(1, 1, -1) : refracted);
            expect_close(p.throughput, glm::dvec3(paths[i].throughput) / (reflects ? 1.0 : eta * eta));
            EXPECT_NEAR(p.eta, reflects ? 1.0 : eta, stage_rounding);
            EXPECT_GT((p.origin.z - 1.0F) * (reflects ? -side : side), 0.0F) << "on the side that the ray leaves on";
        }
        EXPECT_NEAR(reflected, 256.0 * fresnel, 4.5 * std::sqrt(256.0 * fresnel * (1.0 - fresnel)));
    }
}

// From `rr_depth` vertices on a path survives with its throughput's share of the threshold, and is made brighter by it.
TEST_P(ScatterDelta, RouletteKeepsTheMean) {
    Scene scene = surface_scene(Conductor{}, false);
    scene.integrator.rr_depth = 3;
    StageBench bench(scene, GetParam(), 256);
    std::vector<TestPath> paths = arriving(bench, {1, 0.5F, -2}, 256);
    constexpr std::uint32_t deep = 64;  // vertices of the last 64 paths
    for (std::uint32_t i = 0; i < 256; ++i) {
        paths[i].id = i;
        paths[i].pdf = 0.5F;
        paths[i].depth = i < 64 ? 1 : i < 192 ? 2 : deep;  // the second vertex or the third, or a late one
        paths[i].throughput = i < 192 ? glm::vec3{0.1F, 0.05F, 0.2F} : glm::vec3{0.95F, 0.5F, 1.0F};
    }
    bench.fill(QUEUE_DELTA, paths);
    bench.run("scatter_delta");
    std::uint32_t spared = 0, dim = 0, bright = 0;
    for (std::uint32_t i = 0; i < bench.header().count[QUEUE_RAYS]; ++i) {
        const TestPath p = bench.path(QUEUE_RAYS, i);
        if (p.id < 64) {
            ++spared;
            expect_close(p.throughput, {0.1, 0.05, 0.2});
        } else if (p.id < 192) {
            ++dim;
            expect_close(p.throughput, {0.2, 0.1, 0.4});
        } else {
            ++bright;
            expect_close(p.throughput, glm::dvec3(0.95, 0.5, 1.0) / 0.95);
        }
    }
    EXPECT_EQ(spared, 64U);
    EXPECT_NEAR(dim, 64.0, 4.5 * std::sqrt(128 * 0.25));
    EXPECT_NEAR(bright, 64 * 0.95, 4.5 * std::sqrt(64 * 0.95 * 0.05));
    EXPECT_LT(bright, 64U);
}

// What the camera sees in a dark mirror is no matter of luck until next to nothing is left of it; what a rough surface sees there is.
TEST_P(ScatterDelta, RouletteSparesWhatOnlyMirrorsDimmed) {
    Scene scene = surface_scene(Conductor{}, false);
    scene.integrator.rr_depth = 1;
    StageBench bench(scene, GetParam(), 256);
    std::vector<TestPath> paths = arriving(bench, {1, 0.5F, -2}, 256);
    for (std::uint32_t i = 0; i < 256; ++i) {
        paths[i].id = i;
        paths[i].pdf = i < 128 ? -1.0F : 0.5F;
        paths[i].throughput = i < 64 ? glm::vec3{0.01F} : i < 128 ? glm::vec3{0.005F} : glm::vec3{0.1F};
    }
    bench.fill(QUEUE_DELTA, paths);
    bench.run("scatter_delta");
    std::uint32_t spared = 0, faint = 0, seen = 0;
    for (std::uint32_t i = 0; i < bench.header().count[QUEUE_RAYS]; ++i) {
        const TestPath p = bench.path(QUEUE_RAYS, i);
        (p.id < 64 ? spared : p.id < 128 ? faint : seen) += 1;
        expect_close(p.throughput, glm::dvec3(p.id < 128 ? 0.01 : 0.4));
    }
    EXPECT_EQ(spared, 64U);
    EXPECT_NEAR(faint, 32.0, 4.5 * std::sqrt(64 * 0.25));
    EXPECT_NEAR(seen, 32.0, 4.5 * std::sqrt(128 * 0.25 * 0.75));
}

// What is bright enough does not play.
TEST_P(ScatterDelta, RouletteSparesTheBright) {
    Scene scene = surface_scene(Conductor{}, false);
    scene.integrator.rr_depth = 1;
    StageBench bench(scene, GetParam(), 256);
    std::vector<TestPath> paths = arriving(bench, {1, 0.5F, -2}, 256);
    for (TestPath& p : paths) p.pdf = 0.5F, p.throughput = {0.1F, 0.4F, 0.2F};
    bench.fill(QUEUE_DELTA, paths);
    bench.run("scatter_delta");
    ASSERT_EQ(bench.header().count[QUEUE_RAYS], 256U);
    for (std::uint32_t i = 0; i < 256; ++i) expect_close(bench.path(QUEUE_RAYS, i).throughput, {0.1, 0.4, 0.2});
}

WAVELOBE_AT_EACH_WIDTH(ScatterDelta);

}  // namespace
}  // namespace wavelobe::test
