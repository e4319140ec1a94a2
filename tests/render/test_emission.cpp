// Emission that is no lamp: from both sides, found by paths alone, tinted by vertices; and second texture coordinates.
#include <gtest/gtest.h>

#include "support/render.h"

namespace wavelobe::test {
namespace {

const Rgb sky{0.25F, 0.5F, 1.0F};

// A constant sky, seen along +z from the origin, and a black sheet across the view that shines.
struct SheetScene {
    explicit SheetScene(const AreaEmitter& emitter) : scene(empty_scene(32)) {
        scene.emitters.emplace_back(ConstantEmitter{sky});
        look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 10.0F);
        Shape& sheet = add_quad(scene, {5, -5, 3}, {-10, 0, 0}, {0, 10, 0}, add_diffuse(scene, Rgb{0}));
        sheet.emitter = emitter;
        mesh().parallelogram = false;
    }
    TriangleMesh& mesh() { return std::get<TriangleMesh>(scene.shapes[0].geometry); }

    Scene scene;
};

// `left` for u below one half, `right` beyond it.
std::shared_ptr<Texture> two_columns(float left, float right) {
    auto texture = std::make_shared<Texture>();
    Bitmap bitmap{2, 1, {left, left, left, right, right, right}};
    bitmap.filter = Filter::nearest;
    texture->source = bitmap;
    return texture;
}

TEST(Emission, UnsampledShinesOnBothSides) {
    for (const bool turned : {false, true}) {
        SheetScene sheet({constant(Rgb{2, 3, 4}), true, false});
        if (turned)
            for (glm::uvec3& t : sheet.mesh().triangles) std::swap(t.x, t.y);
        expect_every_pixel(render(sheet.scene, 2).image, {2, 3, 4});
    }
}

// The opacity of vertices lessens what shines, and lets the rest of the sky through.
TEST(Emission, OpacityAndColorsOfVertices) {
    SheetScene sheet({constant(Rgb{2, 2, 2}), true, false, true});
    sheet.mesh().colors.assign(4, {0.5F, 1.0F, 0.25F});
    sheet.mesh().alphas.assign(4, 0.5F);
    sheet.scene.shapes[0].material.opacity.value.value = Rgb{0.5F};
    expect_mean(render(sheet.scene, 256).image, 0.25 * glm::dvec3{1, 2, 0.5} + 0.75 * glm::dvec3(sky));
}

// Opacities vary linearly over triangles; a cutoff is taken of their product with the factor.
TEST(Emission, CutoffOfInterpolatedOpacities) {
    SheetScene sheet({constant(Rgb{2, 2, 2}), true, false});
    TriangleMesh& mesh = sheet.mesh();
    for (const glm::vec3& p : mesh.positions) mesh.alphas.push_back(p.x > 0 ? 1.0F : 0.0F);
    sheet.scene.shapes[0].material.opacity = {constant(Rgb{0.5F}), 1.0F, 0.25F};
    const Image image = render(sheet.scene, 1).image;
    // +x grows to the left of the picture.
    for (std::size_t i = 0; i < 32 * 32; ++i)
        EXPECT_EQ(pixel(image, i), i % 32 < 16 ? glm::dvec3(2.0) : glm::dvec3(sky)) << "pixel " << i;
}

TEST(Emission, SecondCoordinates) {
    for (const bool sampled : {false, true}) {
        const auto texture = two_columns(1, 8);
        texture->second_uvs = true;
        SheetScene sheet({{Rgb{1}, texture}, true, sampled});
        sheet.mesh().uvs.assign(4, {0.25F, 0.5F});
        sheet.mesh().second_uvs.assign(4, {0.75F, 0.5F});
        expect_every_pixel(render(sheet.scene, 2).image, {8, 8, 8});
    }
}

// A material may use both sets.
TEST(Emission, BothCoordinatesInOneMaterial) {
    SheetScene sheet({constant(Rgb{0})});
    const auto base = two_columns(1, 0.5F);
    const auto metal = two_columns(0, 1);
    metal->second_uvs = true;
    MetallicRoughness model{{Rgb{1}, base}, {Rgb{1}, metal}, constant(Rgb{1.0F})};
    model.specular.value = Rgb{0.0F};
    sheet.scene.materials[0].model = model;
    sheet.scene.emitters = {ConstantEmitter{Rgb{1}}};
    sheet.scene.shapes[0].emitter.reset();
    sheet.scene.shapes[0].material.back = 0;
    sheet.mesh().uvs.assign(4, {0.75F, 0.5F});
    sheet.mesh().second_uvs.assign(4, {0.25F, 0.5F});
    expect_mean(render(sheet.scene, 64).image, glm::dvec3(0.5));
}

// Culling is for the camera: to all else a single-sided surface has two sides, and whichever of them faces the light, what is below it is lit
// as below a two-sided one, by samples and by paths. What the camera sees through the back is the same.
TEST(Emission, CulledBacksHideNothingFromLight) {
    const auto lit = [](bool culled, bool turned, bool from_below, bool by_sky) {
        Scene scene = empty_scene(32);
        add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
        Shape& sheet = add_floor(scene, 1.5F, add_diffuse(scene, Rgb{0.7F}));
        auto& mesh = std::get<TriangleMesh>(sheet.geometry);
        for (glm::vec3& p : mesh.positions) p.y = 1.0F;
        mesh.parallelogram = false;
        if (turned)
            for (glm::uvec3& t : mesh.triangles) std::swap(t.x, t.y);
        sheet.material.back = culled ? add_material(scene, ThinDielectric{1.0F}) : sheet.material.front;
        sheet.material.culled_behind = culled;
        if (by_sky) scene.emitters.emplace_back(ConstantEmitter{Rgb{1.0F}});
        else scene.emitters.emplace_back(PointEmitter{{1.8F, 1.5F, 0}, Rgb{1.0F}});
        look_at(scene, {0, from_below ? 0.9F : 2.0F, 0}, {0, 0, 0}, {0, 0, 1}, from_below ? 60.0F : 27.5F);
        return picture_mean(render(scene, 256).image);
    };
    for (const bool by_sky : {false, true}) {
        for (const bool turned : {false, true}) {
            const PictureMean whole = lit(false, turned, true, by_sky);
            const PictureMean culled = lit(true, turned, true, by_sky);
            EXPECT_NEAR(whole.mean.x, culled.mean.x, 4.5 * std::hypot(whole.standard_error.x, culled.standard_error.x)) << by_sky << turned;
        }
        // From above, through the back, the floor is as dark.
        const PictureMean through = lit(true, true, false, by_sky);
        const PictureMean above = lit(true, false, false, by_sky);
        EXPECT_LT(through.mean.x, 0.8 * above.mean.x) << by_sky;
    }
}

// The back of a single-sided surface is not there, whatever its shading normals say; its front is.
TEST(Emission, ClearBacksShowWhatIsBehind) {
    for (const bool turned : {false, true}) {
        SheetScene sheet({constant(Rgb{2, 3, 4})});
        sheet.scene.shapes[0].material.back = add_material(sheet.scene, ThinDielectric{1.0F});
        sheet.scene.shapes[0].material.culled_behind = true;
        sheet.mesh().normals.assign(4, glm::normalize(glm::vec3{0, 0.1F, 1}));
        if (turned)
            for (glm::uvec3& t : sheet.mesh().triangles) std::swap(t.x, t.y);
        const glm::vec3 e = glm::cross(sheet.mesh().positions[1] - sheet.mesh().positions[0], sheet.mesh().positions[2] - sheet.mesh().positions[0]);
        const bool faces = (e.z < 0) != turned;
        expect_every_pixel(render(sheet.scene, 2).image, faces ? glm::dvec3{2, 3, 4} : glm::dvec3(sky));
    }
}

// What is lit by paths alone is lit alike by sampling, on either side of the light.
TEST(Emission, SamplingChangesNoMean) {
    const auto lit = [](bool sampled, float height) {
        Scene scene = empty_scene(32);
        add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
        scene.emitters.emplace_back(ConstantEmitter{Rgb{0.01F}});
        Shape& lamp = add_quad(scene, {-1, height, -1}, {2, 0, 0}, {0, 0, 2}, add_diffuse(scene, Rgb{0}));
        lamp.emitter = AreaEmitter{constant(Rgb{3}), true, sampled};
        look_at_point(scene, {1.9F, 0.4F, 0}, {0, 0, 0});
        return picture_mean(render(scene, 256).image);
    };
    for (const float height : {1.0F, -1.0F}) {
        const PictureMean by_light = lit(true, height);
        const PictureMean by_chance = lit(false, height);
        const double tolerance = 4.5 * std::hypot(by_light.standard_error.x, by_chance.standard_error.x);
        EXPECT_NEAR(by_light.mean.x, by_chance.mean.x, tolerance) << height;
        EXPECT_LT(tolerance, 0.03 * by_chance.mean.x);
    }
}

// A mesh shines evenly over its faces: normals at its vertices shade what it reflects, and move nothing that it sends out.
TEST(Emission, VertexNormalsMoveNoLight) {
    const auto lit = [](bool smooth) {
        Scene scene = empty_scene(32);
        add_floor(scene, 1.0F, add_diffuse(scene, Rgb{0.5F}));
        TriangleMesh octahedron;
        for (const glm::vec3& p : {glm::vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
            if (smooth) octahedron.normals.push_back(p);
            octahedron.positions.push_back(p + glm::vec3{0, 4, 0});
        }
        octahedron.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
        add_shape(scene, octahedron, add_diffuse(scene, Rgb{0}), "lamp").emitter = AreaEmitter{constant(Rgb{1})};
        look_at_point(scene, {0.5F, 0.4F, 0}, {0, 0, 0});
        scene.integrator.max_depth = 2;
        return picture_mean(render(scene, 256).image);
    };
    const PictureMean smooth = lit(true), flat = lit(false);
    const double tolerance = 4.5 * std::hypot(smooth.standard_error.x, flat.standard_error.x);
    EXPECT_NEAR(smooth.mean.x, flat.mean.x, tolerance);
    EXPECT_LT(tolerance, 0.02 * flat.mean.x);
}

}  // namespace
}  // namespace wavelobe::test
