// What materials do to light of known form: exact values under a directional light, energy in an even environment.
#include <gtest/gtest.h>

#include <numbers>

#include "render/flatten.h"
#include "support/lobe_reference.h"
#include "support/render.h"
#include "support/statistics.h"

namespace wavelobe::test {
namespace {

const Rgb radiance{1.0F, 2.0F, 3.5F};

struct Looked {
    Scene scene;
    glm::dvec3 wi;  // towards the camera: x along the quad's u, z along the normal
};

// A large quad in y = 0 with normal +y and u along +x, seen from `degrees` off its normal (beyond 90: from below).
Looked quad_seen_from(double degrees, MaterialModel model, double azimuth_degrees = 20.0) {
    Looked out{empty_scene(32), {}};
    const double theta = degrees * pi / 180.0;
    const double phi = azimuth_degrees * pi / 180.0;
    out.wi = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    const int material = add_material(out.scene, std::move(model));
    const bool both_sides = std::holds_alternative<RoughDielectric>(out.scene.materials[0].model) ||
                            std::holds_alternative<ThinDielectric>(out.scene.materials[0].model);
    Shape& quad = add_floor(out.scene, 50.0F, material);
    if (both_sides) quad.material.back = material;
    look_at_point(out.scene, 3.0F * glm::vec3(glm::dvec3{out.wi.x, out.wi.z, -out.wi.y}), {0, 0, 0});
    return out;
}

// The quad's material as kernels have it, which is what the reference lobes of lobe_reference.h take.
::Material device_material(const Scene& scene) { return flatten_scene(scene).materials.at(0); }

RoughConductor rough_copper(Distribution distribution, float alpha_u, float alpha_v) {
    return {{0.2F, 0.92F, 1.1F}, {3.9F, 2.45F, 2.2F}, constant(Rgb{0.9F, 1.0F, 0.8F}),
            constant(alpha_u),   constant(alpha_v),   distribution};
}

RoughDielectric rough_glass(Distribution distribution, float alpha) {
    return {1.5F, constant(1.0F), constant(Rgb{0.9F, 1.0F, 0.8F}), constant(alpha), constant(alpha), distribution};
}

Plastic red_plastic(bool nonlinear) { return {1.5F, constant(Rgb{0.7F, 0.2F, 0.05F}), constant(0.9F), nonlinear}; }

Phong shiny_phong(float exponent) {
    return {constant(Rgb{0.3F, 0.2F, 0.1F}), constant(Rgb{0.2F, 0.3F, 0.4F}), constant(exponent)};
}

RoughPlastic dark_rough_plastic() {
    RoughPlastic plastic;
    plastic.diffuse_reflectance = constant(0.0F);
    plastic.alpha = 0.3F;
    return plastic;
}

// Half metal, half paint.
MetallicRoughness painted_metal() {
    MetallicRoughness material;
    material.base_color = constant(Rgb{0.9F, 0.5F, 0.3F});
    material.metallic = constant(0.5F);
    material.roughness = constant(0.6F);
    return material;
}

using Evals = std::vector<ReferenceEval>;

// ---- a directional light: the value of the smooth lobes, exactly ----------------------------------------------

struct Lit {
    const char* name;
    MaterialModel model;
    Evals lobes;
    double view_degrees;
    glm::vec3 to_light;  // world
};

void PrintTo(const Lit& lit, std::ostream* out) { *out << lit.name; }

class DirectionalLight : public testing::TestWithParam<Lit> {};

TEST_P(DirectionalLight, ShowsTheLobesValue) {
    const Lit& lit = GetParam();
    Looked looked = quad_seen_from(lit.view_degrees, lit.model);
    looked.scene.integrator.max_depth = 2;
    const glm::vec3 travels = glm::normalize(-lit.to_light);
    looked.scene.emitters.emplace_back(DirectionalEmitter{travels, radiance});
    const glm::dvec3 wo{-travels.x, travels.z, -travels.y};
    const ::Material material = device_material(looked.scene);
    const auto value = [&](const glm::dvec3& wi, const glm::dvec3& light) {
        glm::dvec3 sum{0.0};
        for (const ReferenceEval& lobe : lit.lobes)
            sum += lobe(material, glm::normalize(wi), glm::normalize(light)).f_cos;
        return sum;
    };
    const glm::dvec3 expected = value(looked.wi, wo);
    EXPECT_GT(glm::length(expected), 1e-3) << "nothing is tested";
    if (std::holds_alternative<Plastic>(lit.model)) {
        // Some paths follow the coat instead, and see no light.
        expect_closed_form(looked.scene, 256, expected * glm::dvec3(radiance));
        return;
    }
    // Directions are known to a few roundings, which narrow lobes magnify.
    constexpr double direction_rounding = 4 * 0x1p-24;
    glm::dvec3 change{0.0};
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        glm::dvec3 step{0.0};
        step[axis] = direction_rounding;
        change += glm::abs(value(looked.wi + step, wo) - expected) + glm::abs(value(looked.wi, wo + step) - expected);
    }
    const Image image = render(looked.scene, 16).image;
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
        for (int c = 0; c < 3; ++c) {
            const double e = radiance[c];
            ASSERT_NEAR(pixel(image, i)[c], expected[c] * e, e * (change[c] + path_rounding * expected[c]))
                << "pixel " << i;
        }
    }
}

