// Traces rays on the device, and what their hits may be according to double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "support/probe.h"
#include "support/triangle_meshes.h"

namespace wavelobe::test {

struct TestRay {
    glm::vec3 origin;
    glm::vec3 direction;
    float limit = std::numeric_limits<float>::infinity();
    std::uint32_t from = HIT_NONE;  // what it leaves
};

struct TestHit {
    float t = 0.0F;
    float u = 0.0F;
    float v = 0.0F;
    std::uint32_t slot = HIT_NONE;  // block * 8 + lane
    std::uint32_t any = 0;          // what the any-hit traversal says of the same ray

    bool operator==(const TestHit&) const = default;
};

class TraversalProbe {
public:
    // With `groups`, rays go through the hierarchy in groups of as many as there are lanes, in their order; what does not agree of
    // them as so many `walks` in turn.
    explicit TraversalProbe(bool portable = false, bool groups = false, int lanes = 16, int walks = 1)
        : probe_(source, {.lanes = lanes,
                          .defines = std::string(portable ? "-DWAVELOBE_PORTABLE " : "") + (groups ? "-DGROUPS=1" : "-DGROUPS=0") +
                                     " -DWALKS=" + std::to_string(walks) + "u"}) {}

    std::vector<TestHit> trace(const Bvh& bvh, const std::vector<TestRay>& rays) {
        std::vector<TestHit> hits(rays.size());
        const std::vector<TriangleBlock> blocks = bvh.blocks.empty() ? std::vector<TriangleBlock>(1) : bvh.blocks;
        const auto count = static_cast<cl_uint>(rays.size());
        probe_.run("trace", (rays.size() + rays_per_item - 1) / rays_per_item, bvh.nodes, blocks, rays, count, hits);
        return hits;
    }

private:
    static constexpr std::size_t rays_per_item = 256;
    static constexpr const char* source = R"(
#define HAS_ANALYTIC 0
#define BVH_STACK 512u
#include "shapes/trace_groups.h"

typedef struct { float t, u, v; uint slot, any; } TestHit;

#if GROUPS
void trace_group(Geometry geometry, global const float *rays, uint first, uint count, global TestHit *hits) {
    RayGroup group;
    for (uint k = 0; k < LANES; k++) {
        global const float *p = rays + (size_t)min(first + k, count - 1u) * 8u;
        group.ox.value[k] = p[0], group.oy.value[k] = p[1], group.oz.value[k] = p[2];
        group.dx.value[k] = p[3], group.dy.value[k] = p[4], group.dz.value[k] = p[5];
        group.limit.value[k] = p[6], group.from[k] = as_uint(p[7]);
    }
    uint live = lane_bits(lanes_below(first, count));
    GroupHit hit;
    trace_closest_group(geometry, &group, live, &hit);
    uint any = trace_any_group(geometry, &group, live);
    for (uint k = 0; k < min(LANES + 0u, count - first); k++) {
        TestHit out = {hit.t.value[k], hit.u.value[k], hit.v.value[k], hit.slot[k], any >> k & 1u};
        hits[first + k] = out;
    }
}
#endif

kernel void trace(global const uchar *nodes, global const uchar *blocks, global const float *rays, uint count,
                  global TestHit *hits) {
    Geometry geometry = {nodes, blocks};
    uint first = (uint)get_global_id(0) * 256u;
#if GROUPS
    for (uint i = first; i < min(first + 256u, count); i += LANES) trace_group(geometry, rays, i, count, hits);
#else
    for (uint i = first; i < min(first + 256u, count); i++) {
        global const float *p = rays + (size_t)i * 8u;
        Ray ray = {p[0], p[1], p[2], p[3], p[4], p[5], p[6], as_uint(p[7])};
        Hit h = trace_closest(geometry, &ray);
        TestHit out = {h.t, h.u, h.v, h.primitive, trace_any(geometry, &ray)};
        hits[i] = out;
    }
#endif
}
)";
    Probe probe_;
};

// ---- reference ------------------------------------------------------------------------------------------

// A ray against a triangle in double, with bounds on what the float tests may be off by. Their inputs are floats, so
// that double itself is as good as exact. The bounds follow Pharr, Jakob, Humphreys, "Physically Based Rendering",
// "Managing Rounding Error": relative gamma(n) = n 2^-24 for n roundings, on the largest magnitudes of the coordinates
// around the ray.
struct ReferenceHit {
    bool certain = false;   // inside beyond doubt
    bool possible = false;  // inside or within rounding of an edge
    double t = 0.0;
    double t_error = 0.0;
};

inline double gamma_bound(int n) { return n * 0x1p-24 / (1.0 - n * 0x1p-24); }

// How the coordinates around the ray come about.
enum class Projection {
    shear,    // kernels/shapes/triangle_block.h
    rotation  // kernels/shapes/few_triangles.h
};

