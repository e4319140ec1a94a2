#include "our_kernels.h"

namespace wavelobe::benchmark {
namespace {

constexpr std::size_t rays_per_item = 512;  // as many as a block holds

const char* const source = R"(
#define HAS_ANALYTIC 0
#define BVH_STACK 512u
#define RAY(k) rays[(size_t)(k) * count + i]

#if HAS_FEW_TRIANGLES
#include "shapes/few_facets.h"
#define LANE_RAY(k) load(&RAY(k))
#define LOOP_STEP LANES
#define GEOMETRY FewTriangles geometry = {few_vertices, few_triangles, few_summary, few_facets, few_corners, few_numbers}
#define TRACE_RAYS                                                                                             \
    Vec3 origin = vec3(LANE_RAY(0), LANE_RAY(1), LANE_RAY(2)), along = vec3(LANE_RAY(3), LANE_RAY(4), LANE_RAY(5))
#else
#include "shapes/trace_groups.h"
#define LOOP_STEP LANES
#define GEOMETRY Geometry geometry = {nodes, blocks}
#define LANE_RAY(k) load(&RAY(k))
#define TRACE_RAYS                                                                                             \
    RayGroup group;                                                                                            \
    *(Float *)group.ox.value = LANE_RAY(0), *(Float *)group.oy.value = LANE_RAY(1);                            \
    *(Float *)group.oz.value = LANE_RAY(2), *(Float *)group.dx.value = LANE_RAY(3);                            \
    *(Float *)group.dy.value = LANE_RAY(4), *(Float *)group.dz.value = LANE_RAY(5);                            \
    *(Float *)group.limit.value = LANE_RAY(6), *(UInt *)group.from = as_UInt(LANE_RAY(7))
#endif

#define PARAMETERS                                                                                             \
    global const uchar *nodes, global const uchar *blocks, global const float *few_vertices,                   \
        global const struct FewTriangle *few_triangles, global const struct FewSummary *few_summary,           \
        global const struct FewFacet *few_facets, global const float *few_corners, global const uint *few_numbers, \
        global const float *rays, uint count, global float *hits
#define FOR_RAYS                                                                                               \
    GEOMETRY;                                                                                                  \
    uint first = (uint)get_global_id(0) * 512u, last = min(first + 512u, count);                               \
    for (uint i = first; i < last; i += LOOP_STEP)

kernel void closest_hits(PARAMETERS) {
    FOR_RAYS {
        TRACE_RAYS;
#if HAS_FEW_TRIANGLES
        LaneHit hit = closest_of_few(geometry, origin, along, LANE_RAY(6), as_UInt(LANE_RAY(7)));
        store(hits + i, hit.t);
        store(hits + count + i, as_Float(hit.slot));
#else
        GroupHit hit;
        trace_closest_group(geometry, &group, lane_bits(TRUE_MASK), &hit);
        store(hits + i, LANES_OF(hit.t));
        store(hits + count + i, as_Float(*(const UInt *)hit.slot));
#endif
    }
}

kernel void any_hits(PARAMETERS) {
    FOR_RAYS {
        TRACE_RAYS;
#if HAS_FEW_TRIANGLES
        Int blocked = any_of_few(geometry, origin, along, LANE_RAY(6), as_UInt(LANE_RAY(7)), (UInt)HIT_NONE, TRUE_MASK);
        store(hits + i, SELECT(blocked, (Float)-INFINITY, LANE_RAY(6)));
#else
        uint blocked = trace_any_group(geometry, &group, lane_bits(TRUE_MASK));
        store(hits + i, SELECT(mask_of_bits(blocked), (Float)-INFINITY, LANE_RAY(6)));
#endif
    }
}
)";

void set_mesh(Kernel& kernel, const MeshBuffers& mesh) {
    kernel.set(0, mesh.nodes.memory());
    kernel.set(1, mesh.blocks.memory());
    kernel.set(2, mesh.few_vertices.memory());
    kernel.set(3, mesh.few_triangles.memory());
    kernel.set(4, mesh.few_summary.memory());
    kernel.set(5, mesh.few_facets.memory());
    kernel.set(6, mesh.few_corners.memory());
    kernel.set(7, mesh.few_numbers.memory());
}

}  // namespace

OurKernels::OurKernels(const Device& device, const MeshBuffers& mesh, const std::string& defines)
    : device_(device),
      program_(device, source, "traversal_benchmark.cl",
               "-DLANES=16 -DHAS_FEW_TRIANGLES=" + std::to_string(mesh.few) + " -DWALKS=" + std::to_string(mesh.walks) + "u " + defines),
      closest_(program_, "closest_hits"),
      any_(program_, "any_hits") {
    set_mesh(closest_, mesh);
    set_mesh(any_, mesh);
}

double OurKernels::trace(bool any_hit, std::size_t count, const Buffer& rays, const Buffer& hits) {
    Kernel& kernel = any_hit ? any_ : closest_;
    kernel.set(8, rays.memory());
    kernel.set(9, static_cast<cl_uint>(count));
    kernel.set(10, hits.memory());
    const ClEvent event = kernel.launch(device_, (count + rays_per_item - 1) / rays_per_item);
    device_.finish();
    return event_seconds(event);
}

}  // namespace wavelobe::benchmark
