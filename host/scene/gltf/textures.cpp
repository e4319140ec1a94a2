#include "scene/gltf/textures.h"

#include <cmath>

#include <fmt/format.h>

#include "scene/file.h"

namespace wavelobe::gltf {

namespace {

constexpr std::int64_t nearest = 9728;

// By the first bytes; empty where they are of none of those that glTF and its extensions know.
std::string type_of(const std::string& content) {
    if (content.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
    if (content.starts_with("\xff\xd8")) return "image/jpeg";
    if (content.starts_with("RIFF") && content.substr(8, 4) == "WEBP") return "image/webp";
    if (content.starts_with("\xabKTX 20\xbb\r\n\x1a\n")) return "image/ktx2";
    return {};
}

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
        for (const char* other : {"EXT_texture_webp", "KHR_texture_basisu"}) texture.extension(other).index("source", document_.images.size(), "images");
    }
    for (const Element& image : document_.images) {
        const auto view = image.index("bufferView", document_.views.size(), "buffer views");
        if (image.has("bufferView")) image.require("mimeType");
        if (view && document_.views[*view].stride > 0) image.fault(fmt::format("is in buffer view {}, which has a `byteStride`; only vertices may have one", *view));
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
    std::vector<bool> read(document_.images.size(), false);
    for (const auto& [key, bitmap] : images_) read[key.first] = true;
    bool has_webp = false;
    for (const std::string& name : document_.root.texts("extensionsUsed")) has_webp = has_webp || name == "EXT_texture_webp";
    for (std::size_t i = 0; i < plain.size(); ++i) {
        if (read[i]) continue;
        try {
            const auto content = content_of(document_.images[i]);
            const std::string type = content ? type_of(*content) : "";
            if (type == "image/webp" && !has_webp) document_.images[i].fault("is WebP, which `extensionsUsed` does not allow", "expected PNG or JPEG");
            if (plain[i] || type == "image/png" || type == "image/jpeg") read_image(document_.images[i], Transfer::linear);
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

std::optional<std::string> Textures::content_of(const Element& image) {
    if (const auto view = image.index("bufferView", document_.views.size(), "buffer views")) {
        if (!document_.views[*view].readable) return {};
        return std::string(document_.views[*view].bytes);
    }
    const std::string uri = image.text("uri");
    if (is_data_uri(uri)) return document_.decode_data_uri(uri, image.path() + "/uri");
    const auto path = document_.resolve(uri, image.path() + "/uri");
    return path ? std::optional(read_file(*path)) : std::nullopt;
}

Bitmap Textures::read_image(const Element& image, Transfer transfer) {
    const auto content = content_of(image);
    if (!content) return {};
    const std::string uri = image.text("uri");
    const bool beside = image.has("uri") && !is_data_uri(uri);
    // A type that the file states and the bytes are not of.
    const std::string found = type_of(*content);
    for (const std::string& stated : {image.text("mimeType"), is_data_uri(uri) ? data_type(uri) : std::string()})
        if (!found.empty() && stated.starts_with("image/") && stated != found)
            image.fault("is stated to be " + stated.substr(0, 100) + ", and its bytes are " + found);
    return decode_image(beside ? document_.resolve(uri, image.path() + "/uri").value_or(uri) : document_.file + ": " + image.path(), *content, transfer);
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
