#include "scene/gltf/textures.h"

#include <cmath>

#include <fmt/format.h>

#include "scene/file.h"

namespace wavelobe::gltf {

namespace {

constexpr std::int64_t nearest = 9728;

bool is_filter(std::int64_t value) { return value == 9728 || value == 9729 || (value >= 9984 && value <= 9987); }

Wrap wrap_mode(const Element& sampler, const char* name) {
    switch (sampler.whole(name, 10497, 0, 1 << 20)) {
        case 10497: return Wrap::repeat;
        case 33071: return Wrap::clamp;
        case 33648: return Wrap::mirror;
        default: sampler.fault(std::string(name) + " is none of 10497, 33071 and 33648"); return Wrap::repeat;
    }
}

// KHR_texture_transform: translation * rotation * scale, angles counter-clockwise in a picture whose v points down.
glm::mat3 transform_of(const Element& info) {
    const Element t = info.extension("KHR_texture_transform");
    const auto offset = t.vector<2>("offset", {0, 0});
    const auto scale = t.vector<2>("scale", {1, 1});
    const double angle = t.number("rotation", 0.0);
    const auto s = static_cast<float>(std::sin(angle));
    const auto c = static_cast<float>(std::cos(angle));
    const glm::mat3 rotated(glm::vec3(c, -s, 0), glm::vec3(s, c, 0), glm::vec3(offset[0], offset[1], 1));
    return rotated * glm::mat3(glm::vec3(scale[0], 0, 0), glm::vec3(0, scale[1], 0), glm::vec3(0, 0, 1));
}

}  // namespace

std::int64_t uv_set_of(const Element& texture_info) {
    const std::int64_t set = texture_info.whole("texCoord", 0, 0, 1 << 20);
    return texture_info.extension("KHR_texture_transform").whole("texCoord", set, 0, 1 << 20);
}

void Textures::check() {
    for (const Element& sampler : document_.samplers) {
        Bitmap unused;
        wrap_mode(sampler, "wrapS"), wrap_mode(sampler, "wrapT");
        for (const char* name : {"magFilter", "minFilter"})
            if (!is_filter(sampler.whole(name, 9729, 0, 1 << 20))) sampler.fault(std::string(name) + " is no filter");
    }
    for (const Element& texture : document_.textures) {
        texture.index("sampler", document_.samplers.size(), "samplers");
        image_of(texture);
    }
    for (const Element& image : document_.images) {
        image.index("bufferView", document_.views.size(), "buffer views");
        if (image.present() && image.has("uri") == image.has("bufferView"))
            image.fault("expected either a `uri` or a `bufferView`");
        // Found before any work starts, though nothing may use it.
        const std::string uri = image.text("uri");
        if (image.has("uri") && !is_data_uri(uri)) {
            if (const auto path = document_.resolve(uri, image.path() + "/uri")) {
                try {
                    require_file(*path);
                } catch (const InputError& error) {
                    document_.faults.add(error, image.path());
                }
            }
        }
    }
}

void Textures::check_unused() {
    std::vector<bool> plain(document_.images.size(), false);
    for (const Element& texture : document_.textures)
        if (const auto source = texture.index("source", plain.size(), "images")) plain[*source] = true;
    for (const auto& [key, bitmap] : images_) plain[key.first] = false;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        if (!plain[i]) continue;
        try {
            read_image(document_.images[i], Transfer::linear);
        } catch (const InputError& error) {
            document_.faults.add(error, document_.images[i].path());
        }
    }
}

// A texture may offer other formats by extensions; the plain one is read.
std::optional<std::size_t> Textures::image_of(const Element& texture) {
    return texture.index("source", document_.images.size(), "images");
}

// One without a plain image, by the extensions that name another.
void Textures::warn_of_formats(const Element& texture) {
    std::string names;
    for (const std::string& name : texture.object("extensions").keys()) names += (names.empty() ? "" : ", ") + name;
    document_.warn(fmt::format("{}: {}: has no PNG or JPEG image{} and is passed over", document_.file, texture.path(),
                               names.empty() ? "" : ", only one of " + names));
}

Bitmap Textures::read_image(const Element& image, Transfer transfer) {
    std::string name = document_.file + ": " + image.path();
    if (const auto view = image.index("bufferView", document_.views.size(), "buffer views")) {
        if (!document_.views[*view].readable) return {};
        return decode_image(name, std::string(document_.views[*view].bytes), transfer);
    }
    const std::string uri = image.text("uri");
    if (is_data_uri(uri)) {
        const auto content = document_.decode_data_uri(uri, image.path() + "/uri");
        return content ? decode_image(name, *content, transfer) : Bitmap{};
    }
    const auto path = document_.resolve(uri, image.path() + "/uri");
    return path ? decode_image(*path, read_file(*path), transfer) : Bitmap{};
}

const Bitmap* Textures::image(std::size_t index, Transfer transfer) {
    std::unique_ptr<Bitmap>& slot = images_[{index, transfer}];
    if (!slot) {
        slot = std::make_unique<Bitmap>();
        try {
            *slot = read_image(document_.images[index], transfer);
        } catch (const InputError& error) {
            document_.faults.add(error, document_.images[index].path());
        }
    }
    return slot->rgb.empty() ? nullptr : slot.get();
}

void Textures::set_sampler(const Element& texture, Bitmap& bitmap) {
    const auto index = texture.index("sampler", document_.samplers.size(), "samplers");
    if (!index) return;
    const Element& sampler = document_.samplers[*index];
    bitmap.filter = sampler.whole("magFilter", 9729, 0, 1 << 20) == nearest ? Filter::nearest : Filter::bilinear;
    bitmap.wrap = wrap_mode(sampler, "wrapS");
    bitmap.row_wrap = wrap_mode(sampler, "wrapT");
}

std::shared_ptr<const Texture> Textures::use(const Element& info, Transfer transfer, const Rgb& factor, bool second_uvs) {
    if (!info.present()) return nullptr;
    info.require("index");
    const auto index = info.index("index", document_.textures.size(), "textures");
    if (!index) return nullptr;
    const auto source = image_of(document_.textures[*index]);
    if (!source) {
        if (!document_.textures[*index].has("source")) warn_of_formats(document_.textures[*index]);
        return nullptr;
    }
    const glm::mat3 to_uv = transform_of(info);
    std::string key;
    for (int i = 0; i < 9; ++i) key += fmt::format("{} ", to_uv[i / 3][i % 3]);
    for (int i = 0; i < 3; ++i) key += fmt::format("{} ", factor[i]);
    if (second_uvs) key += "second";
    std::shared_ptr<const Texture>& known = textures_[{*index, transfer, key}];
    if (!known) {
        const Bitmap* bitmap = image(*source, transfer);
        if (bitmap == nullptr) return nullptr;
        auto texture = std::make_shared<Texture>();
        Bitmap copy = *bitmap;
        if (factor != Rgb(1.0F))
            for (std::size_t i = 0; i < copy.rgb.size(); ++i) copy.rgb[i] *= factor[static_cast<int>(i % 3)];
        set_sampler(document_.textures[*index], copy);
        texture->source = std::move(copy);
        texture->to_uv = to_uv;
        texture->second_uvs = second_uvs;
        texture->name = document_.images[*source].text("name", fmt::format("image {}", *source));
        known = std::move(texture);
    }
    return known;
}

}  // namespace wavelobe::gltf
