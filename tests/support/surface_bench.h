// Surfaces as stages see them, of rays traced on the device.
#pragma once

#include "support/stage.h"

namespace wavelobe::test {

const std::uint32_t surface_batch = values_are_judged() ? 4096 : 256;  // rays at once

inline const char* const surface_kernel = R"(
#define STORE_SURFACE(field, value) store(surfaces + (field) * BLOCK_SLOTS + i, value)
#define STORE_VECTOR(field, v) STORE_SURFACE(field, (v).x); STORE_SURFACE(field + 1u, (v).y); STORE_SURFACE(field + 2u, (v).z)

// The surface of each path of the ray queue, and the origin of a ray that leaves it along `leave`.
kernel void load_surfaces(global struct BlockHeader *headers, global float *blocks, SURFACE_PARAMETERS,
                          global const float *leave, global float *surfaces) {
    Block block = block_of(headers, blocks, 0);
    SurfaceView view = SURFACE_VIEW;
    Queue rays = QUEUE(block, RAYS);
    uint n = *rays.count;
    for (uint i = 0u; i < n; i += LANES) {
        TracedPath path = read_traced_path(rays, i);
        // What a ray without a hit shows means nothing, but nothing outside of the scene is read for it.
        path.hit = SELECT(path.hit == (UInt)HIT_NONE, (UInt)0u, path.hit);
        Surface s = load_surface(view, &path);
        Vec3 away = vec3(load(leave + i), load(leave + BLOCK_SLOTS + i), load(leave + 2u * BLOCK_SLOTS + i));
        STORE_VECTOR(0u, s.position);
        STORE_VECTOR(3u, s.error);
        STORE_VECTOR(6u, s.normal);
        STORE_VECTOR(9u, s.frame.s);
        STORE_VECTOR(12u, s.frame.t);
        STORE_VECTOR(15u, s.frame.n);
        STORE_VECTOR(18u, s.wi);
        STORE_VECTOR(21u, offset_ray_origin(s.position, s.error, s.normal, away));
        STORE_SURFACE(24u, s.u);
        STORE_SURFACE(25u, s.v);
        STORE_SURFACE(26u, as_Float(s.material));
        STORE_SURFACE(27u, as_Float(s.primitive));
    }
}
)";
constexpr std::size_t surface_fields = 28;

class SurfaceBench {
public:
    explicit SurfaceBench(const Scene& scene, int lanes = 16, bool few = false)
        : bench_(scene, lanes, surface_batch, few, surface_kernel),
          leave_(device(), 3 * surface_batch * sizeof(float)),
          surfaces_(device(), surface_fields * (surface_batch + 16) * sizeof(float)) {}

    // Traces rays; `leave` are the directions in which they will go on.
    void hit(const std::vector<TestPath>& rays, const std::vector<glm::vec3>& leave) {
        trace(rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k)
                leave_.view<float>()[k * surface_batch + i] = leave[i][static_cast<glm::length_t>(k)];
        }
        bench_.run("load_surfaces", {{"leave", &leave_}, {"surfaces", &surfaces_}});
    }

    void trace(const std::vector<TestPath>& rays) {
        bench_.fill(QUEUE_RAYS, rays);
        bench_.run("intersect_closest");
    }

    TestPath path(std::size_t i) { return bench_.path(QUEUE_RAYS, static_cast<std::uint32_t>(i)); }
    float field(std::size_t f, std::size_t i) const { return surfaces_.view<float>()[f * surface_batch + i]; }
    glm::vec3 vector(std::size_t f, std::size_t i) const { return {field(f, i), field(f + 1, i), field(f + 2, i)}; }
    std::uint32_t bits(std::size_t f, std::size_t i) const {
        return surfaces_.view<std::uint32_t>()[f * surface_batch + i];
    }

    glm::vec3 position(std::size_t i) const { return vector(0, i); }
    glm::vec3 error(std::size_t i) const { return vector(3, i); }
    glm::vec3 normal(std::size_t i) const { return vector(6, i); }
    glm::vec3 wi(std::size_t i) const { return vector(18, i); }
    glm::vec3 leaving_origin(std::size_t i) const { return vector(21, i); }
    std::uint32_t material(std::size_t i) const { return bits(26, i); }
    std::uint32_t primitive(std::size_t i) const { return bits(27, i); }
    std::uint32_t slot_of(std::uint32_t triangle) const { return bench_.slot_of(triangle); }
    std::uint32_t back_material() const { return bench_.scene().shapes[0].back_material; }

private:
    StageBench bench_;
    Buffer leave_;
    Buffer surfaces_;
};

inline TestPath untraced(const glm::vec3& origin, const glm::vec3& direction) {
    TestPath p;
    p.origin = origin;
    p.direction = direction;
    p.t = std::numeric_limits<float>::infinity();
    return p;
}

}  // namespace wavelobe::test
