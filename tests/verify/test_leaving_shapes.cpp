// Rays that leave each type of shape, at all sizes and far from the origin: none meets the surface it left, none misses a second
// surface next to it.
#include "support/ray_sets.h"
#include "support/surface_bench.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

enum class Kind { sphere, disk, cylinder, rectangle, cube };
constexpr const char* kind_names[] = {"sphere", "disk", "cylinder", "rectangle", "cube"};

bool is_flat(Kind kind) { return kind == Kind::disk || kind == Kind::rectangle; }

TriangleMesh placed_cube(const glm::mat4& to_world) {
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const glm::vec2 corner : {glm::vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
                glm::vec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] = corner.x * side;
                p[(axis + 2) % 3] = corner.y;
                mesh.positions.emplace_back(to_world * glm::vec4(p, 1.0F));
            }
            mesh.triangles.emplace_back(first, first + 1, first + 2);
            mesh.triangles.emplace_back(first, first + 2, first + 3);
        }
    }
    return mesh;
}

void add_kind(Scene& scene, Kind kind, const glm::mat4& to_world, int material) {
    switch (kind) {
        case Kind::sphere: add_shape(scene, AnalyticShape{AnalyticShape::Kind::sphere, to_world}, material, "sphere"); break;
        case Kind::disk: add_shape(scene, AnalyticShape{AnalyticShape::Kind::disk, to_world}, material, "disk"); break;
        case Kind::cylinder: add_shape(scene, AnalyticShape{AnalyticShape::Kind::cylinder, to_world}, material, "cylinder"); break;
        case Kind::rectangle: {
            const auto corner = [&](float x, float y) { return glm::vec3(to_world * glm::vec4(x, y, 0, 1)); };
            TriangleMesh mesh;
            mesh.positions = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
            mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
            add_shape(scene, std::move(mesh), material, "rectangle");
            break;
        }
        case Kind::cube: add_shape(scene, placed_cube(to_world), material, "cube"); break;
    }
}

struct Placing {
    glm::mat4 turn{1.0F};
    glm::vec3 at{0.0F};
    float size = 1.0F;
};

glm::mat4 placed(const Placing& p, const glm::mat4& object) {
    return glm::translate(glm::mat4(1.0F), p.at) * p.turn * glm::scale(glm::mat4(1.0F), glm::vec3(p.size)) * object;
}

// The surface, and a second one outside it (above, if flat) at `gap` of its size, so large that no ray finds its way round.
Scene two_surfaces(Kind kind, const Placing& p, float gap) {
    Scene scene = empty_scene(16);
    const int material = add_diffuse(scene, Rgb{0.5F});
    const glm::mat4 one(1.0F);
    const bool round = kind == Kind::cylinder;
    // Cylinders reach from z = 0 to 1.
    add_kind(scene, kind, placed(p, round ? glm::translate(one, {0, 0, -0.5F}) : one), material);
    glm::mat4 second = glm::scale(one, glm::vec3(1.0F + gap));
    const float reach = std::max(1e3F, 1e5F * gap);
    if (is_flat(kind)) second = glm::scale(glm::translate(one, {0, 0, gap}), glm::vec3(reach, reach, 1));
    // Rays rise along the axis by 1e4 gaps at most. A longer cylinder's base would lie so far away that its coordinates place the
    // axis no better than the gap.
    const float length = 4.0F + 4e4F * gap;
    if (round) second = glm::translate(glm::scale(one, {1.0F + gap, 1.0F + gap, length}), {0, 0, -0.5F});
    add_kind(scene, kind, placed(p, second), material);
    return scene;
}

// A ray from within (below, if flat) to the surface.
TestPath arriving(Kind kind, const Placing& p, Generator& random) {
    const auto between = [&](float a, float b) { return uniform(random, a, b); };
    glm::vec3 from{between(-0.3F, 0.3F), between(-0.3F, 0.3F), between(-0.3F, 0.3F)};
    glm::vec3 direction = uniform_direction(random);
    if (is_flat(kind)) {
        from.z = -1.0F;
        direction = glm::normalize(glm::vec3{between(-0.6F, 0.6F), between(-0.6F, 0.6F), 0.0F} - from);
    }
    const glm::vec3 origin = p.at + p.size * glm::vec3(p.turn * glm::vec4(from, 0));
    return untraced(origin, glm::normalize(glm::vec3(p.turn * glm::vec4(direction, 0))));
}

struct Counts {
    std::uint64_t rays = 0, again = 0, missed = 0;
};

// Those of the rays that hit anything, with their surfaces in the bench.
std::vector<TestPath> hitting(SurfaceBench& bench, const std::vector<TestPath>& rays) {
    bench.trace(rays);
    std::vector<TestPath> out;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (bench.path(i).hit != HIT_NONE) out.push_back(rays[i]);
    }
    if (!out.empty()) bench.hit(out, std::vector<glm::vec3>(out.size(), glm::vec3(0, 0, 1)));
    return out;
}

