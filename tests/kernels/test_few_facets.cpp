// Facets of small scenes: what they find is what the watertight test of all triangles finds, and they seldom have to ask it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "support/few_probe.h"
#include "support/ray_sets.h"

namespace wavelobe::test {
namespace {

const char* const source = R"(
#include "shapes/few_facets.h"

#define RAY(k) load(rays + (size_t)(k) * count + i)

// By facets and by triangles, closest and any hit; whether facets were sure of both.
kernel void trace_both(global const float *vertices, global const struct FewTriangle *triangles, global const struct FewSummary *summary,
                       global const struct FewFacet *facets, global const float *corners, global const uint *numbers,
                       global const float *rays, uint count, global float *out) {
    FewTriangles geometry = {vertices, triangles, summary, facets, corners, numbers};
    uint i = (uint)get_global_id(0) * LANES;
    Vec3 origin = vec3(RAY(0), RAY(1), RAY(2)), direction = vec3(RAY(3), RAY(4), RAY(5));
    LaneRay ray = lane_ray(geometry, origin, direction, as_UInt(RAY(7)));
    LaneHit by_facets = closest_triangle(geometry, &ray, RAY(6));
    NearestTriangle nearest = closest_of_all(geometry, &ray, RAY(6));
    LaneHit by_triangles = hit_of_triangle(geometry, &nearest, RAY(6));
    Int any = any_triangle(geometry, &ray, RAY(6), as_UInt(RAY(8)), TRUE_MASK);
    FacetRay facet_rays = facet_ray(geometry, &ray);
    NearestFacet found = nearest_facet(geometry, &ray, &facet_rays, RAY(6));
    const Float values[10] = {by_facets.t,        by_facets.u,    by_facets.v,    as_Float(by_facets.slot),
                              by_triangles.t,     by_triangles.u, by_triangles.v, as_Float(by_triangles.slot),
                              SELECT(any, ONE, ZERO), SELECT(doubts_that_matter(geometry, &facet_rays, &found), ONE, ZERO)};
    for (uint k = 0; k < 10; k++) store(out + (size_t)k * count + i, values[k]);
}

// Where rays meet the plane of the facet that they are aimed at.
kernel void meet_targets(global const float *vertices, global const struct FewTriangle *triangles, global const struct FewSummary *summary,
                         global const struct FewFacet *facets, global const float *corners, global const uint *numbers,
                         global const float *rays, uint count, global float *out) {
    FewTriangles geometry = {vertices, triangles, summary, facets, corners, numbers};
    uint i = (uint)get_global_id(0) * LANES;
    LaneRay ray = lane_ray(geometry, vec3(RAY(0), RAY(1), RAY(2)), vec3(RAY(3), RAY(4), RAY(5)), (UInt)HIT_NONE);
    FacetRay facet_rays = facet_ray(geometry, &ray);
    UInt facet = facet_of(geometry, as_UInt(RAY(8)));
    FacetPoint p = meet_plane(&facet_rays, facets_of_lanes(geometry, SELECT(facet == (UInt)FACET_NONE, (UInt)0u, facet)));
    store(out + i, p.t);
    store(out + count + i, p.inside);
    store(out + 2u * count + i, p.error);
}
)";

struct FacetRayInput {
    TestRay ray;
    std::uint32_t to = HIT_NONE;
};

struct BothHits {
    TestHit by_facets, by_triangles;
    bool unsure = false;
};

// `values` arrays of as many as there are rays, rounded up to whole groups.
std::vector<float> run_facets(const char* kernel, const FewTriangleSet& few, const std::vector<FacetRayInput>& rays, std::size_t values) {
    const std::size_t count = (rays.size() + 15) / 16 * 16;
    std::vector<TestRay> without_aim;
    for (const FacetRayInput& input : rays) without_aim.push_back(input.ray);
    std::vector<float> packed = packed_rays(without_aim, count), out(values * count);
    packed.resize(9 * count);
    for (std::size_t i = 0; i < rays.size(); ++i) std::memcpy(&packed[8 * count + i], &rays[i].to, sizeof(float));
    static Probe probe(source);
    const std::vector<FewSummary> summary{few.summary};
    const auto ray_count = static_cast<cl_uint>(count);
    probe.run(kernel, count / 16, few.vertices, few.triangles, summary, few.facets, few.corners, few.numbers, packed, ray_count, out);
    return out;
}

std::vector<BothHits> trace_both(const FewTriangleSet& few, const std::vector<FacetRayInput>& rays) {
    const std::vector<float> out = run_facets("trace_both", few, rays, 10);
    const std::size_t count = out.size() / 10;
    std::vector<BothHits> hits(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto hit = [&](std::size_t k) {
            TestHit h{out[k * count + i], out[(k + 1) * count + i], out[(k + 2) * count + i]};
            std::memcpy(&h.slot, &out[(k + 3) * count + i], sizeof(float));
            return h;
        };
        hits[i] = {hit(0), hit(4), out[9 * count + i] != 0.0F};
        hits[i].by_facets.any = out[8 * count + i] != 0.0F ? 1 : 0;
    }
    return hits;
}

// As paths make them: from points of triangles, away from either side.
std::vector<FacetRayInput> bounce_rays(const SmallScene& scene, std::size_t count, unsigned seed) {
    Generator random(seed);
    std::vector<FacetRayInput> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const auto number = static_cast<std::uint32_t>(i % scene.triangles.size());
        const TriangleVertices& t = scene.triangles[number];
        float a = uniform(random, 0.0F, 1.0F), b = uniform(random, 0.0F, 1.0F);
        if (a + b > 1.0F) a = 1.0F - a, b = 1.0F - b;
        rays.push_back({{t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]), uniform_direction(random), std::numeric_limits<float>::infinity(), number}});
    }
    return rays;
}

