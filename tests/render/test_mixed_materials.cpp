// Materials of unlike records side by side, textured and not: each looks as it does alone, in lanes that it shares with others.
#include <gtest/gtest.h>

#include <array>

#include "support/render.h"

namespace wavelobe::test {
namespace {

constexpr int strips = 4;
constexpr int pixels = 16;

// Four texels that differ in all channels.
Parameter textured(const Rgb& color) {
    Bitmap bitmap;
    bitmap.width = bitmap.height = 2;
    for (int i = 0; i < 12; ++i) bitmap.rgb.push_back(color[i % 3] * (0.7F + 0.02F * static_cast<float>(i)));
    Texture texture;
    texture.source = bitmap;
    Parameter p = constant(1.0F);
    p.texture = std::make_shared<const Texture>(texture);
    return p;
}

// The first has an extension behind it; others nest, or have none.
std::array<MaterialModel, strips> unlike_materials() {
    RoughPlastic plastic;
    plastic.alpha = 0.3F;
    Principled principled;
    principled.surface.base_color = textured(Rgb{0.9F, 0.5F, 0.3F});
    principled.surface.roughness = textured(Rgb{0.8F});
    principled.surface.flatness = textured(Rgb{0.5F});
    principled.clearcoat = constant(0.5F);
    NormalMapped map;
    map.normals = textured(Rgb{0.65F, 0.6F, 1.0F});
    map.nested = std::make_shared<const Material>(Material{Diffuse{constant(Rgb{0.2F, 0.4F, 0.8F})}, "nested"});
    return {plastic, principled, Diffuse{textured(Rgb{0.4F, 0.7F, 0.9F})}, map};
}

// Strips of a floor, seen from above and lit by a light without size: no random choice changes a sample's value.
Image floor_of(const std::array<MaterialModel, strips>& models) {
    Scene scene = empty_scene(pixels);
    for (int i = 0; i < strips; ++i) {
        const int material = add_material(scene, models[static_cast<std::size_t>(i)]);
        add_quad(scene, {static_cast<float>(i) - 2.0F, 0, 2}, {1, 0, 0}, {0, 0, -4}, material);
    }
    look_at(scene, {0, 2, 0}, {0, 0, 0}, {0, 0, -1}, 90.0F);
    scene.emitters.emplace_back(DirectionalEmitter{glm::normalize(glm::vec3{-0.3F, -1.0F, 0.2F}), {1, 2, 3}});
    scene.integrator.max_depth = 2;
    return render(scene, 1).image;
}

TEST(MixedMaterials, LookAsTheyDoAlone) {
    const std::array<MaterialModel, strips> models = unlike_materials();
    const Image together = floor_of(models);
    for (int strip = 0; strip < strips; ++strip) {
        std::array<MaterialModel, strips> alike;
        alike.fill(models[static_cast<std::size_t>(strip)]);
        const Image alone = floor_of(alike);
        for (int y = 0; y < pixels; ++y) {
            for (int x = 1; x < 3; ++x) {  // columns that lie within a strip
                const auto i = static_cast<std::size_t>(y * pixels + strip * pixels / strips + x);
                EXPECT_GT(pixel(alone, i).y, 0.0);
                for (glm::length_t c = 0; c < 3; ++c) {
                    ASSERT_NEAR(pixel(together, i)[c], pixel(alone, i)[c], path_rounding * pixel(alone, i)[c])
                        << "strip " << strip << ", row " << y << ", channel " << c;
                }
            }
        }
    }
}

}  // namespace
}  // namespace wavelobe::test
