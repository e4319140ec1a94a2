// Spheres, disks and cylinders beside few triangles, tested without a hierarchy: hits must be those that the hierarchy finds.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "support/stage.h"

namespace wavelobe::test {
namespace {

constexpr int slots = 512;
constexpr float infinity = std::numeric_limits<float>::infinity();

class FewAnalytic : public testing::TestWithParam<int> {
protected:
    std::mt19937 engine{7};
    float uniform(float a, float b) { return std::uniform_real_distribution<float>(a, b)(engine); }
    glm::vec3 point(float half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
    glm::vec3 direction() {
        std::normal_distribution<float> normal;
        return glm::normalize(glm::vec3(normal(engine), normal(engine), normal(engine)));
    }

    // `holes`: every second shape lets half of the rays pass.
    Scene scene(bool holes) {
        Scene s = empty_scene(16);
        const int solid = add_diffuse(s, Rgb{0.5F});
        for (int i = 0; i < 20; ++i) {
            const glm::vec3 a = point(2.0F);
            add_triangle(s, a, a + point(2.0F), a + point(2.0F), solid);
        }
        constexpr AnalyticShape::Kind kinds[] = {AnalyticShape::Kind::sphere, AnalyticShape::Kind::disk, AnalyticShape::Kind::cylinder};
        for (int i = 0; i < 12; ++i) {
            glm::mat4 map = glm::translate(glm::mat4(1.0F), point(2.0F));
            map = glm::rotate(map, uniform(0.0F, 6.0F), direction());
            map = glm::scale(map, glm::vec3(uniform(0.2F, 1.0F)));
            Shape& shape = add_shape(s, AnalyticShape{kinds[i % 3], map}, solid, "shape");
            if (holes && i % 2 == 0) shape.material.opacity.value.value = Rgb(0.5F);
        }
        s.emitters.emplace_back(PointEmitter{});
        return s;
    }

    // Some start on a sphere's middle, some run along axes, some are no rays at all.
    std::vector<TestPath> rays() {
        std::vector<TestPath> out(slots);
        for (std::uint32_t i = 0; i < out.size(); ++i) {
            out[i].id = i % TILE_PIXELS;
            out[i].origin = point(2.0F);
            out[i].direction = direction();
            out[i].t = i % 3 == 0 ? uniform(0.5F, 4.0F) : infinity;
            if (i % 16 == 5) out[i].direction = {0, i % 32 == 5 ? 1 : -1, 0};
            if (i % 64 == 7) out[i].direction = glm::vec3(std::numeric_limits<float>::quiet_NaN());
            if (i % 64 == 9) out[i].origin = glm::vec3(std::numeric_limits<float>::quiet_NaN());
            if (i % 64 == 11) out[i].direction = glm::vec3(0.0F);
        }
        return out;
    }

    void expect_same_hits(const Scene& s) {
        StageBench few(s, GetParam(), slots, true);
        StageBench hierarchy(s, 16, slots, false);
        const std::vector<TestPath> paths = rays();
        int triangles = 0;
        int shapes = 0;
        for (StageBench* bench : {&few, &hierarchy}) {
            bench->fill(QUEUE_RAYS, paths);
            bench->run("intersect_closest");
        }
        for (std::uint32_t i = 0; i < paths.size(); ++i) {
            const TestPath a = few.path(QUEUE_RAYS, i);
            const TestPath b = hierarchy.path(QUEUE_RAYS, i);
            const bool shape = a.hit != HIT_NONE && (a.hit & HIT_ANALYTIC) != 0;
            if (shape || a.hit == HIT_NONE) {
                EXPECT_EQ(a.hit, b.hit) << "ray " << i;
                EXPECT_EQ(a.t, b.t) << "ray " << i;
            } else {  // the hierarchy may hold a triangle in several slots
                EXPECT_EQ(b.hit & HIT_ANALYTIC, 0U) << "ray " << i;
                EXPECT_NEAR(a.t, b.t, 1e-5F * b.t) << "ray " << i;
            }
            shapes += shape ? 1 : 0;
            triangles += a.hit != HIT_NONE && !shape ? 1 : 0;
        }
        EXPECT_GT(shapes, slots / 8);
        EXPECT_GT(triangles, slots / 8);
        expect_same_shadows(few, hierarchy, paths);
    }

    static void expect_same_shadows(StageBench& few, StageBench& hierarchy, const std::vector<TestPath>& paths) {
        std::vector<TestShadowRay> shadows;
        for (std::uint32_t i = 0; i < TILE_PIXELS; ++i) {
            shadows.push_back({paths[i].t, paths[i].direction, glm::vec3(1.0F), i, paths[i].origin});
        }
        for (StageBench* bench : {&few, &hierarchy}) {
            for (std::uint32_t id = 0; id < TILE_PIXELS; ++id) {
                for (std::uint32_t c = 0; c < 3; ++c) bench->radiance(id, c) = 0.0F;
            }
            bench->fill_shadows(shadows);
            bench->run("intersect_shadow");
        }
        int seen = 0;
        for (std::uint32_t id = 0; id < TILE_PIXELS; ++id) {
            EXPECT_EQ(few.radiance(id), hierarchy.radiance(id)) << "path " << id;
            seen += few.radiance(id).x > 0.0F ? 1 : 0;
        }
        EXPECT_GT(seen, 16);
        EXPECT_LT(seen, static_cast<int>(TILE_PIXELS) - 16);
    }
};

TEST_P(FewAnalytic, AreHitAsInAHierarchy) { expect_same_hits(scene(false)); }

TEST_P(FewAnalytic, LetRaysPassAsInAHierarchy) { expect_same_hits(scene(true)); }

INSTANTIATE_TEST_SUITE_P(Widths, FewAnalytic, testing::Values(1, 8, 16));

}  // namespace
}  // namespace wavelobe::test