struct Place {
    const char* name;
    float scale;
    glm::vec3 offset;
};

void PrintTo(const Place& place, std::ostream* out) { *out << place.name; }

class Facets : public testing::TestWithParam<Place> {
protected:
    Facets() : scene(furnished_room(GetParam().scale, GetParam().offset, 0.05F)) {}
    SmallScene scene;
};

TEST_P(Facets, PairTheHalvesOfRectangles) {
    EXPECT_EQ(scene.few.summary.facet_count, 12U);
    EXPECT_EQ(scene.few.summary.parallelogram_count, 12U);
    std::vector<int> parts(12);
    for (const FewTriangle& t : scene.few.triangles) ++parts.at(t.facet);
    EXPECT_EQ(parts, std::vector<int>(12, 2));
}

struct Differences {
    std::size_t unsure = 0;
    std::size_t elsewhere = 0;  // another triangle is hit
};

// What facets and the watertight test find must be the same, but for rounding.
Differences compare_hits(const std::vector<BothHits>& hits, float scale) {
    Differences d;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const BothHits& h = hits[i];
        EXPECT_EQ(h.by_facets.slot == HIT_NONE, h.by_triangles.slot == HIT_NONE) << "ray " << i;
        EXPECT_EQ(h.by_facets.slot != HIT_NONE, h.by_facets.any != 0) << "ray " << i;
        if (h.unsure) ++d.unsure;
        if (h.by_facets.slot != h.by_triangles.slot) ++d.elsewhere;
        if (h.by_facets.slot == HIT_NONE) continue;
        // Surfaces that graze the ray: 128 roundings over a cosine of 0.01.
        EXPECT_NEAR(h.by_facets.t, h.by_triangles.t, 2e-4F * scale) << "ray " << i;
        if (h.by_facets.slot != h.by_triangles.slot) continue;
        EXPECT_NEAR(h.by_facets.u, h.by_triangles.u, 2e-4F) << "ray " << i;
        EXPECT_NEAR(h.by_facets.v, h.by_triangles.v, 2e-4F) << "ray " << i;
        if (testing::Test::HasFailure()) break;
    }
    return d;
}

TEST_P(Facets, FindWhatTheWatertightTestFinds) {
    const Differences d = compare_hits(trace_both(scene.few, bounce_rays(scene, 200000, 1)), GetParam().scale);
    EXPECT_LT(d.elsewhere, 20U) << "but on the line between the halves of a rectangle";
    EXPECT_LT(d.unsure, 400U);
    EXPECT_GT(d.unsure, 0U);
}

