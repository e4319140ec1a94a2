// Vectors and frames against double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "support/probe.h"

namespace wavelobe::test {
namespace {

constexpr double half_ulp = 0x1p-24;

const char* const source = R"(
    #include "core/vector.h"
    INLINE Vec3 load3(global const float *p, uint n, size_t i) { return vec3(load(p + i), load(p + n + i), load(p + 2 * n + i)); }
    INLINE void store3(global float *p, uint n, size_t i, Vec3 v) {
        store(p + i, v.x);
        store(p + n + i, v.y);
        store(p + 2 * n + i, v.z);
    }
    kernel void has_fma(global uint *answer) {
    #ifdef __FMA__
        *answer = 1u;
    #endif
    }
    kernel void frame(global const float *normals, global float *out, uint n) {
        size_t i = get_global_id(0) * LANES;
        Frame f = frame_of_normal(load3(normals, n, i));
        store3(out, n, i, f.s);
        store3(out + 3 * n, n, i, f.t);
        store3(out + 6 * n, n, i, f.n);
    }
    kernel void turn(global const float *normals, global const float *vectors, global float *in_frame, global float *back, uint n) {
        size_t i = get_global_id(0) * LANES;
        Frame f = frame_of_normal(load3(normals, n, i));
        Vec3 v = to_local(f, load3(vectors, n, i));
        store3(in_frame, n, i, v);
        store3(back, n, i, to_world(f, v));
    }
    kernel void products(global const float *a, global const float *b, global float *cross_product, global float *dot_product,
                         global float *unit, uint n) {
        size_t i = get_global_id(0) * LANES;
        store3(cross_product, n, i, cross3(load3(a, n, i), load3(b, n, i)));
        store(dot_product + i, dot3(load3(a, n, i), load3(b, n, i)));
        store3(unit, n, i, normalize3(load3(a, n, i)));
    }
)";

// Vectors as the probes take them: all x, all y, all z; padded to whole groups.
struct Soa {
    std::vector<float> values;
    std::uint32_t count;
    explicit Soa(const std::vector<glm::vec3>& vectors) : count(static_cast<std::uint32_t>((vectors.size() + 15) / 16 * 16)) {
        values.resize(3 * std::size_t{count}, 0.0F);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec3 v = i < vectors.size() ? vectors[i] : vectors[0];
            for (int k = 0; k < 3; ++k) values[static_cast<std::size_t>(k) * count + i] = v[k];
        }
    }
};

glm::dvec3 vector_at(const std::vector<float>& values, std::size_t count, std::size_t i, std::size_t block = 0) {
    const std::size_t at = 3 * count * block + i;
    return {values[at], values[at + count], values[at + 2 * count]};
}

std::vector<glm::vec3> unit_vectors(std::size_t count) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    // The poles, where a naive construction divides by zero; both zeros of z, where the sign changes; and close to them.
    std::vector<glm::vec3> list = {{0, 0, 1}, {0, 0, -1}, {-0.0F, 0.0F, -1}, {0.0F, -0.0F, -1}, {1, 0, 0.0F}, {1, 0, -0.0F},
                                   {0, 1, 0.0F}, {0, -1, -0.0F}, {-1, 0, 0}};
    for (double angle : {1e-30, 1e-8, 1e-6, 1e-4, 3e-4, 1e-3, 1e-2}) {
        for (double phi : {0.1, 2.0, 4.0}) {
            for (double z : {1.0, -1.0}) {
                list.emplace_back(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), z * std::cos(angle));
                list.emplace_back(std::cos(angle) * std::cos(phi), std::cos(angle) * std::sin(phi), z * std::sin(angle));
            }
        }
    }
    while (list.size() < count) list.emplace_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
    return list;
}

class Vector : public testing::TestWithParam<int> {
protected:
    Probe probe_{source, {.lanes = GetParam(), .defines = ""}};
    bool fused() {
        std::vector<std::uint32_t> answer(1);
        probe_.run("has_fma", 1, answer);
        return answer[0] != 0;
    }
    std::size_t items(std::uint32_t count) const { return count / static_cast<unsigned>(GetParam()); }
};

