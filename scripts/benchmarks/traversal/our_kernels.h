// Our traversal kernels on the rays of the benchmark.
#pragma once

#include "accel/bvh.h"
#include "accel/few_triangles.h"
#include "cl/program.h"
#include "rays.h"

namespace wavelobe::benchmark {

// A mesh as the kernels read it.
struct MeshBuffers {
    MeshBuffers(const Device& device, const Bvh& bvh, const FewTriangleSet& set)
        : few(!set.triangles.empty()),
          walks(walks_in_turn(bvh)),
          nodes(Buffer::of<BvhNode>(device, bvh.nodes)),
          blocks(Buffer::of<TriangleBlock>(device, bvh.blocks)),
          few_vertices(Buffer::of<float>(device, few ? set.vertices : std::vector<float>(3))),
          few_triangles(Buffer::of<FewTriangle>(device, few ? set.triangles : std::vector<FewTriangle>(1))),
          few_summary(Buffer::of<FewSummary>(device, std::vector<FewSummary>{set.summary})),
          few_facets(Buffer::of<FewFacet>(device, few ? set.facets : std::vector<FewFacet>(1))),
          few_corners(Buffer::of<float>(device, few ? set.corners : std::vector<float>(1))),
          few_numbers(Buffer::of<std::uint32_t>(device, few ? set.numbers : std::vector<std::uint32_t>(1))) {}

    bool few;
    int walks;
    Buffer nodes, blocks, few_vertices, few_triangles, few_summary, few_facets, few_corners, few_numbers;
};

class OurKernels {
public:
    // `defines`: such as -DWAVELOBE_PORTABLE. Meshes of few triangles are traced without the hierarchy, as in a render.
    OurKernels(const Device& device, const MeshBuffers& mesh, const std::string& defines);

    // Seconds on the device. `rays` holds a RaySet's values; `hits` gets distance and primitive slot of each ray.
    double trace(bool any_hit, std::size_t count, const Buffer& rays, const Buffer& hits);

private:
    const Device& device_;
    Program program_;
    Kernel closest_;
    Kernel any_;
};

}  // namespace wavelobe::benchmark
