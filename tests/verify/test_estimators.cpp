// Estimators of the same picture agree: light by BSDF samples, by light samples, by both; each traversal kernel; each sampler;
// the direct integrator and paths of two edges.
#include "support/agreement.h"
#include "support/many_features.h"

namespace wavelobe::test {
namespace {

constexpr int width = 64;
constexpr int height = 48;

Scene file_scene(const char* name) {
    return read_mitsuba_scene(std::string(WAVELOBE_SOURCE_DIR) + "/scenes/" + name + ".xml",
                              {{"width", std::to_string(width)}, {"height", std::to_string(height)}});
}

// Rough metal and a diffuse floor under a picture of the sky with a bright part.
Scene sky_scene() {
    Scene scene = empty_scene(48);
    look_at(scene, {0, 1.5F, 4}, {0, 0.4F, 0}, {0, 1, 0}, 40.0F);
    add_floor(scene, 3.0F, add_diffuse(scene, {0.6F, 0.5F, 0.4F}));
    add_sphere(scene, {0, 0.6F, 0}, 0.6F,
               add_material(scene, RoughConductor{{0.2F, 0.9F, 1.1F}, {3.9F, 2.4F, 2.2F}, constant(1.0F), constant(0.3F),
                                                  constant(0.3F), Distribution::ggx}));
    EnvironmentMap map;
    map.image.width = 16;
    map.image.height = 9;
    for (int i = 0; i < 16 * 9 * 3; ++i) map.image.rgb.push_back(0.2F + 0.05F * static_cast<float>(i % 7));
    for (int i = 0; i < 6; ++i) map.image.rgb[static_cast<std::size_t>(3 * (2 * 16 + 5) + i)] = 12.0F;
    scene.emitters.emplace_back(map);
    return scene;
}

struct Case {
    const char* name;
    Scene (*make)();
};

const Case cases[] = {{"cornell_box", [] { return file_scene("cornell_box"); }},
                      {"glossy_plates", [] { return file_scene("glossy_plates"); }},
                      {"all features", [] { return many_features_scene(width, height); }},
                      {"metal under a sky", sky_scene}};

RenderSettings with(std::uint32_t seed) {
    RenderSettings settings;
    settings.samples_per_pixel = quick_or_full(64, 1024);
    settings.seed = seed;
    return settings;
}

TEST(Estimators, BsdfAndLightSamplesAndBothAgree) {
    for (const Case& c : cases) {
        const Scene scene = c.make();
        RenderSettings both = with(1), bsdf = with(2), light = with(3);
        bsdf.estimator = Estimator::bsdf;
        light.estimator = Estimator::light;
        expect_agreement(std::string("BSDF samples alone against both kinds, ") + c.name, scene, bsdf, scene, both);
        expect_agreement(std::string("Light samples alone against both kinds, ") + c.name, scene, light, scene, both);
    }
}

// Neither alone is what both are: the switch does something.
TEST(Estimators, DifferInNoise) {
    const Scene scene = file_scene("cornell_box");
    RenderSettings both = with(1), bsdf = with(1);
    both.samples_per_pixel = bsdf.samples_per_pixel = 16;
    bsdf.estimator = Estimator::bsdf;
    const auto scatter = [&](const RenderSettings& settings) {
        RenderSettings other = settings;
        other.seed = 7;
        const Image a = render(scene, settings).image;
        const Image b = render(scene, other).image;
        double sum = 0.0;
        for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::pow(static_cast<double>(a.rgb[i] - b.rgb[i]), 2);
        return sum;
    };
    EXPECT_GT(scatter(bsdf), 3.0 * scatter(both));
}

TEST(Estimators, SamplersAgree) {
    for (const Case& c : {cases[0], cases[3]}) {
        const Scene scene = c.make();
        RenderSettings independent = with(4);
        independent.sampler = Sampler::independent;
        expect_agreement(std::string("Independent samples against Sobol points, ") + c.name, scene, independent, scene, with(5));
    }
}

TEST(Estimators, TraversalKernelsAgree) {
    const Scene scene = file_scene("cornell_box");
    RenderSettings hierarchy = with(6);
    hierarchy.always_hierarchy = true;
    expect_agreement("Hierarchy against all triangles, cornell_box", scene, hierarchy, scene, with(7));
    // The same paths: all but the few whose roundings fall apart.
    hierarchy.seed = 7;
    hierarchy.samples_per_pixel = 4;
    RenderSettings few = hierarchy;
    few.always_hierarchy = false;
    const Image a = render(scene, hierarchy).image;
    const Image b = render(scene, few).image;
    std::size_t apart = 0;
    for (std::size_t i = 0; i < a.rgb.size() / 3; ++i) apart += glm::length(pixel(a, i) - pixel(b, i)) > 1e-3 * glm::length(pixel(a, i));
    EXPECT_LT(apart, a.rgb.size() / 300);
}

TEST(Estimators, RaysInTurnMakeTheSamePicture) {
    const Scene scene = file_scene("sunlit_mesh");
    RenderSettings settings = with(8);
    settings.samples_per_pixel = 4;
    settings.walks_in_turn = 1;
    const Image alone = render(scene, settings).image;
    settings.walks_in_turn = 8;
    EXPECT_EQ(render(scene, settings).image.rgb, alone.rgb);
}

TEST(Estimators, DirectLightIsThatOfPathsOfTwoEdges) {
    const SceneFolder folder;
    for (const char* name : {"cornell_box", "glossy_plates"}) {
        std::ifstream file(std::string(WAVELOBE_SOURCE_DIR) + "/scenes/" + name + ".xml");
        std::string text{std::istreambuf_iterator<char>(file), {}};
        const std::size_t start = text.find("<integrator");
        const std::size_t end = text.find("</integrator>");
        ASSERT_NE(end, std::string::npos);
        text.replace(start, end + 13 - start, "<integrator type=\"direct\"/>");
        folder.write("direct.xml", text);
        const Definitions size{{"width", std::to_string(width)}, {"height", std::to_string(height)}};
        const Scene direct = read_mitsuba_scene(folder.path("direct.xml"), size);
        Scene path = file_scene(name);
        path.integrator.max_depth = 2;
        expect_agreement(std::string("Direct integrator against paths of two edges, ") + name, direct, with(8), path, with(9));
    }
}

}  // namespace
}  // namespace wavelobe::test
