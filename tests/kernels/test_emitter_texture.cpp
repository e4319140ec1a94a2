// Textured emitters: the radiance of a sample is that of the texture at the sample's texture coordinates.
#include <gtest/gtest.h>

#include "support/light_models.h"

namespace wavelobe::test {
namespace {

constexpr double half_ulp = 0x1p-24;

// Two by two fields over [0, 1].
::Texture checkerboard() {
    ::Texture texture{};
    texture.kind = TEXTURE_CHECKERBOARD;
    texture.to_uv[0] = texture.to_uv[4] = 1.0F;
    texture.color0 = {1.0F, 2.0F, 3.0F};
    texture.color1 = {5.0F, 7.0F, 9.0F};
    return texture;
}

// Texture coordinates (u, v) of a point, in double precision.
using Coordinates = std::function<glm::dvec2(const glm::dvec3&)>;

void expect_checkerboard(const std::string& name, LightBuffers buffers, Uint32 index, const glm::vec3& reference,
                         const Coordinates& coordinates) {
    buffers.textures = {checkerboard()};
    buffers.lights[index].radiance.texture = 0;
    LightProbe probe({name, Reach::SURFACE}, buffers, 16, "-DHAS_TEXTURES=1 -DHAS_TEXTURED_EMITTERS=1");
    std::vector<LightQuery> queries;
    for (int i = 0; i < 4096; ++i) {
        LightQuery q;
        q.light = index;
        q.reference = reference;
        q.random = {(static_cast<float>(i % 64) + 0.5F) / 64.0F, (static_cast<float>(i / 64) + 0.5F) / 64.0F};
        queries.push_back(q);
    }
    std::size_t first = 0;
    std::size_t second = 0;
    for (const LightResult& s : probe.sample(queries)) {
        if (glm::dot(s.direction, s.normal) >= 0.0F) continue;
        const glm::dvec2 uv = coordinates(glm::dvec3(s.point));
        const glm::dvec2 inside = glm::abs(glm::fract(2.0 * uv) - 0.5);
        if (std::max(inside.x, inside.y) > 0.5 - 256.0 * half_ulp) continue;  // on a border between fields
        const bool same = (glm::fract(uv.x) > 0.5) == (glm::fract(uv.y) > 0.5);
        ASSERT_EQ(s.radiance, same ? glm::vec3(1.0F, 2.0F, 3.0F) : glm::vec3(5.0F, 7.0F, 9.0F)) << uv.x << ", " << uv.y;
        ++(same ? first : second);
    }
    EXPECT_GT(first, 256U);
    EXPECT_GT(second, 256U);
}

TEST(EmitterTexture, PlanarLights) {
    for (bool triangle : {true, false}) {
        LightBuffers buffers;
        const glm::vec3 e1(2.0F, 0.1F, 0.0F);
        const glm::vec3 e2(0.3F, 1.0F, 0.2F);
        Light light = planar_light({}, e1, e2, triangle ? 0.5 : 1.0);
        const float uv[] = {0.1F, 0.2F, 1.3F, 0.4F, 0.0F, 1.6F};
        std::copy_n(uv, 6, light.uv);
        buffers.lights = {light, light};
        const glm::dvec3 a(e1);
        const glm::dvec3 b(e2);
        expect_checkerboard(triangle ? "triangle" : "parallelogram", buffers, 1, {0.5F, 0.5F, 2.0F}, [=](const glm::dvec3& p) {
            const glm::dvec3 n = glm::cross(a, b);
            const double b1 = glm::dot(glm::cross(p, b), n) / glm::dot(n, n);
            const double b2 = glm::dot(glm::cross(a, p), n) / glm::dot(n, n);
            return (1.0 - b1 - b2) * glm::dvec2(uv[0], uv[1]) + b1 * glm::dvec2(uv[2], uv[3]) +
                   b2 * glm::dvec2(uv[4], uv[5]);
        });
    }
}

TEST(EmitterTexture, AnalyticLights) {
    const std::vector<std::pair<std::string, Uint32>> shapes = {
        {"sphere", ANALYTIC_SPHERE}, {"disk", ANALYTIC_DISK}, {"cylinder", ANALYTIC_CYLINDER}};
    for (const auto& [name, kind] : shapes) {
        SCOPED_TRACE(name);
        LightBuffers buffers;
        const Analytic record = analytic_record(kind, placed(1.0, glm::dvec3(1.0)));
        const LightModel m = analytic_model(buffers, record, {1.5, 1.0, 2.5});
        const AnalyticSurface surface(record);
        expect_checkerboard(name, buffers, m.light, m.reference,
                            [&](const glm::dvec3& p) { return glm::dvec2(surface.uv(Real3(p))); });
    }
}

TEST(EmitterTexture, LightsWithoutTextureKeepTheirRadiance) {
    LightBuffers buffers;
    buffers.textures = {checkerboard()};
    buffers.lights = {planar_light({}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, 0.5)};
    LightProbe probe({"triangle", Reach::SURFACE}, buffers, 16, "-DHAS_TEXTURES=1 -DHAS_TEXTURED_EMITTERS=1");
    LightQuery q;
    q.reference = {0.3F, 0.3F, 1.0F};
    EXPECT_EQ(probe.sample({q}).front().radiance, test_radiance);
}

}  // namespace
}  // namespace wavelobe::test
