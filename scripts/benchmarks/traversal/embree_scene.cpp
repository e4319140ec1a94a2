#include <cstring>
#include <limits>
#include <stdexcept>

#include "rays.h"

namespace wavelobe::benchmark {

EmbreeScene::EmbreeScene(const BenchmarkMesh& mesh, bool robust, int threads)
    : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
    if (!device_) throw std::runtime_error("Embree could not be started");
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = mesh.triangles.size();
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * count);
    std::memcpy(vertices, mesh.triangles.data(), 36 * count);
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
    for (std::size_t i = 0; i < 3 * count; ++i) indices[i] = static_cast<unsigned>(i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
}

namespace {

RTCRay single_ray(const RaySet& r, std::size_t i) {
    RTCRay ray{};
    ray.org_x = r.field(0)[i], ray.org_y = r.field(1)[i], ray.org_z = r.field(2)[i];
    ray.dir_x = r.field(3)[i], ray.dir_y = r.field(4)[i], ray.dir_z = r.field(5)[i];
    ray.tfar = r.field(6)[i];
    ray.mask = ~0U;
    return ray;
}

template <class Packet>
void fill_packet(Packet& ray, const RaySet& r, std::size_t i) {
    constexpr std::size_t bytes = sizeof ray.org_x;
    std::memcpy(ray.org_x, r.field(0) + i, bytes);
    std::memcpy(ray.org_y, r.field(1) + i, bytes);
    std::memcpy(ray.org_z, r.field(2) + i, bytes);
    std::memcpy(ray.dir_x, r.field(3) + i, bytes);
    std::memcpy(ray.dir_y, r.field(4) + i, bytes);
    std::memcpy(ray.dir_z, r.field(5) + i, bytes);
    std::memcpy(ray.tfar, r.field(6) + i, bytes);
    std::memset(ray.tnear, 0, bytes);
    std::memset(ray.time, 0, bytes);
    std::memset(ray.mask, 0xff, bytes);
    std::memset(ray.flags, 0, bytes);
}

template <int width, class RayHit, class Intersect, class Occluded>
void trace_packets(const RaySet& rays, std::size_t first, std::size_t last, float* hits, std::uint32_t* primitives,
                   Intersect intersect, Occluded occluded) {
    alignas(64) int valid[width];
    std::memset(valid, 0xff, sizeof valid);
    for (std::size_t i = first; i < last; i += width) {
        alignas(64) RayHit packet;
        fill_packet(packet.ray, rays, i);
        if (rays.any_hit) {
            occluded(valid, packet.ray);
        } else {
            std::memset(packet.hit.geomID, 0xff, sizeof packet.hit.geomID);
            std::memset(packet.hit.primID, 0xff, sizeof packet.hit.primID);
            std::memset(packet.hit.instID, 0xff, sizeof packet.hit.instID);
            intersect(valid, packet);
            std::memcpy(primitives + i, packet.hit.primID, sizeof packet.hit.primID);
        }
        std::memcpy(hits + i, packet.ray.tfar, sizeof packet.ray.tfar);
    }
}

}  // namespace

void EmbreeScene::trace(const RaySet& rays, std::size_t first, std::size_t last, Mode mode, bool coherent, float* hits,
                        std::uint32_t* primitives) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    RTCScene scene = scene_.get();
    if (mode == Mode::eight) {
        trace_packets<8, RTCRayHit8>(
            rays, first, last, hits, primitives, [&](int* v, RTCRayHit8& p) { rtcIntersect8(v, scene, &context, &p); },
            [&](int* v, RTCRay8& p) { rtcOccluded8(v, scene, &context, &p); });
        return;
    }
    if (mode == Mode::sixteen) {
        trace_packets<16, RTCRayHit16>(
            rays, first, last, hits, primitives, [&](int* v, RTCRayHit16& p) { rtcIntersect16(v, scene, &context, &p); },
            [&](int* v, RTCRay16& p) { rtcOccluded16(v, scene, &context, &p); });
        return;
    }
    // One ray a call, or a stream of 64.
    constexpr std::size_t stream = 64;
    for (std::size_t i = first; i < last; i += stream) {
        if (rays.any_hit) {
            RTCRay batch[stream];
            for (std::size_t k = 0; k < stream; ++k) {
                batch[k] = single_ray(rays, i + k);
                if (mode == Mode::single) rtcOccluded1(scene, &context, batch + k);
            }
            if (mode == Mode::stream) rtcOccluded1M(scene, &context, batch, stream, sizeof(RTCRay));
            for (std::size_t k = 0; k < stream; ++k) hits[i + k] = batch[k].tfar;
            continue;
        }
        RTCRayHit batch[stream];
        for (std::size_t k = 0; k < stream; ++k) {
            batch[k].ray = single_ray(rays, i + k);
            batch[k].hit.geomID = batch[k].hit.primID = batch[k].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            if (mode == Mode::single) rtcIntersect1(scene, &context, batch + k);
        }
        if (mode == Mode::stream) rtcIntersect1M(scene, &context, batch, stream, sizeof(RTCRayHit));
        for (std::size_t k = 0; k < stream; ++k) {
            hits[i + k] = batch[k].ray.tfar;
            primitives[i + k] = batch[k].hit.primID;
        }
    }
}

}  // namespace wavelobe::benchmark
