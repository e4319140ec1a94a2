// Textures of a glTF document: images, samplers, and the transform of their coordinates.
#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "scene/gltf/document.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace wavelobe::gltf {

// The set of coordinates that a reference to a texture looks up.
std::int64_t uv_set_of(const Element& texture_info);

class Textures {
public:
    explicit Textures(Document& document) : document_(document) {}

    // Checks all textures, samplers and images but the contents of images that nothing uses.
    void check();
    // Decodes the images that nothing has asked for, to find what is damaged: those that textures name, and PNG and JPEG ones.
    void check_unused();
    // The texture of a reference, each texel scaled; null where there is none, or a faulty one. Each image is read once for each
    // use of its channels.
    std::shared_ptr<const Texture> use(const Element& texture_info, Transfer transfer, const Rgb& factor, bool second_uvs);

private:
    std::optional<std::size_t> image_of(const Element& texture);
    const Bitmap* image(std::size_t index, Transfer transfer);
    void warn_of_formats(const Element& texture);
    // The bytes of an image; nothing after a fault.
    std::optional<std::string> content_of(const Element& image);
    Bitmap read_image(const Element& image, Transfer transfer);
    void set_sampler(const Element& texture, Bitmap& bitmap);

    Document& document_;
    std::map<std::pair<std::size_t, Transfer>, std::unique_ptr<Bitmap>> images_;
    // By texture, use, transform, factor and set of coordinates.
    std::map<std::tuple<std::size_t, Transfer, std::string>, std::shared_ptr<const Texture>> textures_;
};

}  // namespace wavelobe::gltf
