// Whether opacity takes anything off a shape.
#pragma once

#include <map>

#include "scene/scene.h"

namespace wavelobe {

enum class Presence { absent, partial, whole };

// Of a shape, wherever on it. Remembers what it has found of textures.
class PresenceFinder {
public:
    Presence find(const Shape& shape);

private:
    struct Range {
        float low, high;
    };
    Range texture_range(const Texture& texture);

    std::map<const Texture*, Range> ranges_;
};

}  // namespace wavelobe