const glm::vec3 above{0.5F, 1.0F, 0.3F};
const glm::vec3 below{-0.3F, -1.0F, 0.1F};

INSTANTIATE_TEST_SUITE_P(
    All, DirectionalLight,
    testing::Values(
        Lit{"ggx", rough_copper(Distribution::ggx, 0.3F, 0.3F), {reference_rough_conductor}, 40, above},
        Lit{"ggx_anisotropic", rough_copper(Distribution::ggx, 0.1F, 0.4F), {reference_rough_conductor}, 40, above},
        Lit{"beckmann", rough_copper(Distribution::beckmann, 0.3F, 0.3F), {reference_rough_conductor}, 55, above},
        Lit{"glass_reflects", rough_glass(Distribution::ggx, 0.4F), {reference_rough_dielectric}, 40, above},
        Lit{"glass_refracts_down", rough_glass(Distribution::ggx, 0.4F), {reference_rough_dielectric}, 30, below},
        Lit{"glass_refracts_up",
            rough_glass(Distribution::ggx, 0.4F),
            {reference_rough_dielectric},
            150,
            glm::vec3{-0.6F, 1.0F, 0.3F}},
        Lit{"plastic", red_plastic(false), {reference_plastic_base}, 40, above},
        Lit{"plastic_nonlinear", red_plastic(true), {reference_plastic_base}, 60, above},
        Lit{"phong", shiny_phong(20.0F), {reference_phong, reference_lambert}, 40, glm::vec3{-0.6F, 1.0F, 0.4F}}),
    [](const auto& lit) { return lit.param.name; });

// ---- an even environment: how much a material reflects and transmits in all -----------------------------------------

TEST(EvenEnvironment, ConductorShowsItsFresnelReflectance) {
    for (const double degrees : {0.0, 60.0, 85.0}) {
        Looked looked = quad_seen_from(degrees, Conductor{{0.2F, 0.92F, 1.1F}, {3.9F, 2.45F, 2.2F}, constant(0.9F)});
        looked.scene.emitters.emplace_back(ConstantEmitter{radiance});
        const glm::dvec3 fresnel = reference_fresnel_conductor(device_material(looked.scene), looked.wi.z);
        expect_every_pixel(render(looked.scene, 16).image, static_cast<double>(0.9F) * fresnel * glm::dvec3(radiance));
    }
}

// A glass ball neither adds nor takes anything, along any of its chains of reflections.
TEST(EvenEnvironment, GlassBallIsInvisible) {
    Scene scene = empty_scene(32);
    look_at(scene, {0, 0, -4}, {0, 0, 0}, {0, 1, 0}, 25.0F);
    scene.integrator.rr_depth = 1000;
    const int glass = add_material(scene, Dielectric{1.5F, constant(1.0F), constant(1.0F)});
    add_sphere(scene, {0, 0, 0}, 1.0F, glass).material.back = glass;
    scene.emitters.emplace_back(ConstantEmitter{radiance});
    expect_every_pixel(render(scene, 16).image, radiance);
}

TEST(EvenEnvironment, ThinPaneIsInvisible) {
    for (const double degrees : {30.0, 80.0, 120.0}) {
        Looked looked = quad_seen_from(degrees, ThinDielectric{1.5F, constant(1.0F), constant(1.0F)});
        looked.scene.emitters.emplace_back(ConstantEmitter{radiance});
        expect_every_pixel(render(looked.scene, 16).image, radiance);
    }
}

