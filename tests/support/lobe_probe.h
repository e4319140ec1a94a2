// Runs a lobe of bsdf/lobes.def on the device, by its name.
#pragma once

#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "shared/materials.h"
#include "support/lobe_extensions.h"
#include "support/probe.h"

namespace wavelobe::test {

struct LobeName {
    std::string name;
    bool delta;
};

inline std::vector<LobeName> lobe_names() {
    constexpr bool DELTA = true;
    constexpr bool GLOSSY = false;
    constexpr bool DIFFUSE = false;
    return {
#define LOBE(name, NAME, class) {#name, class},
#include "bsdf/lobes.def"
#undef LOBE
    };
}

inline void PrintTo(const LobeName& lobe, std::ostream* out) { *out << lobe.name; }

struct LobeResult {
    glm::vec3 f_cos{0.0F};
    float pdf = 0.0F;
};

struct LobeSample {
    glm::vec3 wo{0.0F};
    LobeResult value;       // glossy and diffuse: eval at wo. Delta: f_cos is the weight
    float eta = 1.0F;       // delta
    float weight = 0.0F;    // in lobe selection
};

// One item: which material, where from.
struct LobeQuery {
    std::uint32_t material = 0;
    glm::vec3 wi{0.0F};
    glm::vec3 wo_or_u{0.0F};  // eval: wo; sample: three random numbers
};

class LobeProbe {
public:
    LobeProbe(const LobeName& lobe, int lanes)
        : lanes_(lanes), probe_(source(lobe), {.lanes = lanes, .defines = "-DHAS_TEXTURES=0 -DHAS_COAT_NORMALS=1"}) {}

    std::vector<LobeResult> eval(const std::vector<Material>& materials, const std::vector<LobeQuery>& queries) {
        const std::vector<float> out = run("evaluate", materials, queries, 4);
        std::vector<LobeResult> results(queries.size());
        const std::size_t n = padded(queries.size());
        for (std::size_t i = 0; i < results.size(); ++i) {
            results[i] = {{out[i], out[n + i], out[2 * n + i]}, out[3 * n + i]};
        }
        return results;
    }

    std::vector<LobeSample> sample(const std::vector<Material>& materials, const std::vector<LobeQuery>& queries) {
        const std::vector<float> out = run("sample", materials, queries, 9);
        std::vector<LobeSample> results(queries.size());
        const std::size_t n = padded(queries.size());
        for (std::size_t i = 0; i < results.size(); ++i) {
            const auto channel = [&](std::size_t c) { return out[c * n + i]; };
            results[i] = {{channel(0), channel(1), channel(2)},
                          {{channel(3), channel(4), channel(5)}, channel(6)},
                          channel(7),
                          channel(8)};
        }
        return results;
    }

private:
    static constexpr std::size_t few = 256;
    static std::size_t padded(std::size_t n) { return (n + 15) / 16 * 16; }

    // Arrays of n floats one after the other: wi, then wo or random numbers.
    std::vector<float> run(const char* kernel, const std::vector<Material>& materials,
                           const std::vector<LobeQuery>& queries, std::size_t outputs) {
        const std::size_t n = padded(queries.size());
        if (!values_are_judged() && n > few) { // large buffers are what costs most under a checking tool
            run(kernel, materials, {queries.begin(), queries.begin() + few}, outputs);
            return std::vector<float>(outputs * n);
        }
        std::vector<std::uint32_t> index(n, 0);
        std::vector<float> in(6 * n, 0.5F);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            index[i] = queries[i].material;
            for (int c = 0; c < 3; ++c) {
                in[static_cast<std::size_t>(c) * n + i] = queries[i].wi[c];
                in[static_cast<std::size_t>(c + 3) * n + i] = queries[i].wo_or_u[c];
            }
        }
        std::vector<float> out(outputs * n);
        const auto count = static_cast<std::uint32_t>(n);
        const std::vector<float>& input = in;
        const std::vector<std::uint32_t>& indices = index;
        const std::vector<Material> records = with_extensions(materials);
        probe_.run(kernel, n / static_cast<std::size_t>(lanes_), count, records, indices, input, out);
        return out;
    }

    static std::string source(const LobeName& lobe) {
        std::string text = R"(
            #define LOBE(name, NAME, class) LOBE_##NAME,
            enum {
            #include "bsdf/lobes.def"
            };
            #undef LOBE
            #include "bsdf/@.h"
            #define INPUT(index, i) {as_UInt(load((global const float *)(index) + (i))), ZERO, ZERO, materials, 0, 0, \
                                      {{ONE, ZERO, ZERO}, {ZERO, ONE, ZERO}, {ZERO, ZERO, ONE}}}
            #define LOAD3(p, first, i) vec3(load((p) + (first) * n + (i)), load((p) + ((first) + 1) * n + (i)), \
                                            load((p) + ((first) + 2) * n + (i)))
            INLINE void store3(global float *p, uint n, size_t i, Vec3 v) {
                store(p + i, v.x);
                store(p + n + i, v.y);
                store(p + 2 * n + i, v.z);
            }
        )";
        text += lobe.delta ? R"(
            kernel void sample(uint n, global const struct Material *materials, global const uint *index,
                               global const float *x, global float *out) {
                size_t i = get_global_id(0) * LANES;
                MaterialInput in = INPUT(index, i);
                Vec3 wi = LOAD3(x, 0, i);
                DeltaSample s = @_sample(@_load(in), wi, load(x + 3 * n + i));
                store3(out, n, i, s.wo);
                store3(out + 3 * n, n, i, s.weight);
                store(out + 6 * n + i, ZERO);
                store(out + 7 * n + i, s.eta);
                store(out + 8 * n + i, @_weight(@_load(in), wi));
            })"
                           : R"(
            kernel void evaluate(uint n, global const struct Material *materials, global const uint *index,
                                 global const float *x, global float *out) {
                size_t i = get_global_id(0) * LANES;
                MaterialInput in = INPUT(index, i);
                LobeValue value = @_eval(@_load(in), LOAD3(x, 0, i), LOAD3(x, 3, i));
                store3(out, n, i, value.f_cos);
                store(out + 3 * n + i, value.pdf);
            }
            kernel void sample(uint n, global const struct Material *materials, global const uint *index,
                               global const float *x, global float *out) {
                size_t i = get_global_id(0) * LANES;
                MaterialInput in = INPUT(index, i);
                Vec3 wi = LOAD3(x, 0, i);
                Vec3 wo = @_sample(@_load(in), wi, load(x + 3 * n + i), load(x + 4 * n + i), load(x + 5 * n + i));
                LobeValue value = @_eval(@_load(in), wi, wo);
                store3(out, n, i, wo);
                store3(out + 3 * n, n, i, value.f_cos);
                store(out + 6 * n + i, value.pdf);
                store(out + 7 * n + i, ONE);
                store(out + 8 * n + i, @_weight(@_load(in), wi));
            })";
        for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at)) {
            text.replace(at, 1, lobe.name);
        }
        return text;
    }

    int lanes_;
    Probe probe_;
};

}  // namespace wavelobe::test
