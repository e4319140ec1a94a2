#include "scene/gltf/volumes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/presence.h"

namespace wavelobe::gltf {

namespace {

const TriangleMesh& mesh_of(const Scene& scene, const Volume& volume) { return std::get<TriangleMesh>(scene.shapes[volume.shape].geometry); }

// Bounds and content of a closed mesh.
struct Extent {
    glm::vec3 low{std::numeric_limits<float>::max()};
    glm::vec3 high{std::numeric_limits<float>::lowest()};
    double content = 0.0;
};

Extent extent_of(const TriangleMesh& mesh) {
    Extent out;
    const glm::dvec3 origin(mesh.positions[0]);
    for (const glm::uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) out.low = glm::min(out.low, mesh.positions[t[k]]), out.high = glm::max(out.high, mesh.positions[t[k]]);
        out.content += glm::dot(glm::dvec3(mesh.positions[t.x]) - origin,
                                glm::cross(glm::dvec3(mesh.positions[t.y]) - origin, glm::dvec3(mesh.positions[t.z]) - origin)) / 6.0;
    }
    return out;
}

// How often a mesh goes around a point: the sum of the solid angles of its triangles over that of the sphere. Van Oosterom,
// Strackee 1983, "The Solid Angle of a Plane Triangle".
double winding_number(const TriangleMesh& mesh, const glm::dvec3& point) {
    double half_angles = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - point;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t.y]) - point;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t.z]) - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        half_angles += std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return half_angles / (2.0 * std::numbers::pi);
}

class Nest {
public:
    Nest(const Scene& scene, const std::vector<Volume>& volumes) : scene_(scene), volumes_(volumes) {
        for (const Volume& volume : volumes) extents_.push_back(extent_of(mesh_of(scene, volume)));
    }

    // Of the volumes around a point the one with the least content, but for number `except`.
    int medium_at(const glm::vec3& point, std::size_t except) const {
        int medium = -1;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < volumes_.size(); ++i) {
            const Extent& e = extents_[i];
            const bool near = glm::all(glm::lessThanEqual(e.low, point)) && glm::all(glm::lessThanEqual(point, e.high));
            if (i == except || !near || !(e.content < least)) continue;
            if (winding_number(mesh_of(scene_, volumes_[i]), glm::dvec3(point)) < 0.5) continue;
            least = e.content;
            medium = volumes_[i].medium;
        }
        return medium;
    }

private:
    const Scene& scene_;
    const std::vector<Volume>& volumes_;
    std::vector<Extent> extents_;
};

}  // namespace

Rgb absorption_of(const Element& volume) {
    constexpr double most = std::numeric_limits<float>::max();
    const double distance = volume.number("attenuationDistance", most, {0.0, most});
    const auto color = volume.vector<3>("attenuationColor", {1, 1, 1}, {0.0, 1.0});
    if (volume.has("attenuationDistance") && distance == 0.0) volume.fault("attenuationDistance is 0; expected more than 0");
    Rgb out(0.0F);
    if (!volume.has("attenuationDistance") || distance == 0.0) return out;
    // Of a black channel nothing is left after the shortest way.
    for (int c = 0; c < 3; ++c) {
        const auto left = static_cast<double>(color[static_cast<std::size_t>(c)]);
        if (left < 1.0) out[c] = static_cast<float>(std::min(-std::log(left) / distance, most));
    }
    return out;
}

void part_media(Scene& scene, const std::vector<Volume>& volumes) {
    if (std::none_of(volumes.begin(), volumes.end(), [](const Volume& v) { return v.medium >= 0; })) return;
    PresenceFinder presence;
    std::vector<Volume> whole;
    for (const Volume& volume : volumes) {
        const Shape& shape = scene.shapes[volume.shape];
        const Presence here = presence.find(shape);
        if (here == Presence::whole) whole.push_back(volume);
        if (here == Presence::partial && volume.medium >= 0)
            scene.warnings.push_back(shape.name + ": its alpha leaves it only partly there, and what is inside does not absorb");
    }
    const Nest nest(scene, whole);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const TriangleMesh& mesh = mesh_of(scene, whole[i]);
        const int outside = nest.medium_at(mesh.positions[mesh.triangles[0].x], i);
        scene.shapes[whole[i].shape].media = MediumBoundary{whole[i].medium, outside};
    }
    scene.camera_medium = nest.medium_at(glm::vec3(scene.camera.to_world[3]), whole.size());
}

}  // namespace wavelobe::gltf