struct Energy {
    const char* name;
    MaterialModel model;
    Evals lobes;
    ReferenceDelta delta;  // may be none
    double view_degrees;
};

void PrintTo(const Energy& energy, std::ostream* out) { *out << energy.name; }

class EvenEnvironments : public testing::TestWithParam<Energy> {};

TEST_P(EvenEnvironments, GiveTheAlbedo) {
    const Energy& energy = GetParam();
    Looked looked = quad_seen_from(energy.view_degrees, energy.model);
    looked.scene.emitters.emplace_back(ConstantEmitter{radiance});
    const ::Material material = device_material(looked.scene);
    glm::dvec3 albedo{0.0};
    const auto integrand = [&](const std::vector<glm::dvec3>& directions) {
        std::vector<double> values;
        for (const glm::dvec3& wo : directions) {
            glm::dvec3 sum{0.0};
            for (const ReferenceEval& lobe : energy.lobes) sum += lobe(material, looked.wi, wo).f_cos;
            values.insert(values.end(), {sum.x, sum.y, sum.z});
        }
        return values;
    };
    const SphereGrid grid = SphereGrid::whole(16);
    const std::vector<double> integrals = integrate_cells(grid, integrand, 3, 1e-7);
    for (std::size_t i = 0; i < integrals.size(); i += 3)
        albedo += glm::dvec3{integrals[i], integrals[i + 1], integrals[i + 2]};
    if (energy.delta) {
        for (const DeltaBranch& branch : energy.delta(material, looked.wi))
            albedo += branch.probability * branch.weight;
    }
    expect_closed_form(looked.scene, 64, albedo * glm::dvec3(radiance));
}

INSTANTIATE_TEST_SUITE_P(
    All, EvenEnvironments,
    testing::Values(
        Energy{"ggx", rough_copper(Distribution::ggx, 0.3F, 0.3F), {reference_rough_conductor}, {}, 40},
        Energy{"ggx_grazing", rough_copper(Distribution::ggx, 0.3F, 0.3F), {reference_rough_conductor}, {}, 82},
        Energy{"beckmann", rough_copper(Distribution::beckmann, 0.4F, 0.4F), {reference_rough_conductor}, {}, 55},
        Energy{"glass_from_above", rough_glass(Distribution::ggx, 0.4F), {reference_rough_dielectric}, {}, 40},
        Energy{"glass_from_below", rough_glass(Distribution::ggx, 0.4F), {reference_rough_dielectric}, {}, 130},
        Energy{"plastic", red_plastic(false), {reference_plastic_base}, reference_plastic_coat, 40},
        Energy{"plastic_nonlinear", red_plastic(true), {reference_plastic_base}, reference_plastic_coat, 75},
        Energy{"rough_plastic_coat", dark_rough_plastic(), {reference_rough_plastic_coat}, {}, 50},
        Energy{"metallic_roughness",
               painted_metal(),
               {reference_metallic_roughness, reference_metallic_roughness_base},
               {},
               40},
        Energy{"phong", shiny_phong(20.0F), {reference_phong, reference_lambert}, {}, 40},
        Energy{"lambert", Diffuse{constant(Rgb{0.2F, 0.5F, 1.0F})}, {reference_lambert}, {}, 70}),
    [](const auto& energy) { return energy.param.name; });

// Phong's lobe keeps its energy at normal incidence, whatever the exponent.
TEST(EvenEnvironment, PhongReflectsItsSpecularPart) {
    for (const float exponent : {1.0F, 10.0F, 1e3F, 1e4F}) {
        Phong phong = shiny_phong(exponent);
        phong.diffuse_reflectance = constant(0.0F);
        Looked looked = quad_seen_from(0.0, phong);
        looked.scene.emitters.emplace_back(ConstantEmitter{radiance});
        expect_closed_form(looked.scene, 256, glm::dvec3{0.2F, 0.3F, 0.4F} * glm::dvec3(radiance));
    }
}

// ---- sides, normals, textures --------------------------------------------------------------------------------------

// Lambert's value for a light of irradiance `radiance` at a cosine.
glm::dvec3 lambert(const glm::dvec3& albedo, double cosine) { return albedo * glm::dvec3(radiance) * cosine / pi; }

