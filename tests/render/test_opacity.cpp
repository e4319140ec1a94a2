// Surfaces that are only partly there: what is seen through them, and the light that falls through.
#include <gtest/gtest.h>

#include <numbers>

#include "render/flatten.h"
#include "support/many_features.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

const Rgb sky{1.0F, 2.0F, 3.5F};

enum class Geometry { few_triangles, hierarchy, disks };

void PrintTo(Geometry geometry, std::ostream* out) {
    *out << (geometry == Geometry::few_triangles ? "few_triangles" : geometry == Geometry::disks ? "disks" : "hierarchy");
}

// A constant sky, seen along +z from the origin, or from `origin` on.
Scene sky_scene(int pixels) {
    Scene scene = empty_scene(pixels);
    scene.emitters.emplace_back(ConstantEmitter{sky});
    look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 10.0F);
    return scene;
}

// Far behind the camera: so many triangles that there is a hierarchy.
void add_crowd(Scene& scene) {
    for (int i = 0; i < 60; ++i) add_quad(scene, {-3000, static_cast<float>(i), -900}, {-1, 0, 0}, {0, 1, 0}, 0);
}

// A sheet across the view at that distance, its texture coordinates over [0, 1].
Shape& add_sheet(Scene& scene, Geometry geometry, float z, int material) {
    if (geometry != Geometry::disks) return add_quad(scene, {-5, -5, z}, {10, 0, 0}, {0, 10, 0}, material);
    const glm::mat4 to_world = glm::scale(glm::translate(glm::mat4(1.0F), {0, 0, z}), glm::vec3(8.0F));
    return add_shape(scene, AnalyticShape{AnalyticShape::Kind::disk, to_world}, material, "disk");
}

void set_opacity(Shape& shape, float opacity) { shape.material.opacity.value.value = Rgb(opacity); }

std::shared_ptr<const Texture> texture_of(std::variant<Bitmap, Checkerboard> source) {
    auto texture = std::make_shared<Texture>();
    texture->source = std::move(source);
    return texture;
}

// Two columns: `left` for u below one half, `right` beyond it.
std::shared_ptr<const Texture> two_columns(float left, float right) {
    Bitmap bitmap{2, 1, {left, left, left, right, right, right}};
    bitmap.filter = Filter::nearest;
    return texture_of(bitmap);
}

class OpacityOf : public testing::TestWithParam<Geometry> {};
class OpacityOfTriangles : public OpacityOf {};

// Each of three black sheets lets through what it lacks of opacity.
TEST_P(OpacityOf, SheetsInARowMultiply) {
    Scene scene = sky_scene(48);
    const int black = add_diffuse(scene, Rgb{0});
    if (GetParam() == Geometry::hierarchy) add_crowd(scene);
    const float opacities[] = {0.25F, 0.5F, 0.125F};
    for (int i = 0; i < 3; ++i) set_opacity(add_sheet(scene, GetParam(), 2.0F + static_cast<float>(i), black), opacities[i]);
    expect_closed_form(scene, 64, glm::dvec3(sky) * (0.75 * 0.5 * 0.875));
}

// A floor under a point light above a sheet: next-event estimation sees the light through the sheet.
TEST_P(OpacityOf, LightFallsThrough) {
    constexpr float albedo = 0.5F;
    Scene scene = empty_scene(32);
    const int grey = add_diffuse(scene, Rgb{albedo});
    const int black = add_diffuse(scene, Rgb{0});
    add_floor(scene, 1.0F, grey);
    if (GetParam() == Geometry::hierarchy) add_crowd(scene);
    if (GetParam() == Geometry::disks) {
        set_opacity(add_disk_facing_down(scene, {0, 1, 0}, 1.0F, black), 0.75F);
    } else {
        // The light is not above the diagonal, where a ray meets two triangles.
        set_opacity(add_quad(scene, {-1.5F, 1, -1}, {2, 0, 0}, {0, 0, 2}, black), 0.75F);
    }
    scene.emitters.emplace_back(PointEmitter{{0, 2, 0}, {8, 4, 2}});
    look_at_point(scene, {1.9F, 0.5F, 0}, {0, 0, 0});
    const double falls = 0.25 * static_cast<double>(albedo) / std::numbers::pi / 4.0;
    expect_closed_form(scene, 256, glm::dvec3{8, 4, 2} * falls);
}