// Where a facet's own rounding decides: at the edges and corners that it shares with others.
TEST_P(Facets, AreNotSureAtTheirEdges) {
    Generator random(8);
    std::vector<FacetRayInput> rays = bounce_rays(scene, 200000, 9);
    for (FacetRayInput& input : rays) {
        const TriangleVertices& t = scene.triangles[random() % scene.triangles.size()];
        const std::size_t corner = random() % 3;
        const glm::vec3 target = t[corner] + (random() % 8 == 0 ? 0.0F : uniform(random, 0.0F, 1.0F)) * (t[(corner + 1) % 3] - t[corner]);
        const glm::vec3 way = target - input.ray.origin;
        if (way != glm::vec3(0.0F)) input.ray.direction = glm::normalize(way);
    }
    std::size_t unsure = 0;
    for (const BothHits& h : trace_both(scene.few, rays)) {
        ASSERT_EQ(h.by_facets.slot == HIT_NONE, h.by_triangles.slot == HIT_NONE);
        ASSERT_EQ(h.by_facets.slot != HIT_NONE, h.by_facets.any != 0);
        unsure += h.unsure ? 1 : 0;
    }
    EXPECT_GT(unsure, 10000U);
}

// One rectangle by the corner across from the diagonal of one of its halves, in double precision.
struct Rectangle {
    glm::dvec3 corner, e1, e2;
};

Rectangle rectangle_of(const Triangles& triangles, std::size_t number) {
    const TriangleVertices& t = triangles[number];
    const TriangleVertices& other = triangles[number ^ 1U];
    std::size_t k = 0;
    while (std::ranges::find(other, t[k]) != other.end()) ++k;
    const glm::dvec3 corner(t[k]);
    return {corner, glm::dvec3(t[(k + 1) % 3]) - corner, glm::dvec3(t[(k + 2) % 3]) - corner};
}

// Of rays that meet a facet, to its edges: distances, and how far inside they are, are off by less than is said of them.
TEST_P(Facets, KnowHowFarTheyMayBeOff) {
    Generator random(10);
    std::vector<FacetRayInput> rays = bounce_rays(scene, 200000, 11);
    for (FacetRayInput& input : rays) {
        const std::size_t number = random() % scene.triangles.size();
        const Rectangle r = rectangle_of(scene.triangles, number);
        const auto share = [&] { return std::clamp(static_cast<double>(uniform(random, -0.5F, 1.5F)), 1e-6, 1 - 1e-6); };
        const double a = share(), b = share();
        const glm::dvec3 way = r.corner + a * r.e1 + b * r.e2 - glm::dvec3(input.ray.origin);
        if (glm::length(way) > 0.0) input.ray.direction = glm::vec3(glm::normalize(way));
        input.to = static_cast<std::uint32_t>(number);
    }
    const std::vector<float> out = run_facets("meet_targets", scene.few, rays, 3);
    const std::size_t count = out.size() / 3;
    const double unit = static_cast<double>(scene.few.summary.per_length);
    double worst = 0.0;
    std::size_t met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Rectangle r = rectangle_of(scene.triangles, rays[i].to);
        const glm::dvec3 normal = glm::normalize(glm::cross(r.e1, r.e2)), o(rays[i].ray.origin), d(rays[i].ray.direction);
        const double approach = glm::dot(normal, d), t = glm::dot(normal, r.corner - o) / approach;
        const glm::dvec3 at = o + t * d - r.corner;
        const double wide = glm::length(r.e1), high = glm::length(r.e2), x = glm::dot(at, r.e1) / wide, y = glm::dot(at, r.e2) / high;
        const double inside = std::min({x, wide - x, y, high - y});
        if (std::abs(approach) < 1e-3 || inside < 0.0 || t < 0.0) continue;
        ++met;
        const auto error = static_cast<double>(out[2 * count + i]);
        worst = std::max({worst, std::abs(static_cast<double>(out[i]) - t * unit) / error, std::abs(static_cast<double>(out[count + i]) - inside * unit) / error});
    }
    EXPECT_GT(met, rays.size() / 2);
    EXPECT_LT(worst, 1.0);
    EXPECT_GT(worst, 1.0 / 128) << "not even one rounding was seen";
}

TEST_P(Facets, MayBeTrianglesLeftOver) {
    Triangles holed = scene.triangles;
    holed.erase(holed.begin() + 20);
    holed.erase(holed.begin() + 3);
    const SmallScene room(holed);
    EXPECT_EQ(room.few.summary.facet_count, 12U);
    EXPECT_EQ(room.few.summary.parallelogram_count, 10U);
    const std::vector<BothHits> hits = trace_both(room.few, bounce_rays(room, 200000, 2));
    EXPECT_LT(compare_hits(hits, GetParam().scale).elsewhere, 20U);
    EXPECT_TRUE(std::ranges::any_of(hits, [](const BothHits& h) { return h.by_facets.slot == HIT_NONE; }));
}

