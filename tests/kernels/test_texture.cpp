// Texture look-ups: against values of Mitsuba 3.9, against double precision, and as parameters of materials.
#include <bit>
#include <limits>

#include "support/lobe_test.h"

namespace wavelobe::test {
namespace {

struct Uv {
    float u, v;
};

// Looks textures up by number, and material parameters by theirs.
class TextureProbe {
public:
    explicit TextureProbe(int lanes = 16) : lanes_(lanes), probe_(source, {.lanes = lanes, .defines = ""}) {}

    std::vector<glm::vec3> colours(const std::vector<Texture>& textures, const std::vector<float>& texels,
                                   const std::vector<std::uint32_t>& index, const std::vector<Uv>& uvs) {
        return run("colours", white_materials(textures.size()), textures, texels, index, uvs);
    }

    // load_rgb of diffuse, or load_float of alpha_u three times.
    std::vector<glm::vec3> parameters(const char* kernel, const std::vector<Material>& materials,
                                      const std::vector<Texture>& textures, const std::vector<float>& texels,
                                      const std::vector<std::uint32_t>& index, const std::vector<Uv>& uvs) {
        return run(kernel, materials, textures, texels, index, uvs);
    }

private:
    static std::vector<Material> white_materials(std::size_t n) { return std::vector<Material>(n, white_material()); }

    std::vector<glm::vec3> run(const char* kernel, const std::vector<Material>& materials,
                               const std::vector<Texture>& textures, const std::vector<float>& texels,
                               std::vector<std::uint32_t> index, const std::vector<Uv>& uvs) {
        const std::size_t n = (uvs.size() + 15) / 16 * 16;
        index.resize(n, 0);
        std::vector<float> in(2 * n, 0.0F);
        for (std::size_t i = 0; i < uvs.size(); ++i) {
            in[i] = uvs[i].u;
            in[n + i] = uvs[i].v;
        }
        std::vector<float> out(3 * n);
        const auto count = static_cast<std::uint32_t>(n);
        const std::vector<float>& input = in;
        const std::vector<std::uint32_t>& indices = index;
        probe_.run(kernel, n / static_cast<std::size_t>(lanes_), materials, textures, texels, indices, input, out, count);
        std::vector<glm::vec3> results(uvs.size());
        for (std::size_t i = 0; i < results.size(); ++i) results[i] = {out[i], out[n + i], out[2 * n + i]};
        return results;
    }

