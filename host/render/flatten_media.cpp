#include "render/flatten_media.h"

#include <algorithm>

#include "scene/fault.h"

namespace wavelobe {
namespace {

std::uint32_t device_medium(int medium) { return medium < 0 ? MEDIUM_VACUUM : static_cast<std::uint32_t>(medium) + 1; }

}  // namespace

MediaFlattener::MediaFlattener(const Scene& scene, DeviceScene& out) : out_(out) {
    std::vector<int> used{scene.camera_medium};
    const auto use = [&used](const std::vector<Shape>& shapes) {
        for (const Shape& shape : shapes) {
            if (shape.media) used.insert(used.end(), {shape.media->interior, shape.media->exterior});
        }
    };
    use(scene.shapes);
    for (const ShapeGroup& group : scene.groups) use(group.shapes);
    absorbs_ = std::any_of(used.begin(), used.end(), [&scene](int medium) {
        return medium >= 0 && scene.media.at(static_cast<std::size_t>(medium)).absorption != Rgb{0.0F};
    });
    if (!absorbs_) return;
    out_.features.media = true;
    out_.parameters.camera_medium = device_medium(scene.camera_medium);
    out_.media.push_back({{0.0F, 0.0F, 0.0F}});
    for (const Medium& medium : scene.media) {
        const Rgb& a = medium.absorption;
        out_.media.push_back({{a.x, a.y, a.z}});
    }
}

std::uint32_t MediaFlattener::add_shape(const Shape& shape, bool there) {
    if (!absorbs_) return 0;
    if (!shape.media) {
        out_.shape_media.push_back({MEDIUM_VACUUM, MEDIUM_VACUUM});
        return 0;
    }
    out_.shape_media.push_back({device_medium(shape.media->interior), device_medium(shape.media->exterior)});
    if (there) return SHAPE_PARTS_MEDIA;
    out_.features.clear_boundaries = true;
    return SHAPE_PARTS_MEDIA | SHAPE_CLEAR;
}

}  // namespace wavelobe
