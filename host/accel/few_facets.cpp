#include "accel/few_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace wavelobe {
namespace {

constexpr std::array<std::size_t, 3> all_corners = {0, 1, 2};

// How far corners may be off a parallelogram or a plane: a few roundings (kernels/shapes/few_facets.h counts on it).
double tolerance(const FewTriangleSet& few) { return 0x1p-22 * static_cast<double>(few.summary.radius); }

glm::dvec3 vertex(const FewTriangleSet& few, std::uint32_t i) {
    const float* v = &few.vertices[std::size_t{3} * i];
    return {v[0], v[1], v[2]};
}

// A triangle as a half of a facet: its apex lies across from the line u + v = 0, on which b is where u is larger than at the apex, c where v is.
struct Half {
    std::size_t triangle;
    std::uint32_t apex, b, c;  // vertices
};

Half half_with_apex(const FewTriangleSet& few, std::size_t triangle, std::size_t apex) {
    const std::uint32_t* corner = few.triangles[triangle].corner;
    return {triangle, corner[apex], corner[(apex + 1) % 3], corner[(apex + 2) % 3]};
}

// The apex across from the longest edge: points are then inside the others as surely as inside that one.
Half lone_half(const FewTriangleSet& few, std::size_t triangle) {
    const auto across = [&](std::size_t apex) {
        const Half h = half_with_apex(few, triangle, apex);
        return glm::length(vertex(few, h.c) - vertex(few, h.b));
    };
    return half_with_apex(few, triangle, std::ranges::max(all_corners, {}, across));
}

struct Pair {
    Half near, far;
};

// The two triangles as halves of a parallelogram, corners of which may be off by a few roundings.
std::optional<Pair> parallelogram(const FewTriangleSet& few, std::size_t first, std::size_t second) {
    for (const std::size_t i : all_corners) {
        const Half near = half_with_apex(few, first, i);
        for (const std::size_t k : all_corners) {
            Half far = half_with_apex(few, second, k);
            const bool shared = (far.b == near.b && far.c == near.c) || (far.b == near.c && far.c == near.b);
            if (!shared) continue;
            // Seen from the far apex u and v are larger where they are smaller seen from the near one.
            far.b = near.c;
            far.c = near.b;
            const glm::dvec3 gap = vertex(few, near.apex) + vertex(few, far.apex) - vertex(few, near.b) - vertex(few, near.c);
            if (glm::length(gap) <= tolerance(few)) return Pair{near, far};
        }
    }
    return std::nullopt;
}

std::uint32_t part_of(const FewTriangleSet& few, const Half& half) {
    const FewTriangle& t = few.triangles[half.triangle];
    const auto role = [&](std::uint32_t corner) { return corner == half.apex ? 0U : (corner == half.b ? 1U : 2U); };
    return FACET_PART(t.slot, role(t.corner[1]), role(t.corner[2]));
}

void set_row(float (&row)[4], const glm::dvec3& along, const glm::dvec3& middle) {
    for (glm::length_t k = 0; k < 3; ++k) row[k] = static_cast<float>(along[k]);
    row[3] = static_cast<float>(-glm::dot(along, middle));
}

// The near half's, and the far one's where there is one.
void add_facet(FewTriangleSet& few, const Half& near, const Half* far) {
    const glm::dvec3 center(few.summary.center[0], few.summary.center[1], few.summary.center[2]);
    const glm::dvec3 a = vertex(few, near.apex), b = vertex(few, near.b), c = vertex(few, near.c), d = far != nullptr ? vertex(few, far->apex) : c;
    glm::dvec3 middle = 0.5 * (b + c), u = 0.5 * (b - a), v = 0.5 * (c - a);
    if (far != nullptr) {
        // What the four corners say on average.
        middle = 0.25 * (a + b + c + d);
        u = 0.25 * (b - a + d - c);
        v = 0.25 * (c - a + d - b);
    }
    middle -= center;
    const glm::dvec3 area = glm::cross(u, v), normal = glm::normalize(area);
    // In the plane, perpendicular to one side, and one along the other.
    const auto along = [&](const glm::dvec3& side, const glm::dvec3& other) {
        const glm::dvec3 across = glm::cross(other, normal);
        return across / glm::dot(side, across);
    };
    const glm::dvec3 along_u = along(u, v), along_v = along(v, u);
    FewFacet f{};
    for (glm::length_t k = 0; k < 3; ++k) f.normal[k] = static_cast<float>(normal[k]);
    f.offset = static_cast<float>(glm::dot(normal, middle));
    set_row(f.u, along_u, middle);
    set_row(f.v, along_v, middle);
    f.height_u = static_cast<float>(1.0 / glm::length(along_u));
    f.height_v = static_cast<float>(1.0 / glm::length(along_v));
    f.height_w = static_cast<float>(1.0 / glm::length(along_u + along_v));
    f.part[0] = part_of(few, near);
    f.part[1] = far != nullptr ? part_of(few, *far) : f.part[0];
    const auto number = static_cast<std::uint32_t>(few.facets.size());
    const auto holds_all = [&](const FewFacet& other) {
        const glm::dvec3 across(other.normal[0], other.normal[1], other.normal[2]);
        return std::ranges::all_of(std::array{a, b, c, d}, [&](const glm::dvec3& p) {
            return std::abs(glm::dot(across, p - center) - static_cast<double>(other.offset)) <= tolerance(few);
        });
    };
    f.plane = static_cast<std::uint32_t>(std::ranges::find_if(few.facets, holds_all) - few.facets.begin());
    std::size_t row = 0;
    for (const glm::dvec3& p : {a, b, c, d, 4.0 * area}) {
        for (glm::length_t k = 0; k < 3; ++k) few.corners[row++ * FEW_TRIANGLES_MAX + number] = static_cast<float>(p[k]);
    }
    few.triangles[near.triangle].facet = number;
    if (far != nullptr) few.triangles[far->triangle].facet = number;
    few.facets.push_back(f);
}

}  // namespace

void add_facets(FewTriangleSet& few) {
    const std::size_t count = few.triangles.size();
    few.facets.clear();
    few.corners.assign(std::size_t{FEW_CORNER_ROWS} * FEW_TRIANGLES_MAX, 0.0F);
    std::vector<bool> paired(count, false);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = i + 1; k < count && !paired[i]; ++k) {
            const std::optional<Pair> pair = paired[k] ? std::nullopt : parallelogram(few, i, k);
            if (!pair) continue;
            add_facet(few, pair->near, &pair->far);
            paired[i] = paired[k] = true;
        }
    }
    few.summary.parallelogram_count = static_cast<std::uint32_t>(few.facets.size());
    for (std::size_t i = 0; i < count; ++i) {
        if (!paired[i]) add_facet(few, lone_half(few, i), nullptr);
    }
    few.summary.facet_count = static_cast<std::uint32_t>(few.facets.size());
    for (const FewTriangle& t : few.triangles) {
        const std::size_t number = t.primitive & ~PRIMITIVE_MASKED;
        if (number >= few.numbers.size()) few.numbers.resize(number + 1, FACET_NONE);
        few.numbers[number] = t.facet;
    }
    few.summary.number_count = static_cast<std::uint32_t>(few.numbers.size());
}

}  // namespace wavelobe