// A mask of nothing but 0 and 1 needs no chance: each pixel is right after one sample.
// (The u of disks is no line in the picture.)
TEST_P(OpacityOfTriangles, BinaryMasksAreWithoutNoise) {
    Scene scene = sky_scene(16);
    const int black = add_diffuse(scene, Rgb{0});
    if (GetParam() == Geometry::hierarchy) add_crowd(scene);
    Shape& sheet = add_sheet(scene, GetParam(), 3.0F, black);
    sheet.material.opacity.value.texture = two_columns(0, 1);
    const Image image = render(scene, 1).image;
    for (std::size_t i = 0; i < 256; ++i) {
        // +x, and with it u, grows to the left of the picture.
        const glm::dvec3 expected = i % 16 >= 8 ? glm::dvec3(sky) : glm::dvec3(0.0);
        EXPECT_EQ(pixel(image, i), expected) << "pixel " << i;
    }
}

// glTF's mask: there from the cutoff on; its blending: alpha times a factor.
TEST_P(OpacityOf, CutoffAndScale) {
    Scene scene = sky_scene(32);
    const int black = add_diffuse(scene, Rgb{0});
    if (GetParam() == Geometry::hierarchy) add_crowd(scene);
    Opacity& cut = add_sheet(scene, GetParam(), 3.0F, black).material.opacity;
    cut.value.texture = texture_of(Checkerboard{Rgb{0.9F}, Rgb{0.9F}});
    cut.texture_scale = 0.5F;
    cut.cutoff = 0.5F;
    expect_every_pixel(render(scene, 1).image, glm::dvec3(sky));
    cut.cutoff = 0.45F;
    expect_every_pixel(render(scene, 1).image, glm::dvec3(0));
    cut.cutoff.reset();
    expect_closed_form(scene, 256, glm::dvec3(sky) * 0.55);
}

TEST_P(OpacityOf, IsTheSameAtEachWidth) {
    Scene scene = sky_scene(40);
    const int grey = add_diffuse(scene, Rgb{0.5F});
    if (GetParam() == Geometry::hierarchy) add_crowd(scene);
    set_opacity(add_sheet(scene, GetParam(), 2.0F, grey), 0.5F);
    add_sheet(scene, GetParam(), 3.0F, grey).material.opacity.value.texture = two_columns(0.25F, 0.75F);
    add_sheet(scene, GetParam(), 4.0F, grey);
    std::vector<std::vector<float>> pictures;
    for (const int lanes : {1, 8, 16}) {
        RenderSettings settings;
        settings.samples_per_pixel = 4;
        settings.lanes = lanes;
        pictures.push_back(render(scene, settings).image.rgb);
    }
    EXPECT_EQ(pictures[0], pictures[2]);
    EXPECT_EQ(pictures[1], pictures[2]);
}

