// glTF's sheen: its table, and what it does to a picture.
#include <gtest/gtest.h>

#include "support/render.h"
#include "tables/sheen_albedo.h"

namespace wavelobe::test {
namespace {

// Between its entries the table is what it stands for, by a rule twice as fine in both directions.
TEST(Sheen, TableOfDirectionalAlbedos) {
    const SheenAlbedo table = sheen_albedo();
    const auto looked_up = [&](double roughness, double cosine) {
        const double y = (roughness - static_cast<double>(SHEEN_LEAST_ROUGHNESS)) / (1.0 - static_cast<double>(SHEEN_LEAST_ROUGHNESS)) * (SHEEN_ROUGHNESSES - 1);
        const double x = std::sqrt(cosine) * (SHEEN_COSINES - 1);
        const auto row = static_cast<std::size_t>(y), column = static_cast<std::size_t>(x);
        const double across = x - std::floor(x);
        const float* at = table.at + row * SHEEN_COSINES + column;
        const auto lerp = [](float a, float b, double t) { return std::lerp(static_cast<double>(a), static_cast<double>(b), t); };
        return std::lerp(lerp(at[0], at[1], across), lerp(at[SHEEN_COSINES], at[SHEEN_COSINES + 1], across), y - std::floor(y));
    };
    for (const double roughness : {0.15, 0.3, 0.5, 0.75, 0.95})
        for (const double cosine : {0.02, 0.1, 0.3, 0.6, 0.95})
            EXPECT_NEAR(looked_up(roughness, cosine), sheen_directional_albedo(cosine, roughness * roughness, 128, 64), 0.03) << roughness << " " << cosine;
}

// A metal that reflects nothing, below white sheen under a white sky, shows its directional albedo; a base that is white as well gains nothing.
TEST(Sheen, DirectionalAlbedoOfAPicture) {
    const auto seen = [](float cosine, float base, float sheen, float roughness, bool textured = false) {
        Scene scene = empty_scene(32);
        scene.emitters.emplace_back(ConstantEmitter{Rgb{1.0F}});
        MetallicRoughness model;
        model.base_color = constant(Rgb{base});
        model.metallic = constant(0.0F);
        model.specular.value = Rgb{0.0F};
        model.sheen_color = constant(Rgb{sheen});
        model.sheen_roughness = constant(roughness);
        if (textured) {
            auto half = std::make_shared<Texture>();
            half->source = Bitmap{1, 1, {0.5F, 0.5F, 0.5F}};
            model.sheen_color.texture = half;
        }
        add_floor(scene, 1.0F, add_material(scene, model));
        look_at_point(scene, {std::sqrt(1.0F - cosine * cosine), cosine, 0}, {0, 0, 0});
        return picture_mean(render(scene, 256).image);
    };
    for (const float cosine : {0.2F, 0.7F}) {
        const PictureMean black = seen(cosine, 0.0F, 1.0F, 0.6F);
        EXPECT_NEAR(black.mean.x, sheen_directional_albedo(static_cast<double>(cosine), 0.36, 256, 128), 4.5 * black.standard_error.x + 1e-4) << cosine;
        const PictureMean half = seen(cosine, 0.0F, 1.0F, 0.6F, true);
        EXPECT_NEAR(half.mean.x, 0.5 * black.mean.x, 4.5 * half.standard_error.x + 1e-3) << cosine;
    }
    const PictureMean grazing = seen(0.03F, 1.0F, 1.0F, 0.1F);
    EXPECT_LE(grazing.mean.x, 1.0 + 4.5 * grazing.standard_error.x);
}

}  // namespace
}  // namespace wavelobe::test
