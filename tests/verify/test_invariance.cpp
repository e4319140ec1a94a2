// What must not change a picture: the size of the scene, where it stands, the order in which it is written.
#include <algorithm>

#include "support/many_features.h"
#include "support/render.h"
#include "support/triangle_meshes.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

constexpr int width = 64;
constexpr int height = 48;

// The scene under p * scale + offset, lights scaled so that radiance stays.
Scene moved(Scene scene, float scale, const glm::vec3& offset) {
    const auto place = [&](const glm::vec3& p) { return p * scale + offset; };
    const auto map = [&](const glm::mat4& m, float size) {
        glm::mat4 r = m;
        for (int c = 0; c < 3; ++c) r[c] = m[c] * size;
        r[3] = glm::vec4(place(glm::vec3(m[3])), 1.0F);
        return r;
    };
    for (Shape& shape : scene.shapes) {
        if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
            for (glm::vec3& p : mesh->positions) p = place(p);
        } else {
            auto& analytic = std::get<AnalyticShape>(shape.geometry);
            analytic.to_world = map(analytic.to_world, scale);
        }
    }
    for (Emitter& emitter : scene.emitters) {
        if (auto* point = std::get_if<PointEmitter>(&emitter)) {
            point->position = place(point->position);
            point->intensity *= scale * scale;
        }
    }
    scene.camera.to_world = map(scene.camera.to_world, 1.0F);
    scene.camera.near_clip *= scale;
    scene.camera.far_clip *= scale;
    return scene;
}

std::size_t differing_pixels(const Image& a, const Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgb.size() / 3; ++i) count += pixel(a, i) != pixel(b, i);
    return count;
}

Rendering picture(const Scene& scene, int spp, std::uint32_t seed = 0) {
    RenderSettings settings;
    settings.samples_per_pixel = spp;
    settings.seed = seed;
    return render(scene, settings);
}

TEST(Invariance, PowersOfTwo) {
    const Scene scene = many_features_scene(width, height);
    const Image unit = picture(scene, 16).image;
    Claim claim("Numerical stability", "Scene scaled by a power of two from 2^-20 to 2^20: pixels that differ in any bit", "pixels");
    const std::vector<int> few{-20, -7, 1, 20};
    std::vector<int> exponents;
    for (int e = -20; e <= 20; ++e) {
        if (verify_fully() || std::ranges::count(few, e) > 0) exponents.push_back(e);
    }
    for (int e : exponents) {
        const Image scaled = picture(moved(scene, std::ldexp(1.0F, e), glm::vec3(0.0F)), 16).image;
        claim.observe(static_cast<double>(differing_pixels(unit, scaled)), [&] { return "2^" + std::to_string(e); });
    }
    claim.count(exponents.size() * width * height * 16);
    claim.at_most(0.0);
}

// Difference of two estimates of the same picture, in standard errors of the mean over its pixels.
double deviation(const Image& a, const Image& b) {
    glm::dvec3 sum{0.0}, squares{0.0};
    const std::size_t n = a.rgb.size() / 3;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 d = pixel(a, i) - pixel(b, i);
        sum += d;
        squares += d * d;
    }
    double worst = 0.0;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(sum[c]) / std::sqrt(squares[c]));
    return worst;
}

// Far from the origin coordinates have few digits: the picture is that of slightly moved vertices, without acne.
TEST(Invariance, TranslationByTenThousandSizes) {
    const int spp = quick_or_full(64, 1024);
    const Scene scene = many_features_scene(width, height);
    Claim claim("Numerical stability", "Scene translated by 10^4 sizes: change of the mean", "standard errors");
    const Image here = picture(scene, spp, 1).image;
    claim.observe(deviation(here, picture(moved(scene, 1.0F, {4e4F, 0.0F, 0.0F}), spp, 2).image), [] { return "along x"; });
    claim.observe(deviation(here, picture(moved(scene, 1.0F, {3e4F, -2e4F, 2e4F}), spp, 3).image), [] { return "along all axes"; });
    claim.count(std::uint64_t{3} * width * height * static_cast<std::uint64_t>(spp));
    claim.at_most(4.5);
}

// Triangles of a mesh in reverse, with what belongs to each; lights that were one parallelogram become two triangles.
void reverse_triangles(Scene& scene) {
    for (Shape& shape : scene.shapes) {
        auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (mesh == nullptr) continue;
        std::ranges::reverse(mesh->triangles);
        mesh->parallelogram = false;
    }
}

TEST(Invariance, OrderOfShapesTrianglesMaterialsAndLights) {
    const int spp = quick_or_full(64, 1024);
    Scene scene = many_features_scene(width, height);
    const ClosedMesh sphere = sphere_mesh(2, 0.4F, {0.3F, 1.8F, 0.8F});
    TriangleMesh ball;
    ball.positions = sphere.vertices;
    ball.triangles = sphere.faces;
    add_shape(scene, ball, add_diffuse(scene, {0.8F, 0.8F, 0.3F}), "ball");
    Scene reversed = scene;
    reverse_triangles(reversed);
    std::ranges::reverse(reversed.shapes);
    std::ranges::reverse(reversed.emitters);
    std::ranges::reverse(reversed.materials);
    const int last = static_cast<int>(scene.materials.size()) - 1;
    for (Shape& shape : reversed.shapes) {
        for (int* m : {&shape.material.front, &shape.material.back}) {
            if (*m >= 0) *m = last - *m;
        }
    }
    Claim claim("Numerical stability", "Shapes, triangles, materials and lights in reverse order: change of the mean", "standard errors");
    claim.observe(deviation(picture(scene, spp, 4).image, picture(reversed, spp, 5).image));
    claim.count(std::uint64_t{2} * width * height * static_cast<std::uint64_t>(spp));
    claim.at_most(4.5);
}

