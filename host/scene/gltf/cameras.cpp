#include "scene/gltf/cameras.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>

namespace wavelobe::gltf {

namespace {

constexpr double default_width = 1280.0;
constexpr double default_height = 720.0;

// glTF looks along -Z with +X to the right; ours along +z with +x to the left.
glm::mat4 turned(const glm::dmat4& node) {
    glm::dmat4 out(1.0);
    out[0] = glm::dvec4(-glm::normalize(glm::dvec3(node[0])), 0.0);
    out[1] = glm::dvec4(glm::normalize(glm::dvec3(node[1])), 0.0);
    out[2] = glm::dvec4(-glm::normalize(glm::dvec3(node[2])), 0.0);
    out[3] = node[3];
    return glm::mat4(out);
}

// The size asked for; what is not asked for follows the aspect ratio.
void set_film(const PictureSize& size, double aspect, Film& film) {
    double width = size.width;
    double height = size.height;
    if (width == 0 && height == 0) {
        height = default_height;
        width = height * aspect;
        if (width > default_width) {
            width = default_width;
            height = width / aspect;
        }
    } else if (width == 0) {
        width = height * aspect;
    } else if (height == 0) {
        height = width / aspect;
    }
    film.width = film.crop_width = static_cast<int>(std::clamp(std::round(width), 1.0, 65536.0));
    film.height = film.crop_height = static_cast<int>(std::clamp(std::round(height), 1.0, 65536.0));
}

float horizontal_degrees(double vertical, const Film& film) {
    return static_cast<float>(glm::degrees(2.0 * std::atan(std::tan(0.5 * vertical) * film.width / film.height)));
}

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

Box bounding_box(const Scene& scene) {
    Box box;
    for (const Shape& shape : scene.shapes) {
        const auto& mesh = std::get<TriangleMesh>(shape.geometry);
        for (const glm::uvec3& triangle : mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 p = mesh.positions[triangle[k]];
                box.low = glm::min(box.low, p);
                box.high = glm::max(box.high, p);
            }
        }
    }
    return box;
}

// From the front, a little from the right and above, as far away as it takes to see each corner of the box.
void frame_box(const Box& found, Scene& scene) {
    const bool empty = !(found.low.x <= found.high.x);
    const Box box = empty ? Box{glm::dvec3(-1.0), glm::dvec3(1.0)} : found;
    constexpr double vertical = 0.6;
    constexpr double margin = 1.1;
    const glm::dvec3 center = 0.5 * (box.low + box.high);
    const glm::dvec3 backward = glm::normalize(glm::dvec3(0.3, 0.2, 1.0));
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), backward));
    const glm::dvec3 up = glm::cross(backward, right);
    const double half_height = std::tan(0.5 * vertical);
    const double half_width = half_height * scene.film.width / scene.film.height;
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1 ? box.high.x : box.low.x) - center.x, (corner & 2 ? box.high.y : box.low.y) - center.y,
                           (corner & 4 ? box.high.z : box.low.z) - center.z);
        const double sideways = std::max(std::abs(glm::dot(p, right)) / half_width, std::abs(glm::dot(p, up)) / half_height);
        distance = std::max(distance, glm::dot(p, backward) + margin * sideways);
    }
    if (distance <= 0.0) distance = 1.0;
    const double radius = 0.5 * glm::length(box.high - box.low);
    Camera& camera = scene.camera;
    camera.to_world = glm::mat4(glm::vec4(-right, 0), glm::vec4(up, 0), glm::vec4(-backward, 0), glm::vec4(center + distance * backward, 1));
    camera.fov_x_degrees = horizontal_degrees(vertical, scene.film);
    camera.near_clip = static_cast<float>(1e-3 * distance);
    camera.far_clip = static_cast<float>(10.0 * (distance + radius));
}

struct Perspective {
    double vertical = 0.6;
    std::optional<double> aspect;
    double near_clip = 0.01, far_clip = std::numeric_limits<float>::max();
};

