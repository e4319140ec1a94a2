// Ray origins against exact arithmetic: they clear the surface whatever the true point within its error bound, by no more
// than that takes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "support/probe.h"

namespace wavelobe::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

class Rounding : public testing::TestWithParam<int> {
protected:
    unsigned lanes() const { return static_cast<unsigned>(GetParam()); }
    Probe probe_{R"(
        #include "core/rounding.h"
        kernel void step_along(global const float *x, global const float *offset, global float *along) {
            size_t i = get_global_id(0) * LANES;
            store(along + i, round_along(load(x + i), load(offset + i)));
        }
        kernel void gammas(global float *out) {
            out[0] = GAMMA(1);
            out[1] = GAMMA(7);
            out[2] = GAMMA(100);
        }
        INLINE Vec3 load3(global const float *p, uint n, size_t i) { return vec3(load(p + i), load(p + n + i), load(p + 2 * n + i)); }
        kernel void origins(global const float *points, global const float *errors, global const float *normals,
                            global const float *directions, global float *out, uint n) {
            size_t i = get_global_id(0) * LANES;
            Vec3 o = offset_ray_origin(load3(points, n, i), load3(errors, n, i), load3(normals, n, i), load3(directions, n, i));
            store(out + i, o.x);
            store(out + n + i, o.y);
            store(out + 2 * n + i, o.z);
        })",
                 {.lanes = GetParam(), .defines = ""}};
};

TEST_P(Rounding, StepsToTheNextFloat) {
    const std::vector<float> values = {0.0F, -0.0F, 1.0F, -1.0F, 1e-45F, -1e-45F, 1e-38F, 0.99999994F, 1024.0F, -3e38F, 0.1F, -77.7F, 2.0F,
                                 -2.0F, 1e10F, std::numeric_limits<float>::min()};
    std::vector<float> xs, offsets;
    for (float x : values) {
        for (float offset : {1.0F, -1.0F, 1e-30F, -1e-30F, 0.0F, -0.0F, 5.0F, -5.0F}) {
            xs.push_back(x);
            offsets.push_back(offset);
        }
    }
    const auto &x = xs, &offset = offsets;
    std::vector<float> along(x.size());
    probe_.run("step_along", x.size() / lanes(), x, offset, along);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const float expected = offset[i] == 0 ? x[i] : std::nextafter(x[i], offset[i] > 0 ? infinity : -infinity);
        EXPECT_EQ(along[i], expected) << x[i] << " along " << offset[i];
    }
}

TEST_P(Rounding, GammaIsHighamsBound) {
    std::vector<float> out(3);
    probe_.run("gammas", 1, out);
    const double u = 0x1p-24;
    const double counts[] = {1, 7, 100};
    for (std::size_t i = 0; i < 3; ++i) {
        const double exact = counts[i] * u / (1 - counts[i] * u);
        EXPECT_NEAR(out[i], exact, 2 * u * exact);
    }
}

struct Case {
    glm::vec3 point, error, normal, direction;
};

std::vector<Case> cases() {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    std::normal_distribution<float> normal;
    const auto direction = [&] { return glm::normalize(glm::vec3(normal(random), normal(random), normal(random))); };
    std::vector<Case> list;
    const std::vector<glm::vec3> axes = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {-0.0F, 0.0F, -1}, {0.6F, 0.8F, 0}, {-0.0F, -0.6F, 0.8F}};
    for (int i = 0; i < 48000; ++i) {
        Case c;
        const float scale = std::exp2(static_cast<float>(i % 60 - 30));
        c.point = scale * glm::vec3(uniform(random), uniform(random), uniform(random));
        c.normal = i % 3 == 0 ? axes[static_cast<std::size_t>(i / 3) % axes.size()] : direction();
        c.direction = i % 5 == 0 ? (i % 2 ? c.normal : -c.normal) : direction();
        // As triangles and quadrics bound it: some roundings of the point's own size or of the size of what it is made of.
        const float roundings = static_cast<float>(i % 7) * 2;
        c.error = roundings * 0x1p-24F * (i % 4 == 0 ? glm::abs(c.point) : glm::vec3(scale));
        for (int k = 0; k < 3; ++k) {
            if ((i / 8 >> k & 1) != 0 && i % 2 == 0) c.point[k] = i % 4 == 0 ? 0.0F : -0.0F;
        }
        list.push_back(c);
    }
    return list;
}

TEST_P(Rounding, OriginsClearTheSurfaceOnTheRightSide) {
    const std::vector<Case> list = cases();
    const auto n = static_cast<std::uint32_t>(list.size());
    std::vector<float> soa[4];
    for (auto& values : soa) values.resize(3 * list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const glm::vec3* vectors[] = {&list[i].point, &list[i].error, &list[i].normal, &list[i].direction};
        for (int v = 0; v < 4; ++v) {
            for (int k = 0; k < 3; ++k) soa[v][static_cast<std::size_t>(k) * n + i] = (*vectors[v])[k];
        }
    }
    const auto &points = soa[0], &errors = soa[1], &normals = soa[2], &directions = soa[3];
    std::vector<float> out(3 * list.size());
    probe_.run("origins", n / lanes(), points, errors, normals, directions, out, n);
    int moved = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Case& c = list[i];
        const glm::dvec3 normal = c.normal, error = c.error;
        const glm::dvec3 origin(out[i], out[n + i], out[2 * std::size_t{n} + i]);
        const glm::dvec3 offset = origin - glm::dvec3(c.point);
        const double reach = glm::dot(glm::abs(normal), error);  // of the box of possible points along the normal
        const double cosine = glm::dot(normal, glm::dvec3(c.direction));
        const double side = cosine < 0 ? -1 : 1;
        const auto where = testing::Message() << "case " << i << " point " << c.point.x << " " << c.point.y << " " << c.point.z
                                              << " error " << c.error.x << " normal " << c.normal.x << " " << c.normal.y << " "
                                              << c.normal.z;
        if (reach == 0) {
            ASSERT_EQ(offset, glm::dvec3(0)) << where;
            continue;
        }
        ++moved;
        ASSERT_GE(side * glm::dot(offset, normal), reach) << where;
        for (int k = 0; k < 3; ++k) {
            // No coordinate moves against the normal, and none by more than its share, its own rounding and one float.
            const double share = std::abs(normal[k]) * reach;
            ASSERT_GE(side * offset[k] * normal[k], 0.0) << where;
            ASSERT_LE(std::abs(offset[k]), share * (1 + 0x1p-20) + 2 * 0x1p-23 * (std::abs(c.point[k]) + share) + 0x1p-149) << where;
        }
    }
    EXPECT_GT(moved, 30000);
}

INSTANTIATE_TEST_SUITE_P(Widths, Rounding, testing::Values(1, 8, 16));

}  // namespace
}  // namespace wavelobe::test
