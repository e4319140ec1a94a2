// The texture plugins.
#include <array>

#include <fmt/format.h>

#include "scene/image.h"
#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

namespace {

using Result = std::shared_ptr<const Texture>;

// The linear part of x and y, and the translation.
glm::mat3 uv_transform(Query& query) {
    const glm::dmat4 matrix = query.transform("to_uv");
    return glm::mat3(glm::dmat3(glm::dvec3(matrix[0][0], matrix[0][1], 0.0),
                                glm::dvec3(matrix[1][0], matrix[1][1], 0.0),
                                glm::dvec3(matrix[3][0], matrix[3][1], 1.0)));
}

std::string key_of(const glm::mat3& matrix) {
    std::string key;
    for (int i = 0; i < 3; ++i) key += fmt::format(" {} {}", matrix[i][0], matrix[i][1]);
    return key;
}

Result read_bitmap(Query& query, TextureUse use) {
    const std::string path = query.file("filename");
    const bool raw = query.boolean("raw", false);
    Bitmap options;
    options.filter =
        query.choice("filter_type", {"nearest", "bilinear"}, 1) == 0 ? Filter::nearest : Filter::bilinear;
    options.wrap = static_cast<Wrap>(query.choice("wrap_mode", {"repeat", "mirror", "clamp"}, 0));
    const glm::mat3 to_uv = uv_transform(query);
    query.choice("format", {"auto", "variant", "float16", "fp16", "uint8"}, 0);
    query.boolean("accel", true);
    if (path.empty()) return nullptr;

    const std::string key = fmt::format("{}|{}|{}|{}|{}|{}", path, raw, static_cast<int>(options.filter),
                                        static_cast<int>(options.wrap), static_cast<int>(use), key_of(to_uv));
    Result& known = query.context().bitmaps[key];
    if (known != nullptr) return known;
    try {
        Bitmap bitmap = load_image(path, raw ? Transfer::linear : Transfer::of_format);
        bitmap.filter = options.filter;
        bitmap.wrap = options.wrap;
        if (use == TextureUse::scalar) reduce_to_luminance(bitmap);
        known = std::make_shared<Texture>(Texture{std::move(bitmap), to_uv, query.object().id});
    } catch (const InputError& error) {
        query.context().faults.add(error, query.object().place, query.object().label());
    }
    return known;
}

Result read_checkerboard(Query& query, TextureUse use) {
    Checkerboard board;
    board.color0 = query.colour("color0", 0.4, ColourUse::reflectance);
    board.color1 = query.colour("color1", 0.2, ColourUse::reflectance);
    const glm::mat3 to_uv = uv_transform(query);
    // Scalar look-ups of Mitsuba take the mean of a colour, and see the two fields the other way round.
    if (use == TextureUse::scalar) {
        const auto mean = [](const Rgb& rgb) { return Rgb((rgb.r + rgb.g + rgb.b) / 3.0F); };
        board = {mean(board.color1), mean(board.color0)};
    }
    return std::make_shared<Texture>(Texture{board, to_uv, query.object().id});
}

Result read_mesh_attribute(Query& query, TextureUse use) {
    const std::string name = query.text("name", "");
    const auto scale = static_cast<float>(query.real("scale", 1.0));
    if (!name.starts_with("vertex_") && !name.starts_with("face_")) {
        query.fault_at("name", "`name` is `" + name + "`; expected that of an attribute of the shape's mesh, such as `vertex_color` or `face_color`", "");
        return nullptr;
    }
    Context& context = query.context();
    const Result texture = context.mesh_attributes.add_texture(name, scale, query.object().id);
    context.attribute_textures[texture.get()] = {name, use == TextureUse::scalar};
    return texture;
}

struct Plugin {
    const char* name;
    Result (*read)(Query&, TextureUse);
};
constexpr std::array<Plugin, 3> plugins{{
    {"bitmap", read_bitmap},
    {"checkerboard", read_checkerboard},
    {"mesh_attribute", read_mesh_attribute},
}};

// Whoever uses the texture asks for its attribute.
Result used(Context& context, const Result& texture) {
    const auto attribute = context.attribute_textures.find(texture.get());
    if (attribute != context.attribute_textures.end()) context.attributes.insert(attribute->second);
    return texture;
}

}  // namespace

Result read_texture(Context& context, const Object& object, TextureUse use) {
    auto& known = use == TextureUse::colour ? context.textures : context.scalar_textures;
    const auto [entry, fresh] = known.try_emplace(&object);
    if (!fresh) return used(context, entry->second);
    if (object.tag != "texture" && object.tag != "spectrum") {
        context.faults.add(object.place, object.label(), "a " + object.tag + " cannot take the place of a colour",
                           "nest a <texture> or give the value as <rgb>");
        return nullptr;
    }
    if (object.type == "d65")
        for (const Child& child : object.children)
            if (child.object != nullptr) return entry->second = read_texture(context, *child.object, use);
    const auto* plugin = find_plugin(context, object, plugins);
    if (plugin == nullptr) return nullptr;
    Query query(context, object);
    entry->second = plugin->read(query, use);
    query.finish();
    return used(context, entry->second);
}

std::vector<std::string> texture_types() { return names_of(plugins); }

}  // namespace wavelobe::mitsuba
