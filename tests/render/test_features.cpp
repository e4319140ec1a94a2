// A scene pays for what it uses: the program holds its lobes, lights and features, and nothing else.
#include <gtest/gtest.h>

#include <algorithm>

#include "cl/kernel_source.h"
#include "render/flatten.h"
#include "support/render.h"

namespace wavelobe::test {
namespace {

std::string scene_with(const std::string& unused) {
    return R"(<scene version="3.0.0">
        <integrator type="path"><integer name="max_depth" value="4"/></integrator>
        <sensor type="perspective">
            <transform name="to_world"><lookat origin="0, 1, 4" target="0, 0.5, 0" up="0, 1, 0"/></transform>
            <film type="hdrfilm">
                <integer name="width" value="32"/> <integer name="height" value="32"/> <rfilter type="box"/>
            </film>
        </sensor>)" +
           unused + R"(
        <shape type="rectangle">
            <transform name="to_world"><rotate x="1" angle="-90"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.5, 0.7"/></bsdf>
        </shape>
        <shape type="rectangle">
            <transform name="to_world"><scale value="0.3"/><rotate x="1" angle="90"/><translate y="1"/></transform>
            <emitter type="area"><rgb name="radiance" value="5, 4, 3"/></emitter>
        </shape>
    </scene>)";
}

Scene diffuse_scene(const std::string& unused = {}) { return SceneFolder().read(scene_with(unused)); }