// A side of the block lies in the floor: rays that leave either meet the other or not by a rounding.
TEST_P(Facets, AskTheWatertightTestWhereTheyCoincide) {
    const SmallScene room(furnished_room(GetParam().scale, GetParam().offset, 0.0F));
    const Differences d = compare_hits(trace_both(room.few, bounce_rays(room, 200000, 3)), GetParam().scale);
    EXPECT_GT(d.unsure, 10000U);
}

// Seen from outside the floor and the side of the block in it are equally near: whichever is found will do.
TEST_P(Facets, NeedNotAskWhichOfTwoInOnePlaneIsNearer) {
    const SmallScene room(furnished_room(GetParam().scale, GetParam().offset, 0.0F));
    std::vector<std::uint32_t> planes;
    for (const FewFacet& facet : room.few.facets) planes.push_back(facet.plane);
    std::ranges::sort(planes);
    EXPECT_EQ(std::ranges::unique(planes).begin() - planes.begin(), 11);
    Generator random(7);
    std::vector<FacetRayInput> rays;
    for (int i = 0; i < 100000; ++i) {
        const glm::vec3 start(0.4F * uniform_in_cube(random, 1.0F).x, -2.0F, 0.4F * uniform_in_cube(random, 1.0F).z);
        const glm::vec3 way(uniform(random, -0.2F, 0.2F), 1.0F, uniform(random, -0.2F, 0.2F));
        rays.push_back({{start * GetParam().scale + GetParam().offset, glm::normalize(way)}});
    }
    std::size_t unsure = 0;
    for (const BothHits& h : trace_both(room.few, rays)) {
        ASSERT_NE(h.by_facets.slot, HIT_NONE);
        ASSERT_NEAR(h.by_facets.t, h.by_triangles.t, 1e-5F * GetParam().scale);
        unsure += h.unsure ? 1 : 0;
    }
    EXPECT_LT(unsure, 200U);
}

// Up to a point of a triangle, to the last bit or beyond it by some.
TEST_P(Facets, WhatARayIsAimedAtIsNotInItsWay) {
    Generator random(4);
    std::vector<FacetRayInput> rays = bounce_rays(scene, 100000, 5);
    std::vector<FacetRayInput> targets = bounce_rays(scene, 100000, 6);
    std::ranges::shuffle(targets, random);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        TestRay& ray = rays[i].ray;
        const glm::vec3 way = targets[i].ray.origin - ray.origin;
        ray.direction = glm::normalize(way);
        ray.limit = glm::length(way) * (1.0F + 1e-6F * static_cast<float>(i % 3));
        rays[i].to = targets[i].ray.from;
    }
    const std::vector<BothHits> hits = trace_both(scene.few, rays);
    std::size_t blocked = 0, differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        // Within a rectangle rays that leave one half may meet the other by a rounding.
        if (scene.few.numbers[rays[i].ray.from] == scene.few.numbers[rays[i].to]) continue;
        const glm::vec3 target = targets[i].ray.origin;
        const bool before = hits[i].by_triangles.t < 0.999F * glm::length(target - rays[i].ray.origin);
        blocked += before ? 1 : 0;
        differ += before != (hits[i].by_facets.any != 0) ? 1 : 0;
    }
    EXPECT_GT(blocked, rays.size() / 20);
    EXPECT_LT(blocked, rays.size() * 19 / 20);
    EXPECT_LT(differ, rays.size() / 1000) << "but what lies just before its target";
}

TEST(FacetsOf, TrianglesThatAreNoParallelogram) {
    const Triangles trapezoid{{glm::vec3{0, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {glm::vec3{0, 0, 0}, {1, 1, 0}, {0.5F, 1, 0}}};
    const Triangles bent{{glm::vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {glm::vec3{0, 0, 0}, {1, 1, 0}, {0, 1, 1e-4F}}};
    for (const Triangles& triangles : {trapezoid, bent}) {
        const SmallScene scene(triangles);
        EXPECT_EQ(scene.few.summary.facet_count, 2U);
        EXPECT_EQ(scene.few.summary.parallelogram_count, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Facets,
                         testing::Values(Place{"unit", 1.0F, {}}, Place{"tiny_scale", 1e-6F, {}}, Place{"huge_scale", 1e6F, {}}, Place{"aside", 1.0F, {3.0F, -5.0F, 2.0F}}),
                         [](const auto& place) { return place.param.name; });

}  // namespace
}  // namespace wavelobe::test