    static constexpr const char* source = R"(
        #define HAS_TEXTURES 1
        #include "bsdf/lobe.h"
        #define PARAMETERS global const struct Material *materials, global const struct Texture *textures,      \
            global const float *texels, global const uint *index, global const float *uv, global float *out, uint n
        #define BEGIN                                                                                            \
            size_t i = get_global_id(0) * LANES;                                                                 \
            MaterialInput in = {as_UInt(load((global const float *)index + i)), load(uv + i), load(uv + n + i),  \
                                materials, textures, texels};
        #define END(value) store(out + i, (value).x); store(out + n + i, (value).y); store(out + 2 * n + i, (value).z);
        kernel void colours(PARAMETERS) {
            BEGIN
            TextureBuffers b = {textures, texels};
            Rgb value = texture_rgb(b, in.material, in.u, in.v);
            END(value)
        }
        kernel void rgb(PARAMETERS) {
            BEGIN
            Rgb value = load_rgb(in, diffuse);
            END(value)
        }
        kernel void scalar(PARAMETERS) {
            BEGIN
            Rgb value = vec3_all(load_float(in, alpha_u));
            END(value)
        })";
    int lanes_;
    Probe probe_;
};

constexpr float identity[6] = {1, 0, 0, 0, 1, 0};

Texture bitmap(Uint32 flags, Uint32 width, Uint32 height, Uint32 first_texel, const float (&to_uv)[6] = identity) {
    Texture t{};
    t.kind = TEXTURE_BITMAP | flags;
    t.first_texel = first_texel;
    t.width = width;
    t.height = height;
    std::copy(std::begin(to_uv), std::end(to_uv), t.to_uv);
    return t;
}

Texture checkerboard(Packed3 color0, Packed3 color1, const float (&to_uv)[6] = identity) {
    Texture t{};
    t.kind = TEXTURE_CHECKERBOARD;
    t.color0 = color0;
    t.color1 = color1;
    std::copy(std::begin(to_uv), std::end(to_uv), t.to_uv);
    return t;
}

// Two columns and three rows; blue is 10 row + column.
const std::vector<float> small_image{0, 0, 0, 0, 1, 1, 1, 0, 10, 1, 1, 11, 2, 0, 20, 2, 1, 21};
// Scaled by (2, 1/2), turned by 30 degrees, moved by (0.3, -0.1).
constexpr float transform[6] = {1.7320508F, -0.25F, 0.3F, 1.0F, 0.4330127F, -0.1F};
const std::vector<Uv> points{{0.1F, 0.1F}, {0.9F, 0.2F}, {0.15F, 0.9F}, {0.47F, 0.53F}, {1.1F, 1.15F},
                             {-0.1F, -0.12F}, {2.3F, 0.02F}, {0.02F, 1.98F}, {-1.2F, -2.3F}};

// Blue of small_image under `transform` at `points`, as Mitsuba 3.9.1 (scalar_rgb, raw bitmap) looks it up.
struct MitsubaValues {
    Uint32 flags;
    std::vector<float> blue;
};
const std::vector<MitsubaValues> mitsuba_values{
    {TEXTURE_NEAREST, {0, 21, 10, 11, 11, 20, 0, 21, 21}},
    {TEXTURE_NEAREST | TEXTURE_WRAP_MIRROR, {0, 20, 10, 11, 10, 0, 0, 20, 1}},
    {TEXTURE_NEAREST | TEXTURE_WRAP_CLAMP, {0, 21, 10, 11, 21, 0, 21, 20, 0}},
    {0,
     {7.798334F, 17.68615F, 8.360958F, 13.52177F, 10.60343F, 17.62756F, 1.317246F, 19.14167F, 17.02904F}},
    {TEXTURE_WRAP_MIRROR,
     {0.3964102F, 20.0F, 8.360958F, 13.9849F, 10.06106F, 2.558846F, 1.317246F, 18.32095F, 4.877878F}},
    {TEXTURE_WRAP_CLAMP, {0.3964102F, 21.0F, 8.360958F, 13.9849F, 21.0F, 0.0F, 21.0F, 18.32095F, 0.0F}},
};

TEST(Texture, BitmapsMatchMitsuba) {
    TextureProbe probe;
    for (const MitsubaValues& values : mitsuba_values) {
        const std::vector<glm::vec3> colours =
            probe.colours({bitmap(values.flags, 2, 3, 0, transform)}, small_image, std::vector<std::uint32_t>(9, 0), points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            // Mitsuba's values are printed with seven digits; texture coordinates differ by rounding.
            EXPECT_NEAR(colours[i].z, values.blue[i], 2e-5) << values.flags << " at " << points[i].u << ", " << points[i].v;
        }
    }
}

TEST(Texture, CheckerboardMatchesMitsuba) {
    TextureProbe probe;
    const Texture board = checkerboard({1, 2, 3}, {4, 5, 6}, transform);
    const std::vector<glm::vec3> colours = probe.colours({board}, {0.0F}, std::vector<std::uint32_t>(9, 0), points);
    const int first[] = {1, 1, 1, 1, 0, 0, 1, 1, 1};
    Material m = white_material();
    m.alpha_u.texture = 0;
    const std::vector<glm::vec3> scalars =
        probe.parameters("scalar", {m}, {board}, {0.0F}, std::vector<std::uint32_t>(9, 0), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(colours[i], first[i] ? glm::vec3(1, 2, 3) : glm::vec3(4, 5, 6)) << i;
        EXPECT_EQ(scalars[i].x, first[i] ? 1.0F : 4.0F) << i;
    }
    // Borders belong to the lower field.
    EXPECT_EQ(probe.colours({checkerboard({1, 1, 1}, {2, 2, 2})}, {0.0F}, {0, 0, 0},
                            {{0.5F, 0.1F}, {0.50001F, 0.1F}, {1.0F, 0.1F}}),
              (std::vector<glm::vec3>{glm::vec3(1), glm::vec3(2), glm::vec3(1)}));
}

// ---- double precision -----------------------------------------------------------------------------------

int wrap(int i, int n, Uint32 kind) {
    if (kind & TEXTURE_WRAP_CLAMP) return std::clamp(i, 0, n - 1);
    const int remainder = ((i % n) + n) % n;
    const int period = (i - remainder) / n;
    return (kind & TEXTURE_WRAP_MIRROR) && period % 2 != 0 ? n - 1 - remainder : remainder;
}

glm::dvec3 look_up(const Texture& t, const std::vector<float>& texels, const Uv& uv) {
    const double u = static_cast<double>(t.to_uv[0]) * uv.u + static_cast<double>(t.to_uv[1]) * uv.v + t.to_uv[2];
    const double v = static_cast<double>(t.to_uv[3]) * uv.u + static_cast<double>(t.to_uv[4]) * uv.v + t.to_uv[5];
    const int width = static_cast<int>(t.width);
    const int height = static_cast<int>(t.height);
    const auto texel = [&](double column, double row) {
        const int x = wrap(static_cast<int>(column), width, t.kind);
        const int y = wrap(static_cast<int>(row), height, t.kind);
        const std::size_t at = t.first_texel + 3 * (static_cast<std::size_t>(y) * t.width + static_cast<std::size_t>(x));
        return glm::dvec3(texels[at], texels[at + 1], texels[at + 2]);
    };
    if (t.kind & TEXTURE_NEAREST) return texel(std::floor(u * width), std::floor(v * height));
    const double x = u * width - 0.5;
    const double y = v * height - 0.5;
    const double i = std::floor(x);
    const double j = std::floor(y);
    return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), x - i), glm::mix(texel(i, j + 1), texel(i + 1, j + 1), x - i),
                    y - j);
}

