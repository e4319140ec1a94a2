// Spheres, disks and cylinders against the same surfaces in extended precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "support/analytic_rays.h"
#include "support/probe.h"

namespace wavelobe::test {
namespace {

constexpr Real half_ulp = 0x1p-24L;

const char* const source = R"(
#include "shapes/analytic_geometry.h"

// Rays one at a time: origin, direction, limit in seven arrays of n.
kernel void intersect(global const struct Analytic *shapes, global const uint *shape, global const float *rays, uint n,
                      global float *t) {
    size_t i = get_global_id(0);
    Ray r = {rays[i], rays[i + n], rays[i + 2 * n], rays[i + 3 * n], rays[i + 4 * n], rays[i + 5 * n], rays[i + 6 * n], HIT_NONE};
    t[i] = intersect_analytic(shapes + shape[i], &r, 0.0f, r.limit);
}

INLINE void store3(global float *p, uint n, Vec3 v) {
    store(p, v.x);
    store(p + n, v.y);
    store(p + 2 * n, v.z);
}

INLINE Vec3 load3(global const float *p, uint n) { return vec3(load(p), load(p + n), load(p + 2 * n)); }

// The surface at LANES hits, and the origin of a ray that leaves it on the side of `leave`.
kernel void surface(global const struct Analytic *shapes, global const uint *shape, global const float *rays, uint n,
                    global const float *t, global const float *leave, global float *out) {
    size_t i = get_global_id(0) * LANES;
    UInt index = as_UInt(load((global const float *)shape + i));
    AnalyticHit h = analytic_hit(shapes, index, load3(rays + i, n), load3(rays + i + 3 * n, n), load(t + i));
    store3(out + i, n, h.position);
    store3(out + i + 3 * n, n, h.error);
    store3(out + i + 6 * n, n, h.normal);
    store3(out + i + 9 * n, n, h.dp_du);
    store(out + i + 12 * n, h.u);
    store(out + i + 13 * n, h.v);
    store3(out + i + 14 * n, n, offset_ray_origin(h.position, h.error, h.normal, load3(leave + i, n)));
}
)";
constexpr std::size_t surface_fields = 17;

std::vector<float> intersect(const Rays& rays, const std::vector<float>& limit) {
    static Probe probe(source, {.lanes = 1, .defines = {}});
    std::vector<float> t(rays.size());
    const std::vector<float> packed = rays.packed(limit);
    const auto n = static_cast<cl_uint>(rays.size());
    probe.run("intersect", rays.size(), rays.shapes, rays.shape, packed, n, t);
    return t;
}

std::vector<float> intersect(const Rays& rays) {
    return intersect(rays, std::vector<float>(rays.size(), std::numeric_limits<float>::infinity()));
}

std::vector<float> surface(int lanes, const Rays& rays, const std::vector<float>& t, const std::vector<float>& leave) {
    Probe probe(source, {.lanes = lanes, .defines = {}});
    std::vector<float> out(surface_fields * rays.size());
    const std::vector<float> packed = rays.packed(t);
    const auto n = static_cast<cl_uint>(rays.size());
    probe.run("surface", rays.size() / static_cast<std::size_t>(lanes), rays.shapes, rays.shape, packed, n, t, leave, out);
    return out;
}

class AnalyticShapes : public testing::TestWithParam<Uint32> {};

constexpr std::size_t ray_count = 1 << 17;

// The first crossing ahead is found, to the last bit but one, wherever extended precision says clearly that it is there;
// none is found where it clearly is not.
TEST_P(AnalyticShapes, RayTestFindsTheFirstHit) {
    const Rays rays = random_rays(GetParam(), ray_count, 1);
    const std::vector<float> found = intersect(rays);
    std::size_t hits = 0;
    std::size_t unclear = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Real3 o = real3(rays.origin[i]);
        const Real3 d = real3(rays.direction[i]);
        // Decisions closer to their border than double precision can tell for this distance are not judged.
        const Analytic& record = rays.shapes[rays.shape[i]];
        const AnalyticSurface surface(record);
        const Real3 from_shape = surface.local(o);
        const Real doubt = 0x1p-48L * (1.0L + glm::dot(from_shape, from_shape));
        Real expected = std::numeric_limits<Real>::infinity();
        bool clear = true;
        for (const auto& crossing : surface.crossings(o, d)) {
            if (std::abs(crossing.margin) < doubt) clear = false;
            if (crossing.margin > 0.0L && crossing.t > 0.0L) expected = std::min(expected, crossing.t);
        }
        if (!clear) {
            ++unclear;
            continue;
        }
        if (!std::isfinite(expected)) {
            ASSERT_TRUE(std::isinf(found[i])) << "ray " << i << " hits nothing, found " << found[i];
            continue;
        }
        ++hits;
        // A grazing root takes the square root of its doubt.
        const Real slack = 2.0L * half_ulp * expected + doubt * expected;
        ASSERT_NEAR(static_cast<double>(found[i]), static_cast<double>(expected), static_cast<double>(slack)) << "ray " << i;
    }
    EXPECT_GT(hits, ray_count / 2);
    EXPECT_LT(unclear, ray_count / 1000);
}

