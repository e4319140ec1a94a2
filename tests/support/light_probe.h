// Runs a light of lights/lights.def on the device, by its name.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "shared/lights.h"
#include "support/probe.h"

namespace wavelobe::test {

enum class Reach { SURFACE, ENVIRONMENT, DELTA };

struct LightName {
    std::string name;
    Reach reach;
};

inline std::vector<LightName> light_names() {
    return {
#define LIGHT(name, NAME, reach) {#name, Reach::reach},
#include "lights/lights.def"
#undef LIGHT
    };
}

inline void PrintTo(const LightName& light, std::ostream* out) { *out << light.name; }

// What a LightInput points at. Buffers that a light does not use hold one record.
struct LightBuffers {
    std::vector<Light> lights{1};
    std::vector<Analytic> analytics{1};
    std::vector<Environment> environment{1};
    std::vector<float> texels{0.0F};
    std::vector<float> sums{0.0F};
    std::vector<float> density{0.0F};
    std::vector<::Texture> textures{1};
    std::vector<float> texture_texels{0.0F};
};

struct LightQuery {
    Uint32 light = 0;
    glm::vec3 reference{0.0F};
    glm::vec2 random{0.0F};  // for a sample
    glm::vec3 direction{0.0F, 0.0F, 1.0F};  // for a density or radiance
    float t = 1.0F;
    glm::vec3 normal{0.0F, 0.0F, 1.0F};
};

struct LightResult {
    glm::vec3 direction, point, error, normal, radiance;
    float pdf, at_infinity, delta;
};

class LightProbe {
public:
    LightProbe(const LightName& light, const LightBuffers& buffers, int lanes = 16, const std::string& defines = {})
        : buffers_(buffers),
          lanes_(static_cast<std::size_t>(lanes)),
          probe_(source(light), {.lanes = lanes,
                                 .defines = "-DLIGHT_COUNT=" + std::to_string(buffers.lights.size()) + " " + defines}) {}

    std::vector<LightResult> sample(const std::vector<LightQuery>& queries) {
        const std::vector<float> out = run("sample", queries, 18);
        std::vector<LightResult> results(queries.size());
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const auto field = [&](std::size_t k) { return out[k * padded(queries.size()) + i]; };
            const auto vector = [&](std::size_t k) { return glm::vec3(field(k), field(k + 1), field(k + 2)); };
            results[i] = {vector(0), vector(3), vector(6), vector(9), vector(12), field(15), field(16), field(17)};
        }
        return results;
    }

    // At the hits the queries name. Not of DELTA lights.
    std::vector<float> pdf(const std::vector<LightQuery>& queries) {
        std::vector<float> out = run("density", queries, 1);
        out.resize(queries.size());
        return out;
    }

    // ENVIRONMENT: along the queries' directions.
    std::vector<glm::vec3> radiance(const std::vector<LightQuery>& queries) {
        const std::vector<float> out = run("radiance", queries, 3);
        std::vector<glm::vec3> results(queries.size());
        const std::size_t n = padded(queries.size());
        for (std::size_t i = 0; i < queries.size(); ++i) results[i] = {out[i], out[i + n], out[i + 2 * n]};
        return results;
    }

private:
    static constexpr std::size_t query_fields = 12;

    std::size_t padded(std::size_t n) const { return (n + 15) / 16 * 16; }

    static std::string source(const LightName& light) {
        std::string text = "#include \"lights/" + light.name + ".h\"\n" + common;
        const auto kernel = [&](const std::string& name, const std::string& body) {
            text += "kernel void " + name + "(" + parameters + ") {" + setup + body + "}\n";
        };
        kernel("sample", "LightSample s = " + light.name + "_sample_light(in, reference, QUERY(4), QUERY(5));" + store_sample);
        if (light.reach != Reach::DELTA) {
            kernel("density", "store(out + i, " + light.name +
                                  "_pdf(in, reference, QUERY3(6), QUERY(9), vec3(QUERY(10), QUERY(11), QUERY(0))));");
        }
        if (light.reach == Reach::ENVIRONMENT) {
            kernel("radiance", "put3(out + i, n, " + light.name + "_radiance(in, QUERY3(6)));");
        }
        return text;
    }

    std::vector<float> run(const char* kernel, const std::vector<LightQuery>& queries, std::size_t fields) {
        const std::size_t n = padded(queries.size());
        std::vector<Uint32> light(n, 0);
        std::vector<float> data(query_fields * n, 0.0F);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const LightQuery& q = queries[i];
            light[i] = q.light;
            const float values[query_fields] = {q.normal.z,    q.reference.x, q.reference.y, q.reference.z,
                                                q.random.x,    q.random.y,    q.direction.x, q.direction.y,
                                                q.direction.z, q.t,           q.normal.x,    q.normal.y};
            for (std::size_t k = 0; k < query_fields; ++k) data[k * n + i] = values[k];
        }
        std::vector<float> out(fields * n);
        const auto count = static_cast<cl_uint>(n);
        probe_.run(kernel, n / lanes_, buffers_.lights, buffers_.analytics, buffers_.environment, buffers_.texels,
                   buffers_.sums, buffers_.density, buffers_.textures, buffers_.texture_texels, light, data, count, out);
        return out;
    }

    static constexpr const char* common = R"(
#define QUERY(k) load(query + i + (k) * n)
#define QUERY3(k) vec3(QUERY(k), QUERY(k + 1), QUERY(k + 2))
INLINE void put3(global float *p, uint n, Vec3 v) { store(p, v.x); store(p + n, v.y); store(p + 2 * n, v.z); }
)";
    static constexpr const char* parameters =
        "global const struct Light *lights, global const struct Analytic *analytics, "
        "global const struct Environment *environment, global const float *environment_texels, "
        "global const float *environment_sums, global const float *environment_density, "
        "global const struct Texture *textures, global const float *texels, global const uint *light, "
        "global const float *query, uint n, global float *out";
    static constexpr const char* setup = R"(
    size_t i = get_global_id(0) * LANES;
    LightInput in;
    in.light = as_UInt(load((global const float *)light + i));
    in.lights = lights;
    in.analytics = analytics;
    in.environment = environment;
    in.environment_texels = environment_texels;
    in.environment_sums = environment_sums;
    in.environment_density = environment_density;
    in.textures = textures;
    in.texels = texels;
    Vec3 reference = QUERY3(1);
)";
    static constexpr const char* store_sample = R"(
    put3(out + i, n, s.direction);
    put3(out + i + 3 * n, n, s.point);
    put3(out + i + 6 * n, n, s.error);
    put3(out + i + 9 * n, n, s.normal);
    put3(out + i + 12 * n, n, s.radiance);
    store(out + i + 15 * n, s.pdf);
    store(out + i + 16 * n, SELECT(s.at_infinity, ONE, ZERO));
    store(out + i + 17 * n, SELECT(s.delta, ONE, ZERO));
)";

    LightBuffers buffers_;
    std::size_t lanes_;
    Probe probe_;
};

}  // namespace wavelobe::test