TEST_P(Vector, FramesAreOrthonormalAndRightHanded) {
    const Soa normals(unit_vectors(20000));
    const std::uint32_t n = normals.count;
    const auto& input = normals.values;
    std::vector<float> out(9 * std::size_t{n});
    probe_.run("frame", items(n), input, out, n);
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 s = vector_at(out, n, i, 0), t = vector_at(out, n, i, 1), normal = vector_at(out, n, i, 2);
        const auto where = testing::Message() << normal.x << " " << normal.y << " " << normal.z;
        ASSERT_EQ(normal, vector_at(input, n, i));
        // A unit normal is one to three roundings; the construction adds a handful, of numbers up to 1.
        const double bound = 8 * half_ulp;
        ASSERT_NEAR(glm::dot(s, s), 1.0, bound) << where;
        ASSERT_NEAR(glm::dot(t, t), 1.0, bound) << where;
        ASSERT_NEAR(glm::dot(s, t), 0.0, bound) << where;
        ASSERT_NEAR(glm::dot(s, normal), 0.0, bound) << where;
        ASSERT_NEAR(glm::dot(t, normal), 0.0, bound) << where;
        ASSERT_NEAR(glm::dot(glm::cross(s, t), normal), 1.0, bound) << where;
    }
}

TEST_P(Vector, LocalAndBackIsTheSameVector) {
    auto directions = unit_vectors(20000);
    const Soa normals(directions);
    std::reverse(directions.begin(), directions.end());
    const Soa vectors(directions);
    const std::uint32_t n = normals.count;
    const auto &a = normals.values, &b = vectors.values;
    std::vector<float> local(b.size()), back(b.size());
    probe_.run("turn", items(n), a, b, local, back, n);
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 v = vector_at(b, n, i);
        ASSERT_LE(glm::length(vector_at(back, n, i) - v), 20 * half_ulp);
        // Local z is the cosine to the normal: three products, two sums.
        ASSERT_NEAR(vector_at(local, n, i).z, glm::dot(v, vector_at(a, n, i)), 3 * half_ulp);
    }
}

TEST_P(Vector, ProductsAreWithinTheirBounds) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1000.0F, 1000.0F);
    std::vector<glm::vec3> a, b;
    for (int i = 0; i < 20000; ++i) {
        a.emplace_back(uniform(random), uniform(random), uniform(random));
        // Every other one nearly parallel, where a plain cross product has no correct digit.
        b.emplace_back(i % 2 ? a.back() * 1.37F : glm::vec3(uniform(random), uniform(random), uniform(random)));
    }
    const Soa soa_a(a), soa_b(b);
    const std::uint32_t n = soa_a.count;
    const auto &in_a = soa_a.values, &in_b = soa_b.values;
    std::vector<float> cross(in_a.size()), dot(n), unit(in_a.size());
    const bool has_fma = fused();
    probe_.run("products", items(n), in_a, in_b, cross, dot, unit, n);
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 u = vector_at(in_a, n, i), v = vector_at(in_b, n, i), c = vector_at(cross, n, i);
        const glm::dvec3 exact = glm::cross(u, v);
        for (int k = 0; k < 3; ++k) {
            const double products = std::abs(u[(k + 1) % 3] * v[(k + 2) % 3]) + std::abs(u[(k + 2) % 3] * v[(k + 1) % 3]);
            ASSERT_NEAR(c[k], exact[k], 3 * half_ulp * products);
            if (has_fma) {
                // Jeannerod, Louvet, Muller 2013: 1.5 ulp of the result.
                ASSERT_NEAR(c[k], exact[k], 3 * half_ulp * std::abs(exact[k])) << i;
            }
        }
        ASSERT_NEAR(dot[i], glm::dot(u, v), 3 * half_ulp * glm::dot(glm::abs(u), glm::abs(v)));
        ASSERT_LE(glm::length(vector_at(unit, n, i) - glm::normalize(u)), 5 * half_ulp);
    }
}

INSTANTIATE_TEST_SUITE_P(Widths, Vector, testing::Values(1, 8, 16));

}  // namespace
}  // namespace wavelobe::test
