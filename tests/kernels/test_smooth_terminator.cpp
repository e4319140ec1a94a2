// The way from a facet to the curved surface that its normals stand for, against double precision.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "support/probe.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {
namespace {

using Corners = std::array<glm::vec3, 3>;

struct Facet {
    Corners corners, normals;  // of any length
    glm::vec3 weights;

    glm::vec3 point() const { return corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z; }
    glm::dvec3 geometric() const {
        return glm::normalize(glm::cross(glm::dvec3(corners[1] - corners[0]), glm::dvec3(corners[2] - corners[0])));
    }
    glm::dvec3 shading() const {
        return glm::normalize(glm::dvec3(normals[0] * weights.x + normals[1] * weights.y + normals[2] * weights.z));
    }
};

// Hanika 2021, equation by equation: each corner moves the point to its tangent plane where it lies below.
glm::dvec3 rise_of(const Facet& facet, double side) {
    glm::dvec3 sum{0.0};
    for (int k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(k);
        const glm::dvec3 n = side * glm::normalize(glm::dvec3(facet.normals[corner]));
        const double height = std::min(0.0, glm::dot(glm::dvec3(facet.point()) - glm::dvec3(facet.corners[corner]), n));
        sum -= static_cast<double>(facet.weights[k]) * height * n;
    }
    const glm::dvec3 up = glm::dot(facet.geometric(), facet.shading()) < 0.0 ? -facet.geometric() : facet.geometric();
    return glm::dot(sum, side * up) > 0.0 ? sum : glm::dvec3(0.0);
}

// One vector a row of floats: point, corners, normals, weights, facet's normal, shading normal.
constexpr std::size_t vectors = 10;

class SmoothTerminator : public testing::TestWithParam<int> {
protected:
    // front and behind, of each facet
    std::vector<std::array<glm::vec3, 2>> rises(const std::vector<Facet>& facets) {
        const std::size_t n = (facets.size() + 15) / 16 * 16;
        std::vector<float> in(n * 3 * vectors, 0.0F), out(n * 6);
        for (std::size_t i = 0; i < facets.size(); ++i) {
            const Facet& f = facets[i];
            const std::array<glm::vec3, vectors> all = {f.point(), f.corners[0], f.corners[1], f.corners[2], f.normals[0], f.normals[1], f.normals[2],
                                                        f.weights, glm::vec3(f.geometric()), glm::vec3(f.shading())};
            for (std::size_t v = 0; v < vectors; ++v) {
                for (int k = 0; k < 3; ++k) in[(3 * v + static_cast<std::size_t>(k)) * n + i] = all[v][k];
            }
        }
        auto stride = static_cast<std::uint32_t>(n);
        probe_.run("find_rises", n / static_cast<std::size_t>(GetParam()), in, out, stride);
        std::vector<std::array<glm::vec3, 2>> found(facets.size());
        for (std::size_t i = 0; i < facets.size(); ++i) {
            for (std::size_t s = 0; s < 2; ++s) found[i][s] = {out[3 * s * n + i], out[(3 * s + 1) * n + i], out[(3 * s + 2) * n + i]};
        }
        return found;
    }

    void expect_rises(const std::vector<Facet>& facets) {
        const auto found = rises(facets);
        for (std::size_t i = 0; i < facets.size(); ++i) {
            for (std::size_t s = 0; s < 2; ++s) {
                const glm::dvec3 expected = rise_of(facets[i], s == 0 ? 1.0 : -1.0);
                EXPECT_LT(glm::length(glm::dvec3(found[i][s]) - expected), 1e-6) << "facet " << i << (s == 0 ? " in front" : " behind");
            }
        }
    }

    Probe probe_{R"(
        #include "shapes/smooth_terminator.h"
        #define VECTOR(k) vec3(load(in + (3u * (k)) * n + i), load(in + (3u * (k) + 1u) * n + i), load(in + (3u * (k) + 2u) * n + i))
        #define STORE_VECTOR(k, v) store(out + (k) * n + i, (v).x); store(out + ((k) + 1u) * n + i, (v).y); store(out + ((k) + 2u) * n + i, (v).z)
        kernel void find_rises(global const float *in, global float *out, uint n) {
            size_t i = get_global_id(0) * LANES;
            Vec3 weights = VECTOR(7u);
            Rise rise = no_rise();
            add_corner_rise(&rise, VECTOR(0u), VECTOR(1u), VECTOR(4u), weights.x);
            add_corner_rise(&rise, VECTOR(0u), VECTOR(2u), VECTOR(5u), weights.y);
            add_corner_rise(&rise, VECTOR(0u), VECTOR(3u), VECTOR(6u), weights.z);
            rise = rise_above(rise, VECTOR(8u), VECTOR(9u));
            STORE_VECTOR(0u, rise.front);
            STORE_VECTOR(3u, rise.behind);
        })",
                 {.lanes = GetParam(), .defines = ""}};
};

Facet random_facet(Generator& random, float spread) {
    Facet f;
    for (std::size_t k = 0; k < 3; ++k) f.corners[k] = uniform_direction(random);
    const glm::vec3 n(f.geometric());
    for (glm::vec3& normal : f.normals) normal = uniform(random, 0.1F, 10.0F) * glm::normalize(n + spread * uniform_direction(random));
    const float a = uniform(random, 0.0F, 1.0F), b = uniform(random, 0.0F, 1.0F - a);
    f.weights = {a, b, 1.0F - a - b};
    return f;
}

TEST_P(SmoothTerminator, IsHanikas) {
    Generator random(3);
    for (const float spread : {0.01F, 0.5F, 0.95F}) {
        std::vector<Facet> facets;
        for (int i = 0; i < 2000; ++i) facets.push_back(random_facet(random, spread));
        expect_rises(facets);
    }
}

// On a ball the curved surface is above the facet and, but for the tangent planes' own height, below the ball.
TEST_P(SmoothTerminator, BulgesOnlyToTheOutsideOfABall) {
    Generator random(4);
    std::vector<Facet> facets;
    for (int i = 0; i < 2000; ++i) {
        Facet f = random_facet(random, 0.0F);
        f.normals = f.corners;
        if (glm::dot(f.geometric(), f.shading()) > 0.3) facets.push_back(f);
    }
    const auto found = rises(facets);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        EXPECT_GT(glm::dot(glm::dvec3(found[i][0]), facets[i].geometric()), 0.0) << i;
        EXPECT_LT(glm::length(found[i][1]), 1e-6F) << i;
    }
}

TEST_P(SmoothTerminator, IsNothingWhereNormalsAgreeOrLeadBelow) {
    Facet flat{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 2}, {0, 0, 2}, {0, 0, 2}}}, {0.25F, 0.25F, 0.5F}};
    Facet none = flat;
    none.normals = {};
    Facet wild = flat;  // two corners see the point below them, along normals that point down
    wild.normals = {{{-1, 0, -0.2F}, {1, 0, -0.2F}, {0, 0, 3}}};
    const auto found = rises({flat, none, wild});
    for (const auto& rise : found) {
        EXPECT_EQ(rise[0], glm::vec3(0.0F));
        EXPECT_EQ(rise[1], glm::vec3(0.0F));
    }
}

INSTANTIATE_TEST_SUITE_P(Widths, SmoothTerminator, testing::Values(1, 8, 16));

}  // namespace
}  // namespace wavelobe::test
