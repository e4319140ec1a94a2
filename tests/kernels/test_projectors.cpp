// Lights that throw a picture: projectors, and spots with a texture, against their formulas in double precision.
#include <gtest/gtest.h>

#include "render/flatten.h"
#include "support/light_models.h"
#include "support/scenes.h"

namespace wavelobe::test {
namespace {

constexpr double half_ulp = 0x1p-24;

// Two by two fields over [0, 1].
std::shared_ptr<const Texture> board() {
    return std::make_shared<Texture>(Texture{Checkerboard{{1.0F, 2.0F, 3.0F}, {0.5F, 0.25F, 0.125F}}, glm::mat3(1.0F), "board"});
}

// Whether (u, v) is in a field of the first colour; nothing close to a border.
std::optional<bool> first_field(const glm::dvec2& uv) {
    const glm::dvec2 inside = glm::abs(glm::fract(2.0 * uv) - 0.5);
    if (std::max(inside.x, inside.y) > 0.5 - 1e-4) return std::nullopt;
    return (glm::fract(uv.x) > 0.5) == (glm::fract(uv.y) > 0.5);
}

glm::mat4 some_place(float scale) {
    glm::mat4 m = glm::translate(glm::mat4(1.0F), {0.3F, -0.2F, 0.1F});
    m = glm::rotate(m, 1.1F, glm::normalize(glm::vec3(0.2F, -0.7F, 0.4F)));
    return glm::scale(m, glm::vec3(scale));
}

// The emitter as the renderer hands it to the kernels, and samples of it from all around.
struct Thrown {
    std::vector<LightQuery> queries;
    std::vector<LightResult> samples;
};

Thrown samples_of(const std::string& name, const Emitter& emitter, int lanes = 16) {
    Scene scene = empty_scene(1);
    scene.emitters.push_back(emitter);
    const DeviceScene device = flatten_scene(scene);
    LightBuffers buffers;
    buffers.lights = device.lights;
    if (!device.textures.empty()) buffers.textures = device.textures;
    const std::string defines = device.textures.empty() ? "" : "-DHAS_TEXTURES=1 -DHAS_TEXTURED_EMITTERS=1";
    Thrown thrown;
    std::mt19937 random(31);
    std::uniform_real_distribution<float> uniform(-2.0F, 2.0F);
    for (int i = 0; i < 4096; ++i) {
        LightQuery q;
        q.reference.x = uniform(random);
        q.reference.y = uniform(random);
        q.reference.z = uniform(random);
        thrown.queries.push_back(q);
    }
    thrown.samples = LightProbe({name, Reach::DELTA}, buffers, lanes, defines).sample(thrown.queries);
    return thrown;
}

ProjectorEmitter some_projector(float scale) {
    ProjectorEmitter p;
    p.to_world = some_place(scale);
    p.irradiance = {Rgb{1.0F}, board()};
    p.scale = 2.5F;
    p.fov_x_degrees = 80.0F;
    p.aspect = 1.5F;
    return p;
}

TEST(Projector, ThrowsItsPictureThroughAPinhole) {
    for (const float scale : {1.0F, 3.0F}) {
        const ProjectorEmitter p = some_projector(scale);
        const Thrown thrown = samples_of("projector", p);
        const double half_width = std::tan(glm::radians(0.5 * static_cast<double>(p.fov_x_degrees)));
        std::size_t lit = 0, dark = 0;
        for (std::size_t i = 0; i < thrown.queries.size(); ++i) {
            const glm::dvec3 at = glm::dvec3(thrown.queries[i].reference) - glm::dvec3(p.to_world[3]);
            const glm::dvec3 local = glm::inverse(glm::dmat3(p.to_world)) * at;
            // Film of a perspective camera: +x to the left, +y up.
            const glm::dvec2 uv = 0.5 - 0.5 * glm::dvec2(local.x, local.y * static_cast<double>(p.aspect)) / (local.z * half_width);
            const glm::dvec2 edge = glm::abs(glm::abs(uv - 0.5) - 0.5);
            if (std::min(edge.x, edge.y) < 1e-4) continue;
            glm::dvec3 expected(0.0);
            if (local.z > 0.0 && uv.x > 0.0 && uv.x < 1.0 && uv.y > 0.0 && uv.y < 1.0) {
                const std::optional<bool> first = first_field(uv);
                if (!first) continue;
                const glm::dvec3 picture = *first ? glm::dvec3(1.0, 2.0, 3.0) : glm::dvec3(0.5, 0.25, 0.125);
                // Mitsuba's: over z squared, in the projector's space, and the cosine with its axis, which its scale lengthens.
                const double cosine = glm::dot(glm::dvec3(p.to_world[2]), at) / glm::length(at);
                expected = picture * (std::numbers::pi * static_cast<double>(p.scale) / (local.z * local.z * cosine));
                ++lit;
            } else {
                ++dark;
            }
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(thrown.samples[i].radiance[c], expected[c], 200 * half_ulp * expected[c]) << i << " " << uv.x << " " << uv.y;
            }
        }
        EXPECT_GT(lit, 300U);
        EXPECT_GT(dark, 300U);
    }
}

TEST(Projector, AConstantPictureIsEvenOnAPlaneThatFacesIt) {
    ProjectorEmitter p;
    p.irradiance = {Rgb{0.5F}, nullptr};
    p.fov_x_degrees = 90.0F;
    Scene scene = empty_scene(1);
    scene.emitters.push_back(p);
    LightBuffers buffers;
    buffers.lights = flatten_scene(scene).lights;
    std::vector<LightQuery> queries(3);
    queries[0].reference = {0, 0, 1};
    queries[1].reference = {0.6F, -0.3F, 1};
    queries[2].reference = {1.2F, -0.6F, 2};
    const std::vector<LightResult> samples = LightProbe({"projector", Reach::DELTA}, buffers).sample(queries);
    for (std::size_t i = 0; i < 3; ++i) {
        const double z = queries[i].reference.z;
        const double irradiance = static_cast<double>(samples[i].radiance.x) * -static_cast<double>(samples[i].direction.z);
        EXPECT_NEAR(irradiance, 0.5 * std::numbers::pi / (z * z), 1e-6);
    }
}

TEST(SpotLight, IsTintedByItsTexture) {
    SpotEmitter spot;
    spot.to_world = some_place(1.0F);
    spot.intensity = {2.0F, 2.0F, 2.0F};
    spot.cutoff_degrees = 60.0F;
    spot.beam_width_degrees = 60.0F;
    spot.texture = board();
    const Thrown thrown = samples_of("spot", spot);
    std::size_t lit = 0;
    for (std::size_t i = 0; i < thrown.queries.size(); ++i) {
        const glm::dvec3 at = glm::dvec3(thrown.queries[i].reference) - glm::dvec3(spot.to_world[3]);
        const glm::dvec3 local = glm::inverse(glm::dmat3(spot.to_world)) * at;
        const double cosine = local.z / glm::length(local), cutoff = std::cos(glm::radians(60.0));
        if (std::abs(cosine - cutoff) < 1e-4) continue;
        glm::dvec3 expected(0.0);
        if (cosine > cutoff) {
            const std::optional<bool> first = first_field(0.5 + 0.5 * glm::dvec2(local) / (local.z * std::tan(glm::radians(60.0))));
            if (!first) continue;
            expected = (*first ? glm::dvec3(1.0, 2.0, 3.0) : glm::dvec3(0.5, 0.25, 0.125)) * (2.0 / glm::dot(at, at));
            ++lit;
        }
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(thrown.samples[i].radiance[c], expected[c], 100 * half_ulp * expected[c]) << i;
    }
    EXPECT_GT(lit, 300U);
}

TEST(Projector, SameBitsAtEveryWidth) {
    const Thrown wide = samples_of("projector", some_projector(1.0F));
    for (const int lanes : {1, 8}) {
        const Thrown narrow = samples_of("projector", some_projector(1.0F), lanes);
        for (std::size_t i = 0; i < wide.samples.size(); ++i) ASSERT_EQ(narrow.samples[i].radiance, wide.samples[i].radiance);
    }
}

}  // namespace
}  // namespace wavelobe::test
