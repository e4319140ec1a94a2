#include <gtest/gtest.h>

#include <tuple>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

// At each width, with a hierarchy and without.
class IntersectShadow : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(IntersectShadow, LightThatIsSeenIsAdded) {
    Scene scene = empty_scene(16);
    add_quad(scene, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, add_diffuse(scene, Rgb{0.5F}));
    scene.emitters.emplace_back(PointEmitter{});
    StageBench bench(scene, std::get<0>(GetParam()), 64, std::get<1>(GetParam()));
    const auto ray = [](std::uint32_t id, const glm::vec3& origin, float limit) {
        return TestShadowRay{limit, {0, 0, 1}, glm::vec3(1, 2, 3) * static_cast<float>(id + 1), id, origin};
    };
    // In no order, so that radiance must go by the id.
    const std::uint32_t ids[] = {200, 3, 77, 5, 120, 4, 9, 0, 255, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42};
    std::vector<TestShadowRay> rays;
    std::vector<bool> seen;
    for (const std::uint32_t id : ids) {
        switch (id % 4) {
            case 0:
                rays.push_back(ray(id, {0.5F, 0.25F, 0}, 5.0F));
                seen.push_back(false);
                break;
            case 1:
                rays.push_back(ray(id, {0.5F, 0.25F, 0}, 1.75F));
                seen.push_back(true);
                break;  // the light comes first
            case 2:
                rays.push_back(ray(id, {1.5F, 0.25F, 0}, 5.0F));
                seen.push_back(true);
                break;  // beside
            default:
                rays.push_back(ray(id, {0.5F, 0.25F, 0}, std::numeric_limits<float>::infinity()));
                seen.push_back(false);
                break;
        }
    }
    const glm::vec3 before{0.5F, 0.25F, 0.125F};
    for (std::uint32_t id = 0; id < TILE_PIXELS; ++id) {
        for (std::uint32_t c = 0; c < 3; ++c) bench.radiance(id, c) = before[static_cast<glm::length_t>(c)];
    }
    bench.fill_shadows(rays);
    bench.run("intersect_shadow");
    EXPECT_EQ(bench.header().count[QUEUE_SHADOW], 0U);
    std::vector<glm::vec3> expected(TILE_PIXELS, before);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (seen[i]) expected[rays[i].id] = before + rays[i].contribution;
    }
    for (std::uint32_t id = 0; id < TILE_PIXELS; ++id) EXPECT_EQ(bench.radiance(id), expected[id]) << "path " << id;
}

INSTANTIATE_TEST_SUITE_P(All, IntersectShadow, testing::Combine(testing::Values(1, 8, 16), testing::Bool()),
                         [](const auto& p) {
                             return std::to_string(std::get<0>(p.param)) +
                                    (std::get<1>(p.param) ? "_few" : "_hierarchy");
                         });

}  // namespace
}  // namespace wavelobe::test