std::string program_text(const Scene& scene) {
    return flatten_includes(program_source(flatten_scene(scene).features, 16, 512), "scene.cl");
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Text of a header is marked by its path; what stands behind a feature of 0 is not compiled.
TEST(Features, ProgramOfADiffuseSceneHoldsNothingElse) {
    const std::string text = program_text(diffuse_scene());
    for (const char* present : {"\"bsdf/lambert.h\"", "\"lights/rectangle.h\"", "uint run_scatter_diffuse",
                                "uint run_shade_emitted", "uint run_intersect_shadow"}) {
        EXPECT_TRUE(contains(text, present)) << present;
    }
    for (const char* absent :
         {"\"bsdf/microfacet.h\"", "\"bsdf/fresnel.h\"", "\"bsdf/rough_conductor.h\"", "\"bsdf/dielectric.h\"",
          "\"bsdf/mirror.h\"", "\"bsdf/phong.h\"", "\"bsdf/plastic_coat.h\"", "\"lights/envmap.h\"",
          "\"lights/constant.h\"", "\"lights/sphere.h\"", "\"lights/spot.h\"", "uint run_scatter_delta",
          "uint run_scatter_glossy", "uint run_shade_escaped"}) {
        EXPECT_FALSE(contains(text, absent)) << absent;
    }
    for (const char* feature : {"TEXTURES", "TEXTURED_EMITTERS", "SMOOTH_NORMALS", "UVS", "ANALYTIC", "ANISOTROPY",
                                "TANGENTS", "NESTING", "TRANSMISSION", "LOBE_CHOICE", "MIXTURE", "ENVIRONMENT", "MEDIA", "CLEAR_BOUNDARIES"}) {
        EXPECT_TRUE(contains(text, std::string("#define HAS_") + feature + " 0\n")) << feature;
    }
}

TEST(Features, AreNamed) {
    std::vector<std::string> expected{"lobe:lambert", "light:rectangle", "unlike_sides"};
    EXPECT_EQ(flatten_scene(diffuse_scene()).features.names(), expected);
    expected.emplace_back("few_triangles");  // known once the hierarchy is
    EXPECT_EQ(render(diffuse_scene(), 16).stats.features, expected);
}

TEST(Features, StagesAreThoseThatHaveWork) {
    const std::vector<std::string> expected{"generate",      "intersect_closest", "sort_paths", "intersect_shadow",
                                            "shade_emitted", "scatter_diffuse",   "accumulate"};
    EXPECT_EQ(flatten_scene(diffuse_scene()).features.stages(), expected);
}

// Materials and textures that no shape uses change neither the program nor one bit of the picture.
TEST(Features, UnusedMaterialsAndTexturesCostNothing) {
    const Scene plain = diffuse_scene();
    Scene burdened = diffuse_scene(R"(
        <bsdf type="roughconductor" id="metal"><float name="alpha" value="0.2"/></bsdf>
        <bsdf type="dielectric" id="glass"/>
        <bsdf type="twosided" id="board">
            <bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf>
        </bsdf>
        <bsdf type="plastic" id="plastic"/>)");
    const auto board = std::make_shared<Texture>();
    board->source = Checkerboard{};
    add_material(burdened, Phong{{Rgb{0.1F}, board}, constant(0.2F), constant(30.0F)});
    EXPECT_EQ(program_text(burdened), program_text(plain));
    EXPECT_EQ(render(burdened, 16).image.rgb, render(plain, 16).image.rgb);
}

constexpr const char* many_points = R"(<emitter type="point"/><emitter type="point"/><emitter type="point"/><emitter type="point"/>)";

struct Addition {
    const char* name;
    const char* element;
    std::vector<std::string> features;  // more than those of the plain scene
};

void PrintTo(const Addition& addition, std::ostream* out) { *out << addition.name; }

class Additions : public testing::TestWithParam<Addition> {};

// What one element brings along is exactly what it needs.
TEST_P(Additions, BringWhatTheyNeed) {
    const std::string sphere =
        R"(<shape type="sphere"><point name="center" x="0" y="0.4" z="0"/><float name="radius" value="0.3"/>)";
    std::string element = GetParam().element;
    if (element.starts_with("<bsdf")) element = sphere + element + "</shape>";
    std::vector<std::string> found = flatten_scene(diffuse_scene(element)).features.names();
    std::vector<std::string> expected{"lobe:lambert", "light:rectangle", "unlike_sides"};
    expected.insert(expected.end(), GetParam().features.begin(), GetParam().features.end());
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found, expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, Additions,
    testing::Values(
        Addition{"many_points", many_points, {"light:point", "light_choice", "light_tree"}},
        Addition{"point", R"(<emitter type="point"/>)", {"light:point", "light_choice", "light_tree"}},
        Addition{"constant", R"(<emitter type="constant"/>)", {"light:constant", "light_choice"}},
        Addition{"black_environment", R"(<emitter type="constant"><rgb name="radiance" value="0"/></emitter>)", {}},
        Addition{"diffuse_sphere", R"(<bsdf type="diffuse"/>)", {"analytic_shapes"}},
        Addition{"mirror", R"(<bsdf type="conductor"/>)", {"analytic_shapes", "caustics", "lobe:mirror"}},
        Addition{"glass", R"(<bsdf type="dielectric"/>)", {"analytic_shapes", "caustics", "lobe:dielectric", "transmission"}},
        Addition{"metal",
                 R"(<bsdf type="roughconductor"><string name="distribution" value="ggx"/></bsdf>)",
                 {"analytic_shapes", "lobe:rough_conductor", "ggx"}},
        Addition{
            "brushed_metal",
            R"(<bsdf type="roughconductor"><float name="alpha_u" value="0.1"/><float name="alpha_v" value="0.2"/></bsdf>)",
            {"analytic_shapes", "lobe:rough_conductor", "beckmann", "anisotropy", "uvs"}},
        Addition{"plastic",
                 R"(<bsdf type="plastic"/>)",
                 {"analytic_shapes", "lobe:plastic_coat", "lobe:plastic_base", "lobe_choice"}},
        Addition{"checkerboard",
                 R"(<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf>)",
                 {"analytic_shapes", "textures", "uvs"}}),
    [](const auto& addition) { return addition.param.name; });

}  // namespace
}  // namespace wavelobe::test
