// Scenes without a hierarchy: a group of rays against every triangle, beside the single-ray traversal of the same triangles.
#include <gtest/gtest.h>

#include "accel/few_triangles.h"
#include "support/ray_sets.h"

namespace wavelobe::test {
namespace {

constexpr const char* source = R"(
#include "shapes/few_triangles.h"

typedef struct { float t, u, v; uint slot, any; } TestHit;

INLINE Float ray_field(global const float *rays, UInt ray, uint field) { return gather(rays + field, ray * 7u); }

kernel void trace(global const float *vertices, uint vertex_count, global const struct FewTriangle *triangles,
                  uint triangle_count, global const float *rays, global TestHit *hits) {
    FewTriangles few = {vertices, triangles, vertex_count, triangle_count};
    UInt i = LANE_INDEX + (UInt)(uint)(get_global_id(0) * LANES);
    Vec3 origin = vec3(ray_field(rays, i, 0u), ray_field(rays, i, 1u), ray_field(rays, i, 2u));
    Vec3 direction = vec3(ray_field(rays, i, 3u), ray_field(rays, i, 4u), ray_field(rays, i, 5u));
    Float limit = ray_field(rays, i, 6u);
    LaneHit h = closest_of_few(few, origin, direction, limit);
    Int any = any_of_few(few, origin, direction, limit, TRUE_MASK);
    global float *out = (global float *)hits;
    const uint all = (1u << (LANES - 1)) * 2u - 1u;
    scatter(out, i * 5u, h.t, all);
    scatter(out + 1, i * 5u, h.u, all);
    scatter(out + 2, i * 5u, h.v, all);
    scatter(out + 3, i * 5u, as_Float(h.slot), all);
    scatter(out + 4, i * 5u, as_Float(SELECT(any, (UInt)1u, (UInt)0u)), all);
}
)";

Bvh hierarchy(const Triangles& triangles) { return build_bvh(triangles, {}, BvhQuality::best, 2); }

std::vector<TestHit> trace_few(const Bvh& bvh, std::vector<TestRay> rays, int lanes = 16) {
    const FewTriangleSet few = find_few_triangles(bvh);
    EXPECT_FALSE(few.triangles.empty());
    const std::size_t count = rays.size();
    rays.resize((count + 15) / 16 * 16, rays.back());
    std::vector<TestHit> hits(rays.size());
    const auto vertex_count = static_cast<cl_uint>(few.vertices.size() / 3);
    const auto triangle_count = static_cast<cl_uint>(few.triangles.size());
    const std::vector<TestRay>& input = rays;
    Probe(source, {.lanes = lanes, .defines = ""})
        .run("trace", rays.size() / static_cast<std::size_t>(lanes), few.vertices, vertex_count, few.triangles,
             triangle_count, input, hits);
    hits.resize(count);
    return hits;
}

// Whether a triangle is hit beyond doubt: not at an edge, and not so near that it may be the surface the ray starts from.
// The bound on a distance is up to four times larger after a rotation than after the shear of the reference.
bool certain(const TestRay& ray, const TestHit& hit, const Bvh& bvh, const Triangles& triangles) {
    if (hit.slot == HIT_NONE) return false;
    const ReferenceHit reference = reference_hit(ray, triangles[primitive_of(bvh, hit.slot)]);
    return reference.certain && reference.t > 2.0 * 4.0 * reference.t_error;
}

// Both traversals round in their own way: they may differ where a ray touches an edge or starts on a surface, and there only.
void expect_agreement(const Triangles& triangles, const std::vector<TestRay>& rays, double scale) {
    const Bvh bvh = hierarchy(triangles);
    const std::vector<TestHit> few = trace_few(bvh, rays);
    const std::vector<TestHit> single = TraversalProbe().trace(bvh, rays);
    std::size_t found = 0;
    std::size_t doubtful = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool same = (few[i].slot == HIT_NONE) == (single[i].slot == HIT_NONE) &&
                          (few[i].slot == HIT_NONE || std::abs(few[i].t - single[i].t) <= 1e-5 * (single[i].t + scale)) &&
                          few[i].any == single[i].any;
        found += few[i].slot != HIT_NONE ? 1 : 0;
        if (same) continue;
        ++doubtful;
        EXPECT_FALSE(certain(rays[i], few[i], bvh, triangles) && certain(rays[i], single[i], bvh, triangles))
            << "ray " << i << ": " << few[i].t << " in slot " << few[i].slot << ", not " << single[i].t << " in "
            << single[i].slot;
    }
    EXPECT_GT(found, rays.size() / 20) << "rays that hit nothing test nothing";
    EXPECT_LE(doubtful, rays.size() / 10000);
}

