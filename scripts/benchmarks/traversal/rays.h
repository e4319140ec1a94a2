// The rays of the traversal benchmark, and what Embree makes of them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "meshes.h"

namespace wavelobe::benchmark {

// A structure of arrays: origin, direction, limit, and the triangle the ray leaves.
struct RaySet {
    static constexpr std::size_t fields = 8;

    RaySet(std::string name_in, bool any_hit_in, std::size_t count_in)
        : name(std::move(name_in)), any_hit(any_hit_in), count(count_in), values(fields * count_in) {}

    float* field(std::size_t f) { return values.data() + f * count; }
    const float* field(std::size_t f) const { return values.data() + f * count; }
    void set(std::size_t i, const glm::vec3& origin, const glm::vec3& direction, float limit, std::uint32_t from);

    std::string name;
    bool any_hit;
    std::size_t count;
    std::vector<float> values;
};

// Embree's scenes of one mesh.
class EmbreeScene {
public:
    EmbreeScene(const BenchmarkMesh& mesh, bool robust, int threads);

    enum class Mode { single, eight, sixteen, stream };
    // Traces rays [first, last), both multiples of 64. `hits`: a distance each (of any-hit rays: -infinity or the limit).
    void trace(const RaySet& rays, std::size_t first, std::size_t last, Mode mode, bool coherent, float* hits,
               std::uint32_t* primitives) const;

private:
    struct ReleaseDevice {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    };
    struct ReleaseScene {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
};

// camera, bounce1, bounce3, shadow, random: the bounces are diffuse, the shadow rays start where camera rays end, random
// rays join two points of the sphere around the mesh. `side` x `side` camera rays in 4 x 4 squares; a multiple of 4.
std::vector<RaySet> ray_sets(const BenchmarkMesh& mesh, const EmbreeScene& scene, std::size_t side);

}  // namespace wavelobe::benchmark