// `tangent`: half of the rays leave at cosines down to this.
Counts count(Kind kind, const Placing& p, float gap, float tangent, bool few, int rounds, Generator& random) {
    SurfaceBench bench(two_surfaces(kind, p, gap), 16, few);
    const std::uint32_t first = kind == Kind::cube ? 12 : kind == Kind::rectangle ? 2 : 1;
    Counts counts;
    for (int round = 0; round < rounds; ++round) {
        std::vector<TestPath> rays;
        for (std::uint32_t i = 0; i < surface_batch; ++i) rays.push_back(arriving(kind, p, random));
        rays = hitting(bench, rays);
        std::vector<glm::vec3> leave(rays.size());
        // Every fourth ray goes back down where that is to leave.
        std::vector<bool> out(rays.size(), true);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const glm::vec3 n = glm::normalize(bench.normal(i)) * (glm::dot(bench.normal(i), rays[i].direction) < 0.0F ? -1.0F : 1.0F);
            const glm::vec3 any = uniform_direction(random);
            const float cosine = i % 2 == 0 ? uniform(random, tangent, 1.0F) : std::exp2(uniform(random, std::log2(tangent), 0.0F));
            out[i] = !(is_flat(kind) && i % 4 == 1);
            const glm::vec3 along = glm::normalize(any - n * glm::dot(any, n));
            leave[i] = glm::normalize(along * std::sqrt(1.0F - cosine * cosine) + n * (out[i] ? cosine : -cosine));
        }
        if (rays.empty()) continue;
        bench.hit(rays, leave);
        std::vector<TestPath> next;
        std::uint64_t outward = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (bench.primitive(i) >= first) continue;
            next.push_back(untraced(bench.leaving_origin(i), leave[i]));
            next.back().hit = bench.primitive(i);
            outward += out[i];
        }
        counts.rays += next.size();
        std::uint64_t second = 0;
        const std::size_t hits = hitting(bench, next).size();
        for (std::size_t i = 0; i < hits; ++i) {
            if (bench.primitive(i) >= first) ++second;
        }
        counts.again += hits - second;
        // What goes down from a flat surface meets nothing.
        counts.missed += outward > second ? outward - second : 0;
    }
    return counts;
}

class LeavingShapes : public testing::TestWithParam<Kind> {};

TEST_P(LeavingShapes, MeetTheNextSurfaceAndNotTheirOwn) {
    const Kind kind = GetParam();
    const std::string name = kind_names[static_cast<int>(kind)];
    Claim again("Numerical stability", "Rays leaving a " + name + ", sizes 1e-6 to 1e6, up to 1e6 sizes from the origin: that meet it again", "rays");
    Claim missed("Numerical stability", "... that miss a second surface, 1e-5 sizes away where floats can tell", "rays");
    Generator random(11);
    std::uint64_t rays = 0;
    const std::vector<float> sizes = verify_fully() ? std::vector{1e-6F, 1e-3F, 1.0F, 1e3F, 1e6F} : std::vector{1e-6F, 1.0F, 1e6F};
    for (const bool few : {false, true}) {
        if (few && (kind != Kind::rectangle && kind != Kind::cube)) continue;
        for (const float size : sizes) {
            for (const float away : {0.0F, 1.0F, 30.0F, 1e3F, 1e6F}) {
                Placing p;
                p.size = size;
                p.turn = glm::rotate(glm::mat4(1.0F), 0.7F, glm::normalize(glm::vec3{1, 2, 3}));
                p.at = size * away * glm::normalize(glm::vec3{0.6F, -0.7F, 0.4F});
                // Where the spacing of floats is wider than that, as near as it allows: two roundings of either surface.
                const float gap = std::max(1e-5F, 4e-6F * away);
                // There vertices are so coarse that the two surfaces are not parallel.
                const float tangent = away <= 30.0F ? 1e-4F : 0.25F;
                const Counts found = count(kind, p, gap, tangent, few, quick_or_full(1, 24), random);
                rays += found.rays;
                const auto where = [&] { return "size " + std::to_string(size) + ", " + std::to_string(away) + " sizes away"; };
                again.observe(static_cast<double>(found.again), where);
                missed.observe(static_cast<double>(found.missed), where);
                EXPECT_GT(found.rays, away <= 30.0F ? surface_batch / 4 : 0U) << where();
            }
        }
    }
    again.count(rays);
    missed.count(rays);
    again.at_most(0.0);
    missed.at_most(0.0);
}

INSTANTIATE_TEST_SUITE_P(All, LeavingShapes,
                         testing::Values(Kind::sphere, Kind::disk, Kind::cylinder, Kind::rectangle, Kind::cube),
                         [](const auto& kind) { return kind_names[static_cast<int>(kind.param)]; });

}  // namespace
}  // namespace wavelobe::test
