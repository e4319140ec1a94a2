// The operations inside a <transform>.
#include "scene/mitsuba/transforms.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace wavelobe::mitsuba {

namespace {

// Inner products of the rows of the linear part.
glm::dmat3 row_products(const glm::dmat4& matrix) {
    const glm::dmat3 linear(matrix);
    return linear * glm::transpose(linear);
}

}  // namespace

glm::dmat4 translation(const glm::dvec3& offset) { return glm::translate(glm::dmat4(1.0), offset); }

glm::dmat4 scaling(const glm::dvec3& factors) { return glm::scale(glm::dmat4(1.0), factors); }

glm::dmat4 rotation(const glm::dvec3& axis, double degrees) {
    const double angle = glm::radians(degrees), c = std::cos(angle), s = std::sin(angle);
    // Rodrigues' formula: c I + s [axis] + (1 - c) axis axis^T.
    const glm::dmat3 across(0.0, axis.z, -axis.y, -axis.z, 0.0, axis.x, axis.y, -axis.x, 0.0);
    return glm::dmat4(glm::dmat3(c) + s * across + (1.0 - c) * glm::outerProduct(axis, axis));
}

std::optional<glm::dmat4> look_at(const glm::dvec3& origin, const glm::dvec3& target, glm::dvec3 up) {
    const glm::dvec3 forward = glm::normalize(target - origin);
    if (up == glm::dvec3(0.0)) up = coordinate_system(forward).s;
    const glm::dvec3 left = glm::normalize(glm::cross(up, forward));
    if (!std::isfinite(forward.x) || !std::isfinite(left.x)) return std::nullopt;
    return glm::dmat4(glm::dvec4(left, 0.0), glm::dvec4(glm::cross(forward, left), 0.0), glm::dvec4(forward, 0.0),
                      glm::dvec4(origin, 1.0));
}

// The branchless construction of Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017).
Tangents coordinate_system(const glm::dvec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

bool is_invertible_affine(const glm::dmat4& matrix) {
    const glm::dvec4 last_row(matrix[0].w, matrix[1].w, matrix[2].w, matrix[3].w);
    const glm::dmat4 inverse = glm::inverse(matrix);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            const double most = std::max(std::abs(matrix[column][row]), std::abs(inverse[column][row]));
            if (!(most <= 1e30)) return false;  // NaN, too
        }
    }
    return last_row == glm::dvec4(0.0, 0.0, 0.0, 1.0) && glm::determinant(matrix) != 0.0;
}

bool is_similarity(const glm::dmat4& matrix) {
    const glm::dmat3 products = row_products(matrix);
    const double square = (products[0][0] + products[1][1] + products[2][2]) / 3.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(products[i][j] - (i == j ? square : 0.0)) > square * 1e-3) return false;
    return square > 0.0;
}

bool has_scale(const glm::dmat4& matrix) {
    const glm::dmat3 products = row_products(matrix);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(products[i][j] - (i == j ? 1.0 : 0.0)) > 1e-3) return true;
    return false;
}

}  // namespace wavelobe::mitsuba
