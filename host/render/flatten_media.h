// Media as the kernels see them.
#pragma once

#include "render/flatten.h"

namespace wavelobe {

// Fills the media of a device scene, and of each shape what it parts; both stay empty where nothing absorbs.
class MediaFlattener {
public:
    MediaFlattener(const Scene& scene, DeviceScene& out);

    // Of every shape in order; the flags say what it does.
    std::uint32_t add_shape(const Shape& shape, bool there);
    // Whether the shape must be found by rays although nothing of it can be seen.
    bool parts_media(const Shape& shape) const { return absorbs_ && shape.media.has_value(); }

private:
    DeviceScene& out_;
    bool absorbs_ = false;
};

}  // namespace wavelobe