struct Scene {
    std::vector<Texture> textures;
    std::vector<float> texels;
};

// Textures of many sizes, all filters and wrap modes, one after the other in the same array of texels.
Scene random_scene(Random& random) {
    Scene scene;
    const std::pair<Uint32, Uint32> sizes[] = {{1, 1}, {1, 5}, {7, 1}, {2, 2}, {13, 31}, {64, 64}, {1000, 3}};
    for (const auto& [width, height] : sizes) {
        for (Uint32 filter : {0U, TEXTURE_NEAREST}) {
            for (Uint32 mode : {0U, TEXTURE_WRAP_MIRROR, TEXTURE_WRAP_CLAMP}) {
                const auto first = static_cast<Uint32>(scene.texels.size());
                scene.textures.push_back(scene.textures.size() % 2 ? bitmap(filter | mode, width, height, first, transform)
                                                                   : bitmap(filter | mode, width, height, first));
                for (Uint32 i = 0; i < 3 * width * height; ++i) scene.texels.push_back(random.uniform());
            }
        }
    }
    return scene;
}

TEST(Texture, BitmapsMatchDoublePrecision) {
    Random random(1);
    const Scene scene = random_scene(random);
    std::vector<std::uint32_t> index;
    std::vector<Uv> uvs;
    for (std::uint32_t i = 0; i < 100000; ++i) {
        index.push_back(static_cast<std::uint32_t>(random.uniform() * static_cast<float>(scene.textures.size())));
        const float reach = i % 3 == 0 ? 10.0F : 1.0F;
        uvs.push_back({random.between(-reach, reach), random.between(-reach, reach)});
    }
    const std::vector<glm::vec3> colours = TextureProbe().colours(scene.textures, scene.texels, index, uvs);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < uvs.size(); ++i) {
        const Texture& t = scene.textures[index[i]];
        const glm::dvec3 expected = look_up(t, scene.texels, uvs[i]);
        // Texel coordinates reach a few thousand: rounding moves the point, by a texel at borders for the nearest.
        double slack = 0.0;
        const double step = 4 * 0x1p-24 * 40.0;
        for (const auto& [du, dv] : {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
            const Uv moved{static_cast<float>(uvs[i].u + du), static_cast<float>(uvs[i].v + dv)};
            slack = std::max(slack, glm::length(look_up(t, scene.texels, moved) - expected));
        }
        if (slack > 0.1) continue;  // at a border
        ++compared;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(colours[i][c], expected[c], 4 * 0x1p-24 + 2.0 * slack) << index[i];
    }
    EXPECT_GT(compared, uvs.size() * 9 / 10);
}

