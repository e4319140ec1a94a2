// Traversal over many rays: closed meshes let none pass, and random rays hit what they hit in Embree's watertight scenes.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <functional>

#include "support/few_probe.h"
#include "support/ray_sets.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

constexpr std::size_t batch = 100000;

// ---- closed meshes ------------------------------------------------------------------------------------------

// Two fans of a thousand triangles, back to back.
ClosedMesh fans() {
    constexpr unsigned sides = 1000;
    ClosedMesh mesh;
    for (unsigned i = 0; i < sides; ++i) {
        const double phi = 2.0 * std::numbers::pi * i / sides;
        mesh.vertices.emplace_back(std::cos(phi), std::sin(phi), 0.0);
        const unsigned next = (i + 1) % sides;
        mesh.faces.emplace_back(i, next, sides);
        mesh.faces.emplace_back(next, i, sides + 1);
    }
    mesh.vertices.emplace_back(0.0F, 0.0F, 1.0F);
    mesh.vertices.emplace_back(0.0F, 0.0F, -1.0F);
    return mesh;
}

struct Shape {
    const char* name;
    ClosedMesh mesh;
    glm::vec3 inside;  // half the size of a box around the center that lies within
};

std::vector<Shape> shapes(bool needles_too) {
    std::vector<Shape> all{{"sphere", sphere_mesh(5, 1.0F, {}), glm::vec3(0.5F)},
                           {"cube", cube_mesh(12), glm::vec3(0.9F)},
                           {"fans", fans(), glm::vec3(0.25F)}};
    if (!needles_too) return all;
    Shape needles{"needles", sphere_mesh(5, 1.0F, {}), {0.5F, 5e-4F, 5e-4F}};
    for (glm::vec3& v : needles.mesh.vertices) v *= glm::vec3{1.0F, 1e-3F, 1e-3F};
    all.push_back(needles);
    return all;
}

struct Placement {
    const char* name;
    float scale;
    float offset;  // in sizes
};

void PrintTo(const Placement& p, std::ostream* out) { *out << p.name; }

class ClosedMeshes : public testing::TestWithParam<Placement> {};

// A ray from inside to a vertex, to a point of an edge, or anywhere.
TestRay ray_from_inside(const ClosedMesh& mesh, const glm::vec3& center, const glm::vec3& half, Generator& random) {
    const glm::vec3 origin = center + half * uniform_in_cube(random, 1.0F);
    const std::size_t face = random() % mesh.faces.size();
    const std::size_t corner = random() % 3;
    return aimed_ray(origin, mesh, face, corner, static_cast<Aim>(random() % 4), random);
}

// Sixteen rays along an axis, to the vertices, edges and faces around one vertex: a packet whose rays differ in their signs.
void add_bundle(std::vector<TestRay>& rays, const ClosedMesh& mesh, const glm::vec3& center, const glm::vec3& half, Generator& random) {
    const std::size_t face = random() % mesh.faces.size();
    const auto axis = static_cast<glm::length_t>(random() % 3);
    glm::vec3 start = 0.9F * (mesh.vertices[mesh.faces[face].x] - center);
    start[axis] = 0.0F;
    for (std::size_t k = 0; k < 16; ++k) {
        const glm::vec3 origin = center + start + 0.05F * half * uniform_in_cube(random, 1.0F);
        rays.push_back(aimed_ray(origin, mesh, (face + k / 4) % mesh.faces.size(), k, k % 2 == 0 ? Aim::corner : Aim::edge, random));
    }
}

// A batch, half of it in bundles.
std::vector<TestRay> rays_from_inside(const ClosedMesh& mesh, const glm::vec3& center, const glm::vec3& half, Generator& random) {
    std::vector<TestRay> rays;
    while (rays.size() < batch / 2) rays.push_back(ray_from_inside(mesh, center, half, random));
    while (rays.size() < batch) add_bundle(rays, mesh, center, half, random);
    return rays;
}