TEST_P(AnalyticShapes, RayTestKeepsWithinItsLimit) {
    const Rays rays = random_rays(GetParam(), 4096, 2);
    const std::vector<float> found = intersect(rays);
    const std::vector<float> excluded = intersect(rays, found);
    std::vector<float> beyond = found;
    for (float& t : beyond) t = std::nextafter(t, std::numeric_limits<float>::infinity());
    const std::vector<float> included = intersect(rays, beyond);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_TRUE(std::isinf(excluded[i])) << "ray " << i << ": a hit at the limit is none";
        EXPECT_EQ(included[i], found[i]) << "ray " << i;
    }
}

// Rays that hit, where, and a direction in which to go on.
struct Hits {
    Rays rays;
    std::vector<float> t, leave;
    std::vector<float> out;  // of the kernel

    std::size_t size() const { return t.size(); }
    glm::vec3 vector(std::size_t field, std::size_t i) const {
        const std::size_t n = size();
        return {out[field * n + i], out[(field + 1) * n + i], out[(field + 2) * n + i]};
    }
    glm::vec3 position(std::size_t i) const { return vector(0, i); }
    glm::vec3 error(std::size_t i) const { return vector(3, i); }
    glm::vec3 normal(std::size_t i) const { return vector(6, i); }
    glm::vec3 tangent(std::size_t i) const { return vector(9, i); }
    glm::vec2 uv(std::size_t i) const { return {out[12 * size() + i], out[13 * size() + i]}; }
    glm::vec3 origin(std::size_t i) const { return vector(14, i); }
    glm::vec3 leaving(std::size_t i) const { return {leave[i], leave[i + size()], leave[i + 2 * size()]}; }
    AnalyticSurface shape(std::size_t i) const { return AnalyticSurface(rays.shapes[rays.shape[i]]); }
};

Hits random_hits(Uint32 kind) {
    Hits hits;
    const Rays rays = random_rays(kind, ray_count, 3);
    const std::vector<float> t = intersect(rays);
    hits.rays.shapes = rays.shapes;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (std::isinf(t[i])) continue;
        hits.t.push_back(t[i]);
        hits.rays.shape.push_back(rays.shape[i]);
        hits.rays.origin.push_back(rays.origin[i]);
        hits.rays.direction.push_back(rays.direction[i]);
    }
    const std::size_t n = hits.size() / 16 * 16;
    hits.t.resize(n);
    hits.rays.shape.resize(n);
    hits.rays.origin.resize(n);
    hits.rays.direction.resize(n);
    Random random(4);
    hits.leave.resize(3 * n);
    for (std::size_t i = 0; i < n; ++i) {
        const Real3 p = real3(hits.rays.origin[i]) + real3(hits.rays.direction[i]) * static_cast<Real>(hits.t[i]);
        const glm::dvec3 normal(hits.shape(i).normal(p));
        const glm::dvec3 flat = glm::normalize(glm::cross(normal, random.direction()));
        const double slope = random.log_uniform(1e-5, 1e2) * (i % 2 == 0 ? 1.0 : -1.0);
        const glm::vec3 leave(glm::normalize(flat + slope * normal));
        for (int k = 0; k < 3; ++k) hits.leave[i + static_cast<std::size_t>(k) * n] = leave[k];
    }
    hits.out = surface(16, hits.rays, hits.t, hits.leave);
    return hits;
}

TEST_P(AnalyticShapes, HitLiesOnTheSurfaceWithinItsErrorBound) {
    const Hits hits = random_hits(GetParam());
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const AnalyticSurface shape = hits.shape(i);
        const Real3 p = real3(hits.position(i));
        Real3 normal;
        const Real distance = std::abs(shape.distance(p, normal));
        const Real bound = glm::dot(glm::abs(normal), real3(hits.error(i)));
        ASSERT_LE(distance, bound) << "hit " << i;
        // Not so wide that light leaks: as many roundings of the numbers it comes from as it counts, and no more.
        ASSERT_LE(bound, 9.0L * half_ulp * shape.magnitude(p) / shape.steepness(p)) << "hit " << i;
        // It is the point of the ray.
        const Real3 o = real3(hits.rays.origin[i]);
        const Real3 d = real3(hits.rays.direction[i]);
        const Real t = hits.t[i];
        const Real reach = glm::length(o) + t + glm::length(p);
        ASSERT_LE(glm::length(o + d * t - p), 8.0L * half_ulp * reach) << "hit " << i;
    }
}