// Every sample is the float next to 0.1: so is their mean, however many there are.
TEST(LongSums, MeanOfAPixel) {
    Scene scene = empty_scene(1);
    scene.emitters.emplace_back(ConstantEmitter{Rgb{0.1F, 1e-30F, 1e30F}});
    const int spp = quick_or_full(1000000, 10000000);
    Claim claim("Numerical stability", "Mean of the samples of one pixel: error from accumulation", "relative");
    const Image image = picture(scene, spp).image;
    const glm::dvec3 expected{0.1F, 1e-30F, 1e30F};
    for (int c = 0; c < 3; ++c) claim.observe(std::abs(pixel(image, 0)[c] / expected[c] - 1.0));
    claim.count(static_cast<std::uint64_t>(spp));
    claim.at_most(1e-6);
}

// ---- torture: whatever a scene holds, a sample is a number ----------------------------------------------------------

struct Torture {
    const char* name;
    void (*change)(Scene&);
};

int glass_of(Scene& scene, float alpha) {
    return add_material(scene, RoughDielectric{1.5F, constant(1.0F), constant(1.0F), constant(alpha), constant(alpha), Distribution::ggx});
}

const std::vector<Torture>& tortures() {
    static const std::vector<Torture> list{
        {"roughness zero through every microfacet", [](Scene& s) {
             for (Material& m : s.materials) {
                 if (auto* metal = std::get_if<RoughConductor>(&m.model)) *metal = {metal->eta, metal->k, metal->specular_reflectance, constant(0.0F), constant(0.0F), Distribution::beckmann};
                 if (auto* glass = std::get_if<RoughDielectric>(&m.model)) *glass = {1.5F, constant(1.0F), constant(1.0F), constant(0.0F), constant(0.0F), Distribution::ggx};
             }
         }},
        {"light touching the floor", [](Scene& s) { make_emitter(add_quad(s, {-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, add_diffuse(s, Rgb{0.5F})), Rgb{5.0F}); }},
        {"coincident faces", [](Scene& s) {
             for (int i = 0; i < 3; ++i) add_floor(s, 3.0F, add_diffuse(s, Rgb{0.3F}));
         }},
        {"point light on a surface and in a vertex", [](Scene& s) {
             s.emitters.emplace_back(PointEmitter{{0, 0, 0}, Rgb{1}});
             s.emitters.emplace_back(PointEmitter{{-3, 0, 3}, Rgb{1}});
         }},
        {"normals of zero length", [](Scene& s) {
             for (Shape& shape : s.shapes) {
                 auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
                 if (mesh != nullptr && !mesh->normals.empty()) std::ranges::fill(mesh->normals, glm::vec3(0.0F));
             }
         }},
        {"texture coordinates all alike", [](Scene& s) {
             for (Shape& shape : s.shapes) {
                 if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) std::ranges::fill(mesh->uvs, glm::vec2(0.25F));
             }
         }},
        {"triangles without area", [](Scene& s) {
             add_triangle(s, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, add_diffuse(s, Rgb{0.5F}));
             add_triangle(s, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, add_diffuse(s, Rgb{0.5F}));
         }},
        {"environment of 1e30 and denormals", [](Scene& s) {
             std::erase_if(s.emitters, [](const Emitter& e) { return std::holds_alternative<ConstantEmitter>(e); });
             EnvironmentMap map;
             map.image.width = 4, map.image.height = 3;
             map.image.rgb.assign(4 * 3 * 3, 1e-40F);
             for (int c = 0; c < 3; ++c) map.image.rgb[static_cast<std::size_t>(12 + c)] = 1e30F;
             s.emitters.emplace_back(map);
         }},
        {"radiance 1e-30", [](Scene& s) {
             for (Shape& shape : s.shapes) if (shape.emitter) shape.emitter->radiance = constant(1e-30F);
         }},
        {"radiance 1e30", [](Scene& s) {
             for (Shape& shape : s.shapes) if (shape.emitter) shape.emitter->radiance = constant(1e30F);
         }},
        {"camera inside rough glass", [](Scene& s) {
             const int glass = glass_of(s, 1e-4F);
             add_sphere(s, {0.3F, 1.6F, 5.0F}, 1.0F, glass).material.back = glass;
         }},
        {"field of view 0.001 degrees", [](Scene& s) { s.camera.fov_x_degrees = 0.001F; }},
        {"field of view 179 degrees", [](Scene& s) { s.camera.fov_x_degrees = 179.0F; }},
    };
    return list;
}

TEST(Torture, NoSampleIsLost) {
    Claim claim("Numerical stability", "Torture scenes: samples that are not finite, or lost", "samples");
    std::uint64_t samples = 0;
    for (const Torture& torture : tortures()) {
        Scene scene = many_features_scene(width, height);
        torture.change(scene);
        RenderSettings settings;
        settings.samples_per_pixel = quick_or_full(32, 26000);
        settings.time_limit = quick_or_full(0.0, 120.0);  // a machine in the way is no reason to wait for ever
        Renderer renderer(device(), scene, settings);
        EXPECT_TRUE(renderer.render());
        const RenderStats& stats = renderer.stats();
        samples += stats.samples;
        claim.observe(static_cast<double>(stats.nan_samples), [&] { return torture.name; });
        for (const NonFiniteSample& s : stats.nan_examples) {
            ADD_FAILURE() << torture.name << ": pixel " << s.name.x << "," << s.name.y << " sample " << s.name.sample << " in " << s.stage;
        }
    }
    claim.count(samples);
    claim.at_most(0.0);
    EXPECT_GE(samples, quick_or_full<std::uint64_t>(1'000'000, 1'000'000'000));
}

}  // namespace
}  // namespace wavelobe::test