// The shape, scaled, at the center.
ClosedMesh placed(ClosedMesh mesh, float scale, const glm::vec3& center) {
    for (glm::vec3& v : mesh.vertices) v = v * scale + center;
    return mesh;
}

using Tracer = std::function<std::vector<TestHit>(const std::vector<TestRay>&)>;

// Traces batches of rays from inside a mesh in each of several ways.
void claim_that_none_passes(const std::string& name, const ClosedMesh& mesh, const glm::vec3& center, const glm::vec3& half, unsigned seed,
                            const std::vector<Tracer>& ways) {
    Claim claim("Numerical stability", name + ": rays from inside, to vertices, edges and anywhere, that pass", "rays");
    Generator random(seed);
    std::size_t passed = 0;
    const std::size_t batches = quick_or_full<std::size_t>(1, 40);
    for (std::size_t k = 0; k < batches; ++k) {
        const std::vector<TestRay> rays = rays_from_inside(mesh, center, half, random);
        for (const Tracer& trace : ways) {
            for (const TestHit& hit : trace(rays)) passed += hit.slot == HIT_NONE || hit.any == 0 ? 1 : 0;
        }
    }
    claim.observe(static_cast<double>(passed));
    claim.count(ways.size() * batch * batches);
    claim.at_most(0.0);
}

TEST_P(ClosedMeshes, LetNoRayPass) {
    const Placement& p = GetParam();
    const glm::vec3 center{p.scale * p.offset};
    // Far away the steps of floats are larger than needles are thick.
    for (const Shape& shape : shapes(p.offset == 0.0F)) {
        const ClosedMesh mesh = placed(shape.mesh, p.scale, center);
        const Bvh bvh = build_bvh(mesh.triangles(), {}, BvhQuality::split, 1);
        TraversalProbe alone, in_groups(false, true, 16, 8);
        claim_that_none_passes(fmt::format("{}, {}", shape.name, p.name), mesh, center, p.scale * shape.inside, 1,
                               {[&](const auto& rays) { return alone.trace(bvh, rays); }, [&](const auto& rays) { return in_groups.trace(bvh, rays); }});
    }
}

// Without a hierarchy, by facets.
TEST_P(ClosedMeshes, LetNoRayPassWhereTheyAreSmall) {
    const Placement& p = GetParam();
    const glm::vec3 center{p.scale * p.offset};
    for (const Shape& shape : std::vector<Shape>{{"sphere of 32", sphere_mesh(1, 1.0F, {}), glm::vec3(0.4F)}, {"cube of 48", cube_mesh(2), glm::vec3(0.9F)}}) {
        const ClosedMesh mesh = placed(shape.mesh, p.scale, center);
        const SmallScene scene(mesh.triangles());
        FewProbe probe;
        claim_that_none_passes(fmt::format("{}, {}, no hierarchy", shape.name, p.name), mesh, center, p.scale * shape.inside, 2,
                               {[&](const auto& rays) { return probe.trace(scene.few, rays); }});
    }
}

INSTANTIATE_TEST_SUITE_P(All, ClosedMeshes,
                         testing::Values(Placement{"unit", 1.0F, 0.0F}, Placement{"tiny", 1e-6F, 0.0F}, Placement{"huge", 1e6F, 0.0F},
                                         Placement{"away", 1.0F, 1e5F}),
                         [](const auto& p) { return p.param.name; });

// ---- beside Embree ------------------------------------------------------------------------------------------

class Embree {
public:
    explicit Embree(const Triangles& triangles) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<TriangleVertices*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * triangles.size()));
        auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                       3 * sizeof(unsigned), triangles.size()));
        std::copy(triangles.begin(), triangles.end(), vertices);
        for (unsigned i = 0; i < 3 * triangles.size(); ++i) indices[i] = i;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    // Distance of the hit; the ray's limit if there is none.
    float trace(const TestRay& r) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit ray{};
        ray.ray.org_x = r.origin.x, ray.ray.org_y = r.origin.y, ray.ray.org_z = r.origin.z;
        ray.ray.dir_x = r.direction.x, ray.ray.dir_y = r.direction.y, ray.ray.dir_z = r.direction.z;
        ray.ray.tfar = r.limit;
        ray.ray.mask = ~0U;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &ray);
        return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? r.limit : ray.ray.tfar;
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

