#include "scene/projection.h"

#include <cmath>

namespace wavelobe {

glm::dmat4 world_to_camera(const Camera& camera) {
    const glm::dmat4 to_local = glm::inverse(glm::dmat4(camera.to_world));
    glm::dmat4 mirror(1.0);  // the scene's cameras have +x to the left
    mirror[0][0] = -1.0;
    return mirror * to_local;
}

glm::dmat4 world_to_ndc(const Camera& camera, const Film& film) {
    const bool orthographic = camera.projection == Camera::Projection::orthographic;
    const double cotangent = orthographic ? 1.0 : 1.0 / std::tan(0.5 * camera.fov_x_degrees * (3.14159265358979323846 / 180.0));
    const double aspect = static_cast<double>(film.width) / film.height;
    const double near_clip = camera.near_clip;
    const double far_clip = camera.far_clip;
    glm::dmat4 projection(0.0);  // [column][row]
    projection[0][0] = 0.5 * cotangent;
    projection[1][1] = -0.5 * aspect * cotangent;
    if (orthographic) {
        projection[3] = {0.5, 0.5, -near_clip / (far_clip - near_clip), 1.0};
        projection[2][2] = 1.0 / (far_clip - near_clip);
        return projection * world_to_camera(camera);
    }
    // The fourth row copies z to divide by.
    projection[2][0] = 0.5 - camera.principal_point_offset.x;
    projection[2][1] = 0.5 - camera.principal_point_offset.y;
    projection[2][2] = far_clip / (far_clip - near_clip);
    projection[3][2] = -near_clip * far_clip / (far_clip - near_clip);
    projection[2][3] = 1.0;
    return projection * world_to_camera(camera);
}

}  // namespace wavelobe
