// The operations inside a <transform>.
#pragma once

#include <optional>

#include <glm/glm.hpp>

namespace wavelobe::mitsuba {

glm::dmat4 translation(const glm::dvec3& offset);
glm::dmat4 scaling(const glm::dvec3& factors);
// About a unit axis, right-handed. Mitsuba 3 takes any axis as it is, so that other lengths scale and shear, and so does this.
glm::dmat4 rotation(const glm::dvec3& axis, double degrees);
// +z towards the target, +y near `up` (zero: any), +x to the left. Nothing when the directions do not span space.
std::optional<glm::dmat4> look_at(const glm::dvec3& origin, const glm::dvec3& target, glm::dvec3 up);

// Two unit vectors that complete the unit vector `n` to a right-handed frame (s, t, n).
struct Tangents {
    glm::dvec3 s, t;
};
Tangents coordinate_system(const glm::dvec3& n);

// The last row is 0 0 0 1, and both the matrix and its inverse can be held in single precision.
bool is_invertible_affine(const glm::dmat4& matrix);
// The linear part is a rotation or reflection times one factor.
bool is_similarity(const glm::dmat4& matrix);
// The linear part is not orthonormal.
bool has_scale(const glm::dmat4& matrix);

}  // namespace wavelobe::mitsuba