TEST(Sides, EachShowsItsOwnMaterial) {
    const glm::vec3 down = glm::normalize(glm::vec3{0.3F, -1.0F, 0.2F});
    const double cosine = -static_cast<double>(down.y);
    for (const double view : {30.0, 150.0}) {
        for (const bool twosided : {true, false}) {
            Looked looked = quad_seen_from(view, Diffuse{constant(Rgb{0.9F, 0.5F, 0.1F})});
            const int back = add_diffuse(looked.scene, {0.2F, 0.4F, 0.6F});
            if (twosided) looked.scene.shapes[0].material.back = back;
            const bool front_seen = view < 90.0;
            looked.scene.emitters.emplace_back(DirectionalEmitter{front_seen ? down : -down, radiance});
            const Image image = render(looked.scene, 16).image;
            if (front_seen) expect_every_pixel(image, lambert({0.9F, 0.5F, 0.1F}, cosine));
            if (!front_seen && twosided) expect_every_pixel(image, lambert({0.2F, 0.4F, 0.6F}, cosine));
            if (!front_seen && !twosided) expect_every_pixel(image, {0, 0, 0});
        }
    }
}

// A mirror in front, paint behind: the class of lobes depends on the side.
TEST(Sides, OfDifferentLobeClasses) {
    for (const double view : {30.0, 150.0}) {
        Looked looked = quad_seen_from(view, Conductor{});
        looked.scene.shapes[0].material.back = add_diffuse(looked.scene, {0.2F, 0.4F, 0.6F});
        looked.scene.emitters.emplace_back(ConstantEmitter{radiance});
        if (view < 90.0) {
            expect_every_pixel(render(looked.scene, 64).image, radiance);
        } else {
            expect_closed_form(looked.scene, 64, glm::dvec3{0.2F, 0.4F, 0.6F} * glm::dvec3(radiance));
        }
    }
}

TEST(ShadingNormals, AreInterpolated) {
    Looked looked = quad_seen_from(30.0, Diffuse{constant(0.5F)});
    auto& mesh = std::get<TriangleMesh>(looked.scene.shapes[0].geometry);
    const glm::vec3 normals[4] = {{0.3F, 1, 0}, {-0.2F, 1, 0.1F}, {0.1F, 1, 0.5F}, {0, 1, -0.3F}};
    for (const glm::vec3& n : normals) mesh.normals.push_back(glm::normalize(n));
    const glm::vec3 down = glm::normalize(glm::vec3{0.4F, -1.0F, 0.2F});
    looked.scene.emitters.emplace_back(DirectionalEmitter{down, radiance});
    // The middle of the diagonal from the first vertex to the third.
    const glm::dvec3 normal = glm::normalize(glm::dvec3(mesh.normals[0]) + glm::dvec3(mesh.normals[2]));
    expect_every_pixel(render(looked.scene, 16).image, lambert(glm::dvec3(0.5), -glm::dot(normal, glm::dvec3(down))));
}

// The quad spans [-50, 50]^2 with u along +x and v along -z; to_uv makes 100 squares a side, one unit wide.
TEST(Textures, CheckerboardIsWhereItsCoordinatesSay) {
    const auto board = std::make_shared<Texture>();
    board->source = Checkerboard{{0.9F, 0.1F, 0.2F}, {0.3F, 0.6F, 0.4F}};
    board->to_uv = glm::mat3(50.0F);
    board->to_uv[2] = {0, 0, 1};
    Scene scene = empty_scene(32);
    add_floor(scene, 50.0F, add_material(scene, Diffuse{{Rgb{0.0F}, board}}));
    scene.emitters.emplace_back(DirectionalEmitter{{0, -1, 0}, radiance});
    for (const glm::vec2 at :
         {glm::vec2{0.3F, -0.4F}, glm::vec2{1.3F, -0.4F}, glm::vec2{1.3F, 0.4F}, glm::vec2{-7.6F, 3.2F}}) {
        look_at_point(scene, {at.x + 1, 2, at.y - 1}, {at.x, 0, at.y});
        const double u = (static_cast<double>(at.x) + 50.0) / 2.0;
        const double v = (50.0 - static_cast<double>(at.y)) / 2.0;
        const bool same = (u - std::floor(u) > 0.5) == (v - std::floor(v) > 0.5);
        const glm::dvec3 albedo = same ? glm::dvec3{0.9F, 0.1F, 0.2F} : glm::dvec3{0.3F, 0.6F, 0.4F};
        expect_every_pixel(render(scene, 16).image, lambert(albedo, 1.0));
    }
}

}  // namespace
}  // namespace wavelobe::test