struct Mesh {
    const char* name;
    Triangles triangles;
    float scale;
    glm::vec3 offset;
};

bool alike(float ours, float theirs) {
    return ours == theirs || std::abs(ours - theirs) <= 1e-5F * std::abs(theirs);
}

// Where they differ one of them may be wrong, or the ray may pass an edge so closely that rounding decides: ours has to be
// among what double precision holds possible.
TEST(RandomRays, HitWhatTheyHitInEmbree) {
    const glm::vec3 away{1000.0F, -3000.0F, 500.0F};
    const Mesh meshes[] = {{"soup of 20,000 triangles", triangle_soup(20000, 0.05F, 1.0F, {}, 1), 1.0F, {}},
                           {"sphere of 8,192 triangles", sphere_mesh(5, 1.0F, {}).triangles(), 1.0F, {}},
                           {"tiny soup of 2,000", triangle_soup(2000, 0.1F, 1e-6F, {}, 2), 1e-6F, {}},
                           {"soup of 2,000 far away", triangle_soup(2000, 0.1F, 1.0F, away, 3), 1.0F, away}};
    TraversalProbe ours(false, true, 16, 8);
    for (const Mesh& mesh : meshes) {
        const Embree embree(mesh.triangles);
        const Bvh bvh = build_bvh(mesh.triangles, {}, BvhQuality::split, 1);
        Claim claim("Numerical stability", std::string(mesh.name) + ": random rays that hit otherwise than in Embree, and wrongly", "rays");
        std::size_t unlike = 0, wrong = 0;
        std::string first;
        const std::size_t batches = quick_or_full<std::size_t>(3, 1000);
        for (std::size_t k = 0; k < batches; ++k) {
            const std::vector<TestRay> rays = random_rays(batch, mesh.scale, mesh.offset, static_cast<unsigned>(k));
            const std::vector<TestHit> hits = ours.trace(bvh, rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (alike(hits[i].t, embree.trace(rays[i]))) continue;
                ++unlike;
                const std::string fault = fault_of_hit(rays[i], hits[i], bvh, mesh.triangles);
                if (fault.empty()) continue;
                ++wrong;
                if (first.empty()) first = fmt::format("batch {} ray {}: {}; ", k, i, fault);
            }
        }
        claim.observe(static_cast<double>(wrong), [&] { return fmt::format("{}{} differ", first, unlike); });
        claim.count(batch * batches);
        claim.at_most(0.0);
    }
}

// Without a hierarchy; against double precision alone.
TEST(RandomRays, HitWhatDoublePrecisionAllowsInARoom) {
    for (const float scale : {1.0F, 1e-6F, 1e6F}) {
        const SmallScene room(furnished_room(scale, {}, 0.05F));
        FewProbe ours;
        Claim claim("Numerical stability", fmt::format("room of 12 rectangles, scale {}: random rays that hit wrongly", scale), "rays");
        std::size_t wrong = 0;
        std::string first;
        const std::size_t batches = quick_or_full<std::size_t>(1, 100);
        for (std::size_t k = 0; k < batches; ++k) {
            const std::vector<TestRay> rays = random_rays(batch, scale, {}, static_cast<unsigned>(k));
            const std::vector<TestHit> hits = ours.trace(room.few, rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const std::string fault = fault_of_hit(rays[i], hits[i], room.bvh, room.triangles, Projection::rotation);
                if (fault.empty()) continue;
                ++wrong;
                if (first.empty()) first = fmt::format("batch {} ray {}: {}", k, i, fault);
            }
        }
        claim.observe(static_cast<double>(wrong), [&] { return first; });
        claim.count(batch * batches);
        claim.at_most(0.0);
    }
}

}  // namespace
}  // namespace wavelobe::test
