#include "scene/gltf/backs.h"

#include <array>
#include <cstring>
#include <unordered_map>

namespace wavelobe::gltf {

namespace {

struct Place {
    std::array<std::uint32_t, 3> bits;
    bool operator==(const Place&) const = default;
};

struct PlaceHash {
    std::size_t operator()(const Place& p) const {
        std::uint64_t h = 0;
        for (const std::uint32_t word : p.bits) h = (h ^ word) * 0x9e3779b97f4a7c15ULL, h ^= h >> 29;
        return static_cast<std::size_t>(h);
    }
};

Place place_of(const glm::vec3& p) {
    const glm::vec3 q = p + 0.0F;  // one zero of two
    Place out;
    std::memcpy(out.bits.data(), &q, sizeof out.bits);
    return out;
}

bool holds(const TriangleMesh& mesh, const glm::vec3& point) {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    return glm::all(glm::lessThanEqual(low, point)) && glm::all(glm::lessThanEqual(point, high));
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) {
    // Vertices are doubled along seams: one number a place.
    std::unordered_map<Place, std::uint32_t, PlaceHash> numbers;
    std::vector<std::uint32_t> number;
    number.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) number.push_back(numbers.try_emplace(place_of(p), static_cast<std::uint32_t>(numbers.size())).first->second);
    // Each edge is walked as often one way as the other.
    std::unordered_map<std::uint64_t, int> balance;
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = number[t[k]];
            const std::uint32_t b = number[t[(k + 1) % 3]];
            if (a == b) return false;
            const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
            balance[edge] += a < b ? 1 : -1;
        }
        const glm::dvec3 origin(mesh.positions[mesh.triangles[0].x]);
        volume += glm::dot(glm::dvec3(mesh.positions[t.x]) - origin,
                           glm::cross(glm::dvec3(mesh.positions[t.y]) - origin, glm::dvec3(mesh.positions[t.z]) - origin));
    }
    if (!(volume > 0.0)) return false;
    for (const auto& [edge, sum] : balance)
        if (sum != 0) return false;
    return true;
}

void clear_backs(Scene& scene, const std::vector<std::size_t>& shapes) {
    int clear = -1;
    for (const std::size_t i : shapes) {
        const auto& mesh = std::get<TriangleMesh>(scene.shapes[i].geometry);
        if (is_closed(mesh) && !holds(mesh, glm::vec3(scene.camera.to_world[3]))) continue;
        if (clear < 0) {
            clear = static_cast<int>(scene.materials.size());
            scene.materials.push_back({ThinDielectric{1.0F}, "back of single-sided materials"});
        }
        scene.shapes[i].material.back = clear;
        scene.shapes[i].material.sided_by_winding = true;
    }
}

}  // namespace wavelobe::gltf