INSTANTIATE_TEST_SUITE_P(All, OpacityOf, testing::Values(Geometry::few_triangles, Geometry::hierarchy, Geometry::disks),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(All, OpacityOfTriangles, testing::Values(Geometry::few_triangles, Geometry::hierarchy),
                         testing::PrintToStringParamName());

// Front and back of a sphere are drawn apart: both are passed as often as two sheets would be.
TEST(Opacity, BothSidesOfASphere) {
    Scene scene = sky_scene(48);
    set_opacity(add_sphere(scene, {0, 0, 5}, 3.0F, add_diffuse(scene, Rgb{0})), 0.5F);
    expect_closed_form(scene, 64, glm::dvec3(sky) * 0.25);
}

// What an emitter sends out is not lessened by its opacity, which only says how much is seen behind it.
class VeiledEmitter : public testing::TestWithParam<Geometry> {};

TEST_P(VeiledEmitter, ShinesBeforeWhatIsBehind) {
    Scene scene = sky_scene(48);
    const int black = add_diffuse(scene, Rgb{0});
    Shape& veil = add_sheet(scene, GetParam(), 3.0F, black);
    // Emits towards the camera.
    veil.flip_normals = true;
    if (auto* mesh = std::get_if<TriangleMesh>(&veil.geometry)) {
        std::swap(mesh->positions[1], mesh->positions[3]);
        std::swap(mesh->uvs[1], mesh->uvs[3]);
    }
    make_emitter(veil, {4, 3, 2});
    set_opacity(veil, 0.75F);
    expect_closed_form(scene, 64, glm::dvec3{4, 3, 2} + 0.25 * glm::dvec3(sky));
    set_opacity(veil, 0.0F);
    expect_every_pixel(render(scene, 1).image, glm::dvec3{4, 3, 2} + glm::dvec3(sky));
}

INSTANTIATE_TEST_SUITE_P(All, VeiledEmitter, testing::Values(Geometry::few_triangles, Geometry::disks),
                         testing::PrintToStringParamName());

// ---- what it costs ------------------------------------------------------------------------------------------

Scene plain_scene() {
    Scene scene = sky_scene(24);
    add_quad(scene, {-1, -1, 3}, {2, 0, 0}, {0, 2, 0}, add_diffuse(scene, Rgb{0.5F})).material.back = 0;
    return scene;
}

// Opaque whatever its texture: the program of the plain scene, and its picture.
TEST(Opacity, WholeShapesCostNothing) {
    Scene scene = plain_scene();
    Opacity& opacity = scene.shapes[0].material.opacity;
    opacity.value.texture = texture_of(Bitmap{2, 2, std::vector<float>(12, 1.0F)});
    EXPECT_EQ(scene_program(scene, {}), scene_program(plain_scene(), {}));
    EXPECT_EQ(render(scene, 4).image.rgb, render(plain_scene(), 4).image.rgb);
    opacity.value.texture = texture_of(Bitmap{2, 2, std::vector<float>(12, 0.6F)});
    opacity.cutoff = 0.5F;
    EXPECT_EQ(scene_program(scene, {}), scene_program(plain_scene(), {}));
}

// Not there at all: left out with its material.
TEST(Opacity, AbsentShapesCostNothing) {
    Scene scene = plain_scene();
    set_opacity(add_sphere(scene, {0, 0, 2}, 0.5F, add_material(scene, Conductor{})), 0.0F);
    EXPECT_EQ(flatten_scene(scene).features.names(), flatten_scene(plain_scene()).features.names());
    EXPECT_EQ(render(scene, 4).image.rgb, render(plain_scene(), 4).image.rgb);
}

TEST(Opacity, FeaturesAreNamed) {
    Scene scene = plain_scene();
    const auto has = [&scene](const char* name) {
        const std::vector<std::string> names = flatten_scene(scene).features.names();
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    EXPECT_FALSE(has("masks") || has("veiled_emitters"));
    EXPECT_NE(scene_program(scene, {}).find("#define HAS_MASKS 0\n#define HAS_VEILED_EMITTERS 0\n#define HAS_MEDIA 0\n#define HAS_CLEAR_BOUNDARIES 0\n#define HAS_OPACITY 0\n"), std::string::npos);
    set_opacity(scene.shapes[0], 0.5F);
    EXPECT_TRUE(has("masks") && !has("veiled_emitters"));
    make_emitter(scene.shapes[0], {1, 1, 1});
    EXPECT_TRUE(!has("masks") && has("veiled_emitters"));
}

}  // namespace
}  // namespace wavelobe::test