TEST_P(AnalyticShapes, HitHasNormalTangentAndTextureCoordinates) {
    const Hits hits = random_hits(GetParam());
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const AnalyticSurface shape = hits.shape(i);
        const Real3 p = real3(hits.position(i));
        const Real3 normal = real3(hits.normal(i));
        const Real3 tangent = real3(hits.tangent(i));
        // That of the point on the unit shape, and of a unit vector.
        const Real rounding = 8.0L * half_ulp * (1.0L + shape.magnitude(p));
        ASSERT_LE(glm::length(normal - shape.normal(p)), rounding) << "hit " << i;
        // The tangent is turned by the normal's rounding and no more.
        ASSERT_NEAR(static_cast<double>(glm::dot(tangent, normal) / glm::length(tangent)), 0.0, 2e-6) << "hit " << i;

        const glm::vec<2, Real> uv = shape.uv(p);
        const Real3 local = shape.local(p);
        const Real radial = std::sqrt(local.x * local.x + local.y * local.y);
        const bool disk = GetParam() == ANALYTIC_DISK;
        const Real azimuth = disk ? uv.y : uv.x;
        const Real other = disk ? uv.x : uv.y;
        const Real found_azimuth = disk ? hits.uv(i).y : hits.uv(i).x;
        const Real found_other = disk ? hits.uv(i).x : hits.uv(i).y;
        // Azimuths 0 and 1 are one.
        const Real turn = std::abs(azimuth - found_azimuth);
        ASSERT_LE(std::min(turn, 1.0L - turn), rounding / radial) << "hit " << i;
        ASSERT_LE(std::abs(other - found_other), rounding) << "hit " << i;
    }
}

// No shape meets a ray that leaves it outwards again; one that goes inwards finds the far side, never the near one.
TEST_P(AnalyticShapes, RayThatLeavesDoesNotHitWhereItStarts) {
    const Hits hits = random_hits(GetParam());
    Rays rays;
    rays.shapes = hits.rays.shapes;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        rays.shape.push_back(hits.rays.shape[i]);
        rays.origin.push_back(hits.origin(i));
        rays.direction.push_back(hits.leaving(i));
    }
    const std::vector<float> t = intersect(rays);
    std::size_t inward = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Real3 outward;
        hits.shape(i).distance(real3(hits.position(i)), outward);
        const bool convex = GetParam() == ANALYTIC_DISK || glm::dot(outward, real3(rays.direction[i])) > 0.0L;
        if (convex) {
            ASSERT_TRUE(std::isinf(t[i])) << "hit " << i << " meets its own surface at " << t[i];
            continue;
        }
        ++inward;
        const auto crossings = hits.shape(i).crossings(real3(rays.origin[i]), real3(rays.direction[i]));
        ASSERT_EQ(crossings.size(), 2U) << "hit " << i;
        ASSERT_LT(crossings[0].t, 0.0L) << "hit " << i << " starts outside";
        if (GetParam() == ANALYTIC_CYLINDER && std::isinf(t[i])) continue;  // out of an open end
        ASSERT_NEAR(static_cast<double>(t[i] / crossings[1].t), 1.0, 1e-6) << "hit " << i;
    }
    EXPECT_GE(inward, GetParam() == ANALYTIC_DISK ? 0U : ray_count / 4);
}

TEST_P(AnalyticShapes, SameBitsAtEveryWidth) {
    const Hits hits = random_hits(GetParam());
    for (int lanes : {1, 8}) {
        const std::vector<float> out = surface(lanes, hits.rays, hits.t, hits.leave);
        for (std::size_t field = 0; field < surface_fields; ++field) {
            const std::size_t first = field * hits.size();
            EXPECT_EQ(std::memcmp(&out[first], &hits.out[first], hits.size() * sizeof(float)), 0)
                << "field " << field << " at a width of " << lanes;
        }
    }
}

std::string shape_name(const testing::TestParamInfo<Uint32>& shape) {
    const char* const names[] = {"sphere", "disk", "cylinder"};
    return names[shape.param];
}

INSTANTIATE_TEST_SUITE_P(All, AnalyticShapes, testing::Values(ANALYTIC_SPHERE, ANALYTIC_DISK, ANALYTIC_CYLINDER), shape_name);

}  // namespace
}  // namespace wavelobe::test
