// Traces rays through scenes of few triangles on the device.
#pragma once

#include <cstring>

#include <gtest/gtest.h>

#include "accel/few_triangles.h"
#include "support/traversal_probe.h"

namespace wavelobe::test {

// Eight arrays of `count`, a multiple of 16: origins, directions, limits and what is left.
inline std::vector<float> packed_rays(const std::vector<TestRay>& rays, std::size_t count) {
    std::vector<float> packed(8 * count, 0.0F);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            packed[k * count + i] = rays[i].origin[static_cast<glm::length_t>(k)];
            packed[(3 + k) * count + i] = rays[i].direction[static_cast<glm::length_t>(k)];
        }
        packed[6 * count + i] = rays[i].limit;
        std::memcpy(&packed[7 * count + i], &rays[i].from, sizeof(float));
    }
    return packed;
}

struct SmallScene {
    explicit SmallScene(const Triangles& t)
        : triangles(t), bvh(build_bvh(triangles, {}, BvhQuality::split, 1)), few(find_few_triangles(bvh)) {
        EXPECT_EQ(few.triangles.size(), triangles.size());
    }
    Triangles triangles;
    Bvh bvh;
    FewTriangleSet few;
};

class FewProbe {
public:
    explicit FewProbe(int lanes = 16, bool portable = false)
        : probe_(source, {.lanes = lanes, .defines = portable ? "-DWAVELOBE_PORTABLE" : ""}) {}

    std::vector<TestHit> trace(const FewTriangleSet& few, const std::vector<TestRay>& rays) {
        const std::size_t count = (rays.size() + 15) / 16 * 16;
        const std::vector<float> packed = packed_rays(rays, count);
        std::vector<float> hits(5 * count);
        const auto ray_count = static_cast<cl_uint>(count);
        const std::vector<FewSummary> summary{few.summary};
        probe_.run("trace", count / 16, few.vertices, few.triangles, summary, few.facets, few.corners, few.numbers, packed, ray_count, hits);
        std::vector<TestHit> out(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            out[i].t = hits[i];
            out[i].u = hits[count + i];
            out[i].v = hits[2 * count + i];
            std::memcpy(&out[i].slot, &hits[3 * count + i], sizeof(float));
            std::memcpy(&out[i].any, &hits[4 * count + i], sizeof(float));
        }
        return out;
    }

private:
    // One work-item a group of 16 rays, at any width.
    static constexpr const char* source = R"(
#include "shapes/few_facets.h"

#define RAY(k) load(rays + (size_t)(k) * count + i)

kernel void trace(global const float *vertices, global const struct FewTriangle *triangles,
                  global const struct FewSummary *summary, global const struct FewFacet *facets, global const float *corners,
                  global const uint *numbers, global const float *rays, uint count, global float *hits) {
    FewTriangles geometry = {vertices, triangles, summary, facets, corners, numbers};
    uint first = (uint)get_global_id(0) * 16u;
    for (uint i = first; i < first + 16u; i += LANES) {
        Vec3 origin = vec3(RAY(0), RAY(1), RAY(2)), direction = vec3(RAY(3), RAY(4), RAY(5));
        LaneHit hit = closest_of_few(geometry, origin, direction, RAY(6), as_UInt(RAY(7)));
        Int any = any_of_few(geometry, origin, direction, RAY(6), as_UInt(RAY(7)), (UInt)HIT_NONE, TRUE_MASK);
        store(hits + i, hit.t);
        store(hits + count + i, hit.u);
        store(hits + 2 * count + i, hit.v);
        store(hits + 3 * count + i, as_Float(hit.slot));
        store(hits + 4 * count + i, as_Float(SELECT(any, (UInt)1u, (UInt)0u)));
    }
}
)";
    Probe probe_;
};

}  // namespace wavelobe::test