TEST(FewTriangles, AgreeWithTheHierarchy) {
    expect_agreement(triangle_soup(40, 1.0F, 1.0F, {}, 1), random_rays(100000, 1.0F, {}, 2), 1.0);
    expect_agreement(triangle_soup(40, 0.5F, 1e-6F, {}, 3), random_rays(100000, 1e-6F, {}, 4), 1e-6);
    expect_agreement(triangle_soup(40, 0.5F, 1e6F, {}, 5), random_rays(100000, 1e6F, {}, 6), 1e6);
}

TEST(FewTriangles, SameBitsAtEveryLaneWidth) {
    const Triangles triangles = triangle_soup(40, 1.0F, 1.0F, {}, 7);
    const Bvh bvh = hierarchy(triangles);
    const std::vector<TestRay> rays = random_rays(20000, 1.0F, {}, 8);
    const std::vector<TestHit> sixteen = trace_few(bvh, rays, 16);
    EXPECT_TRUE(trace_few(bvh, rays, 8) == sixteen);
    EXPECT_TRUE(trace_few(bvh, rays, 1) == sixteen);
}

void expect_nothing_escapes(const ClosedMesh& mesh, float inner_half, const glm::vec3& center) {
    const Bvh bvh = hierarchy(mesh.triangles());
    std::size_t escaped = 0;
    for (const TestHit& hit : trace_few(bvh, rays_from_inside(mesh, inner_half, center, 300000))) {
        escaped += hit.slot == HIT_NONE || hit.any == 0 ? 1 : 0;
    }
    EXPECT_EQ(escaped, 0U);
}

TEST(FewTriangles, NothingEscapesAClosedMesh) {
    expect_nothing_escapes(cube_mesh(2), 0.9F, {});
    expect_nothing_escapes(sphere_mesh(1, 1.0F, {}), 0.4F, {});
    expect_nothing_escapes(sphere_mesh(1, 1e-5F, {}), 4e-6F, {});
    expect_nothing_escapes(sphere_mesh(1, 3.0F, {1234.5F, -777.7F, 4321.1F}), 1.2F, {1234.5F, -777.7F, 4321.1F});
}

TEST(FewTriangles, RaysThatAreNotNumbersMiss) {
    const Bvh bvh = hierarchy(triangle_soup(40, 1.0F, 1.0F, {}, 9));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const TestHit& hit : trace_few(bvh, {{{nan, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {nan, 0, 1}}, {{0, 0, 0}, {0, 0, 1}, nan}})) {
        EXPECT_EQ(hit.slot, HIT_NONE);
        EXPECT_EQ(hit.any, 0U);
    }
}

TEST(FewTriangles, LargerScenesKeepTheirHierarchy) {
    EXPECT_TRUE(find_few_triangles(hierarchy(triangle_soup(FEW_TRIANGLES_MAX + 1, 0.1F, 1.0F, {}, 10))).triangles.empty());
    EXPECT_EQ(find_few_triangles(hierarchy(cube_mesh(1).triangles())).triangles.size(), 12U);
    EXPECT_EQ(find_few_triangles(hierarchy(cube_mesh(1).triangles())).vertices.size(), std::size_t{3} * 8);
}

}  // namespace
}  // namespace wavelobe::test