// Corners with the ray as the z axis, and bounds on the errors of their coordinates.
struct ProjectedTriangle {
    glm::dvec3 p[3];
    glm::dvec3 most{0.0};
    glm::dvec3 error{0.0};
};

inline ProjectedTriangle project(const TestRay& ray, const TriangleVertices& triangle, Projection projection) {
    const glm::dvec3 d{ray.direction};
    const glm::dvec3 size = glm::abs(d);
    const glm::length_t kz = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
    const glm::length_t kx = (kz + 1) % 3;
    const glm::length_t ky = (kz + 2) % 3;
    // As frame_of_normal of kernels/core/vector.h.
    const double sign = d.z < 0.0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + d.z);
    const glm::dvec3 s{1.0 + sign * d.x * d.x * a, sign * d.x * d.y * a, -sign * d.x};
    const glm::dvec3 t{d.x * d.y * a, sign + d.y * d.y * a, -d.y};
    ProjectedTriangle out;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 q = glm::dvec3(triangle[i]) - glm::dvec3(ray.origin);
        out.p[i] = projection == Projection::shear
                       ? glm::dvec3{q[kx] - d[kx] / d[kz] * q[kz], q[ky] - d[ky] / d[kz] * q[kz], q[kz] / d[kz]}
                       : glm::dvec3{glm::dot(q, s), glm::dot(q, t), glm::dot(q, d)};
        out.most = glm::max(out.most, glm::abs(out.p[i]));
    }
    if (projection == Projection::shear) {
        out.error = gamma_bound(5) * glm::dvec3{out.most.x + out.most.z, out.most.y + out.most.z, out.most.z};
    } else {
        // A subtraction, four roundings of the frame, and a product of three terms, on vectors of at most this length.
        out.error = glm::dvec3(std::sqrt(3.0) * gamma_bound(9) * (out.most.x + out.most.y + out.most.z));
    }
    return out;
}

inline ReferenceHit reference_hit(const TestRay& ray, const TriangleVertices& triangle, Projection projection) {
    const ProjectedTriangle v = project(ray, triangle, projection);
    const auto area = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.y - a.y * b.x; };
    const glm::dvec3 w{area(v.p[2], v.p[1]), area(v.p[0], v.p[2]), area(v.p[1], v.p[0])};
    const double det = w.x + w.y + w.z;
    const double dw = 2.0 * (gamma_bound(2) * v.most.x * v.most.y + v.error.y * v.most.x + v.error.x * v.most.y);
    const double w_most = std::max({std::abs(w.x), std::abs(w.y), std::abs(w.z)});
    const double least = std::min({w.x, w.y, w.z});
    const double largest = std::max({w.x, w.y, w.z});

    ReferenceHit hit;
    hit.possible = least >= -dw || largest <= dw;
    // The sum of three areas is off by three times their error and its own roundings.
    if (std::abs(det) <= 3.0 * dw + gamma_bound(3) * w_most) return hit;
    hit.t = (w.x * v.p[0].z + w.y * v.p[1].z + w.z * v.p[2].z) / det;
    hit.t_error =
        3.0 * (gamma_bound(4) * w_most * v.most.z + dw * v.most.z + v.error.z * w_most) / (std::abs(det) - 3.0 * dw);
    hit.certain = (least > dw || largest < -dw) && hit.t > 2.0 * hit.t_error;
    return hit;
}

inline std::uint32_t primitive_of(const Bvh& bvh, std::uint32_t slot) {
    return bvh.blocks[slot / 8].primitive[slot % 8];
}

// Empty if the hit is one that the ray may have; otherwise what is wrong with it.
inline std::string fault_of_hit(const TestRay& ray, const TestHit& hit, const Bvh& bvh, const Triangles& triangles,
                                Projection projection = Projection::shear) {
    const bool found = hit.slot != HIT_NONE;
    if (!found && hit.t != ray.limit) return "a miss leaves t at the limit";
    double found_error = 0.0;
    if (found) {
        const ReferenceHit own = reference_hit(ray, triangles[primitive_of(bvh, hit.slot)], projection);
        if (!own.possible) return "the ray passes beside the triangle it is said to hit";
        // A triangle seen edge-on (det lost in rounding) has no distance to compare with.
        if (own.t_error > 0.0 && std::abs(hit.t - own.t) > own.t_error) return "distance beyond its error bound";
        if (!(hit.t > 0.0F && hit.t < ray.limit)) return "hit outside (0, limit)";
        if (hit.any == 0) return "the any-hit traversal misses it";
        found_error = own.t_error;
    }
    for (const TriangleVertices& triangle : triangles) {
        const ReferenceHit other = reference_hit(ray, triangle, projection);
        if (!other.certain || other.t + other.t_error >= static_cast<double>(ray.limit)) continue;
        if (hit.any == 0) return "any-hit misses a triangle";
        if (!found) return "a triangle in the way is missed";
        if (other.t + other.t_error < static_cast<double>(hit.t) - found_error) return "a nearer triangle is missed";
    }
    return {};
}

}  // namespace wavelobe::test