Perspective read_perspective(const Element& camera) {
    const Element p = camera.object("perspective");
    Perspective out;
    for (const char* name : {"yfov", "znear"}) p.require(name);
    out.vertical = p.number("yfov", out.vertical, {1e-6, 3.141592});
    if (p.has("aspectRatio")) out.aspect = p.number("aspectRatio", 1.0, {1e-4, 1e4});
    out.near_clip = p.number("znear", out.near_clip, {1e-30, 1e30});
    out.far_clip = p.number("zfar", out.far_clip, {1e-30, 3.5e38});
    if (!(out.near_clip < out.far_clip)) p.fault("`zfar` is not beyond `znear`");
    return out;
}

// Half the width and height that it shows.
struct Orthographic {
    double half_width = 1.0, half_height = 1.0;
    double near_clip = 0.0, far_clip = 1.0;
};

Orthographic read_orthographic(const Element& camera) {
    const Element o = camera.object("orthographic");
    Orthographic out;
    for (const char* name : {"xmag", "ymag", "znear", "zfar"}) o.require(name);
    out.half_width = std::abs(o.number("xmag", 1.0));
    out.half_height = std::abs(o.number("ymag", 1.0));
    if (!(std::min(out.half_width, out.half_height) > 1e-30)) o.fault("shows a picture of no size", "expected `xmag` and `ymag` other than 0");
    out.near_clip = o.number("znear", out.near_clip, {0.0, 1e30});
    out.far_clip = o.number("zfar", out.far_clip, {0.0, 3e38});
    if (!(out.near_clip < out.far_clip)) o.fault("`zfar` is not beyond `znear`");
    return out;
}

void place_perspective(const Perspective& perspective, const PictureSize& size, Scene& scene) {
    set_film(size, perspective.aspect.value_or(default_width / default_height), scene.film);
    scene.camera.fov_x_degrees = horizontal_degrees(perspective.vertical, scene.film);
    scene.camera.near_clip = static_cast<float>(perspective.near_clip);
    scene.camera.far_clip = static_cast<float>(std::min(perspective.far_clip, 3e38));
}

// As of perspective cameras the height is what the file says, and the width follows the picture's.
void place_orthographic(const Orthographic& orthographic, const PictureSize& size, Scene& scene) {
    set_film(size, orthographic.half_width / orthographic.half_height, scene.film);
    const auto half_width = static_cast<float>(orthographic.half_height * scene.film.width / scene.film.height);
    Camera& camera = scene.camera;
    camera.projection = Camera::Projection::orthographic;
    camera.to_world[0] *= half_width;
    camera.to_world[1] *= half_width;
    camera.near_clip = static_cast<float>(orthographic.near_clip);
    camera.far_clip = static_cast<float>(orthographic.far_clip);
}

}  // namespace

void place_camera(Document& document, const NodeTree& tree, const PictureSize& size, Scene& scene) {
    std::vector<std::variant<Perspective, Orthographic>> cameras;
    for (const Element& camera : document.cameras) {
        camera.require("type");
        const std::string type = camera.text("type", "perspective");
        if (type != "perspective" && type != "orthographic")
            camera.fault("type `" + type + "`; expected perspective or orthographic");
        camera.require(type == "orthographic" ? "orthographic" : "perspective");
        if (camera.has("perspective") && camera.has("orthographic")) camera.fault("has both `perspective` and `orthographic`; expected one of them");
        if (type == "orthographic") cameras.emplace_back(read_orthographic(camera));
        else cameras.emplace_back(read_perspective(camera));
    }
    for (const Element& node : document.nodes) node.index("camera", cameras.size(), "cameras");
    for (const std::size_t node : tree.shown) {
        const auto index = document.nodes[node].index("camera", cameras.size(), "cameras");
        if (!index) continue;
        if (std::abs(glm::determinant(glm::dmat3(tree.world[node]))) < 1e-30)
            document.nodes[node].fault("shrinks its camera to nothing", "give it another scale");
        scene.camera.to_world = turned(tree.world[node]);
        if (const auto* perspective = std::get_if<Perspective>(&cameras[*index])) place_perspective(*perspective, size, scene);
        else place_orthographic(std::get<Orthographic>(cameras[*index]), size, scene);
        return;
    }
    document.warn(document.file + ": no camera; the whole scene is framed");
    set_film(size, default_width / default_height, scene.film);
    frame_box(bounding_box(scene), scene);
}

}  // namespace wavelobe::gltf
