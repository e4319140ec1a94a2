#include "scene/gltf/backs.h"

#include <array>
#include <cstring>
#include <numeric>
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

// Vertices are doubled along seams: one number a place.
class Places {
public:
    std::uint32_t number_of(const glm::vec3& p) {
        return numbers_.try_emplace(place_of(p), static_cast<std::uint32_t>(numbers_.size())).first->second;
    }
    std::size_t size() const { return numbers_.size(); }

private:
    std::unordered_map<Place, std::uint32_t, PlaceHash> numbers_;
};

// Places that triangles join: each group is known by one of its members.
class Groups {
public:
    explicit Groups(std::size_t places) : above_(places) { std::iota(above_.begin(), above_.end(), 0U); }

    std::uint32_t find(std::uint32_t place) {
        while (above_[place] != place) place = above_[place] = above_[above_[place]];
        return place;
    }
    void join(std::uint32_t a, std::uint32_t b) { above_[find(a)] = find(b); }

private:
    std::vector<std::uint32_t> above_;
};

// Whether the camera is on the side of a triangle that its winding faces.
bool faces_camera(const Camera& camera, const TriangleMesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    if (camera.projection == Camera::Projection::orthographic) return glm::dot(normal, glm::dvec3(camera.to_world[2])) < 0.0;
    return glm::dot(normal, glm::dvec3(camera.to_world[3]) - a) > 0.0;
}

bool holds(const TriangleMesh& mesh, const glm::vec3& point) {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    return glm::all(glm::lessThanEqual(low, point)) && glm::all(glm::lessThanEqual(point, high));
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) {
    Places places;
    std::vector<std::uint32_t> number;
    number.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) number.push_back(places.number_of(p));
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

std::size_t leave_out_backs(Scene& scene, const std::vector<std::size_t>& shapes) {
    Places places;
    std::vector<std::vector<std::uint32_t>> numbers;
    for (const std::size_t i : shapes) {
        std::vector<std::uint32_t>& number = numbers.emplace_back();
        for (const glm::vec3& p : std::get<TriangleMesh>(scene.shapes[i].geometry).positions) number.push_back(places.number_of(p));
    }
    Groups groups(places.size());
    const auto each_triangle = [&](const auto& visit) {
        for (std::size_t k = 0; k < shapes.size(); ++k) {
            const auto& mesh = std::get<TriangleMesh>(scene.shapes[shapes[k]].geometry);
            for (const glm::uvec3& t : mesh.triangles) visit(scene.shapes[shapes[k]], mesh, t, numbers[k]);
        }
    };
    each_triangle([&](const Shape&, const TriangleMesh&, const glm::uvec3& t, const std::vector<std::uint32_t>& number) {
        groups.join(number[t.x], number[t.y]);
        groups.join(number[t.x], number[t.z]);
    });
    std::vector<bool> stays(places.size(), false);
    each_triangle([&](const Shape& shape, const TriangleMesh& mesh, const glm::uvec3& t, const std::vector<std::uint32_t>& number) {
        if (shape.emitter || faces_camera(scene.camera, mesh, t)) stays[groups.find(number[t.x])] = true;
    });
    std::size_t left_out = 0;
    for (std::size_t k = 0; k < shapes.size(); ++k)
        left_out += std::erase_if(std::get<TriangleMesh>(scene.shapes[shapes[k]].geometry).triangles,
                                  [&](const glm::uvec3& t) { return !stays[groups.find(numbers[k][t.x])]; });
    return left_out;
}

void clear_backs(Scene& scene, const std::vector<std::size_t>& shapes) {
    int clear = -1;
    for (const std::size_t i : shapes) {
        const auto& mesh = std::get<TriangleMesh>(scene.shapes[i].geometry);
        if (mesh.triangles.empty()) continue;
        if (is_closed(mesh) && !holds(mesh, glm::vec3(scene.camera.to_world[3]))) continue;
        if (clear < 0) {
            clear = static_cast<int>(scene.materials.size());
            scene.materials.push_back({ThinDielectric{1.0F}, "back of single-sided materials"});
        }
        scene.shapes[i].material.back = clear;
        scene.shapes[i].material.culled_behind = true;
    }
}

}  // namespace wavelobe::gltf
