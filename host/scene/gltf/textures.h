// Textures of a glTF document: images, samplers, and the transform of their coordinates.
#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "scene/gltf/document.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace wavelobe::gltf {

// A reference to a texture, as a material has it.
struct TextureUse {
    std::shared_ptr<const Texture> texture;  // null: none, or a faulty one
    std::int64_t uv_set = 0;
};

class Textures {
public:
    explicit Textures(Document& document) : document_(document) {}

    // Checks all textures, samplers and images but the contents of images that nothing uses.
    void check();
    // The texture that member `name` of `owner` names. Each image is read once for each use of its channels.
    TextureUse use(const Element& owner, const char* name, Transfer transfer);
    // The same, each texel scaled.
    TextureUse scaled(const Element& owner, const char* name, Transfer transfer, const Rgb& factor);

private:
    std::optional<std::size_t> image_of(const Element& texture);
    const Bitmap* image(std::size_t index, Transfer transfer);
    Bitmap read_image(const Element& image, Transfer transfer);
    void set_sampler(const Element& texture, Bitmap& bitmap);

    Document& document_;
    std::map<std::pair<std::size_t, Transfer>, std::unique_ptr<Bitmap>> images_;
    // By texture, use and transform.
    std::map<std::tuple<std::size_t, Transfer, std::string>, std::shared_ptr<const Texture>> textures_;
};

}  // namespace wavelobe::gltf