// Texel centres are the texels, exactly.
TEST(Texture, CentresAreExact) {
    TextureProbe probe;
    for (Uint32 flags : {0U, TEXTURE_NEAREST}) {
        for (Uint32 row = 0; row < 3; ++row) {
            for (Uint32 column = 0; column < 2; ++column) {
                const Uv centre{(static_cast<float>(column) + 0.5F) / 2.0F, (static_cast<float>(row) + 0.5F) / 3.0F};
                const glm::vec3 c = probe.colours({bitmap(flags, 2, 3, 0)}, small_image, {0}, {centre})[0];
                EXPECT_NEAR(c.z, static_cast<float>(10 * row + column), 8 * 0x1p-24 * 20.0);
            }
        }
    }
}

TEST(Texture, ParametersAreTexturedLaneByLane) {
    TextureProbe probe;
    const std::vector<Texture> textures{checkerboard({0.1F, 0.2F, 0.3F}, {0.4F, 0.5F, 0.6F}),
                                        bitmap(TEXTURE_NEAREST, 2, 3, 0)};
    std::vector<Material> materials(3, white_material());
    materials[0].diffuse.value = {0.7F, 0.8F, 0.9F};
    materials[0].alpha_u.value = 0.25F;
    materials[1].diffuse.texture = materials[1].alpha_u.texture = 1;
    materials[2].diffuse.texture = materials[2].alpha_u.texture = 0;
    const std::vector<std::uint32_t> index{0, 1, 2, 0};
    const std::vector<Uv> uvs(4, Uv{0.8F, 0.9F});
    EXPECT_EQ(probe.parameters("rgb", materials, textures, small_image, index, uvs),
              (std::vector<glm::vec3>{{0.7F, 0.8F, 0.9F}, {2, 1, 21}, {0.1F, 0.2F, 0.3F}, {0.7F, 0.8F, 0.9F}}));
    EXPECT_EQ(probe.parameters("scalar", materials, textures, small_image, index, uvs),
              (std::vector<glm::vec3>{glm::vec3(0.25F), glm::vec3(2.0F), glm::vec3(0.1F), glm::vec3(0.25F)}));
}

// Coordinates that are no numbers, or too large for exact texel numbers, still read texels of the image.
TEST(Texture, StrangeCoordinatesStayInside) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> texels(3, -1.0F);  // before and after the image
    texels.insert(texels.end(), small_image.begin(), small_image.end());
    texels.insert(texels.end(), 3, -1.0F);
    std::vector<Texture> textures;
    for (Uint32 flags : {0U, TEXTURE_WRAP_MIRROR, TEXTURE_WRAP_CLAMP}) {
        textures.push_back(bitmap(TEXTURE_NEAREST | flags, 2, 3, 3));
    }
    TextureProbe probe;
    for (std::uint32_t t = 0; t < textures.size(); ++t) {
        const std::vector<Uv> uvs{{nan, nan}, {infinity, 0.5F}, {-infinity, 0.5F},
                                  {0.5F, 3e38F}, {-3e38F, 1e20F}, {1e9F, -1e9F}};
        for (const glm::vec3& c : probe.colours(textures, texels, std::vector<std::uint32_t>(uvs.size(), t), uvs)) {
            EXPECT_GE(c.x, 0.0F);
            EXPECT_EQ(c.z, 10.0F * c.x + c.y);
        }
    }
}

TEST(Texture, SameBitsAtEveryLaneWidth) {
    Random random(2);
    Scene scene = random_scene(random);
    scene.textures.push_back(checkerboard({1, 2, 3}, {4, 5, 6}, transform));
    std::vector<std::uint32_t> index;
    std::vector<Uv> uvs;
    for (int i = 0; i < 20000; ++i) {
        index.push_back(static_cast<std::uint32_t>(random.uniform() * static_cast<float>(scene.textures.size())));
        uvs.push_back({random.between(-3.0F, 3.0F), random.between(-3.0F, 3.0F)});
    }
    const std::vector<glm::vec3> first = TextureProbe(16).colours(scene.textures, scene.texels, index, uvs);
    for (int lanes : {8, 1}) {
        EXPECT_TRUE(TextureProbe(lanes).colours(scene.textures, scene.texels, index, uvs) == first) << lanes;
    }
}

}  // namespace
}  // namespace wavelobe::test
