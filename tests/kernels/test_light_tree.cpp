// Walks down a light tree: the light and probability they give against double precision, counts against probabilities.
#include <gtest/gtest.h>

#include <cstring>
#include <tuple>

#include <fmt/format.h>

#include "support/light_tree_reference.h"
#include "support/probe.h"
#include "support/statistics.h"

namespace wavelobe::test {
namespace {

constexpr float below_one = 0x1.fffffep-1F;

struct Walk {
    Uint32 light;
    float probability;
    float by_place;     // of the same light
    // As the receiver's code has them:
    glm::vec3 normal, axis;
    float peak, diffuse;

    ReferenceReceiver receiver(const glm::vec3& position, bool any_side) const {
        ReferenceReceiver r{glm::dvec3(position), {}, glm::dvec3(axis), static_cast<double>(peak), static_cast<double>(diffuse)};
        if (!any_side) r.normal = glm::dvec3(normal);
        return r;
    }
};

struct WalkQuery {
    glm::vec3 position, normal;
    bool any_side;
    float u, deep;
    // Of a glossy receiver: the mirror direction, the density there, the share of diffuse lobes.
    glm::vec3 axis{0.0F, 0.0F, 1.0F};
    float density = 0.0F;
    float diffuse = 1.0F;
};

std::vector<Walk> walk(const LightTree& tree, const std::vector<WalkQuery>& queries, bool glossy = false, int lanes = 16) {
    Probe probe(R"(
#include "lights/light_tree.h"
#define IN(k) load(query + i + (k) * n)
kernel void run(global const struct LightNode *tree, global const uint *places, global const float *query, uint n,
                global float *out) {
    size_t i = get_global_id(0) * LANES;
    Vec3 normal = vec3(IN(3), IN(4), IN(5));
    ReceiverCode code;
    code.normal = SELECT(IN(6) > 0.0f, (UInt)RECEIVER_ANY, normal_code(normal));
#if HAS_GLOSSY_RECEIVERS
    code.lobe = SELECT(IN(12) > 0.0f, lobe_code(vec3(IN(9), IN(10), IN(11)), IN(12), IN(13)), (UInt)NO_LOBE);
#endif
    Receiver r = receiver_of(vec3(IN(0), IN(1), IN(2)), code);
    UInt light;
    Float p = walk_light_tree(tree, r, IN(7), IN(8), TRUE_MASK, &light);
    UInt place = gather_uint(places, light);
    store(out + i, as_Float(light));
    store(out + i + n, p);
    store(out + i + 2 * n, light_tree_probability(tree, r, place, TRUE_MASK));
    store(out + i + 3 * n, r.normal.x);
    store(out + i + 4 * n, r.normal.y);
    store(out + i + 5 * n, r.normal.z);
#if HAS_GLOSSY_RECEIVERS
    store(out + i + 6 * n, r.axis.x);
    store(out + i + 7 * n, r.axis.y);
    store(out + i + 8 * n, r.axis.z);
    store(out + i + 9 * n, r.peak);
    store(out + i + 10 * n, r.diffuse);
#endif
})",
                {.lanes = lanes,
                 .defines = fmt::format("-DHAS_GLOSSY_RECEIVERS={} -DPLACED_LIGHTS={}", glossy ? 1 : 0,
                                        tree.places.size() <= LIGHT_CHILDREN ? tree.places.size() : 0)});
    constexpr std::size_t inputs = 14;
    const std::size_t n = (queries.size() + 15) / 16 * 16;
    std::vector<float> data(inputs * n, 0.5F);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const WalkQuery& q = queries[i];
        const float values[] = {q.position.x, q.position.y, q.position.z, q.normal.x, q.normal.y,
                                q.normal.z,   q.any_side ? 1.0F : 0.0F,   q.u,        q.deep,     q.axis.x,
                                q.axis.y,     q.axis.z,     q.density,    q.diffuse};
        for (std::size_t k = 0; k < inputs; ++k) data[k * n + i] = values[k];
    }
    std::vector<float> out(11 * n);
    const auto count = static_cast<cl_uint>(n);
    const std::vector<LightNode> nodes = tree.nodes;
    const std::vector<Uint32> places = tree.places;
    const std::vector<float> query = data;
    probe.run("run", n / static_cast<std::size_t>(lanes), nodes, places, query, count, out);
    std::vector<Walk> walks(queries.size());
    for (std::size_t i = 0; i < walks.size(); ++i) {
        std::memcpy(&walks[i].light, &out[i], sizeof(float));
        walks[i].probability = out[n + i];
        walks[i].by_place = out[2 * n + i];
        walks[i].normal = {out[3 * n + i], out[4 * n + i], out[5 * n + i]};
        walks[i].axis = {out[6 * n + i], out[7 * n + i], out[8 * n + i]};
        walks[i].peak = glossy ? out[9 * n + i] : 0.0F;
        walks[i].diffuse = glossy ? out[10 * n + i] : 1.0F;
    }
    return walks;
}

std::vector<WalkQuery> random_queries(std::size_t count, unsigned seed, const WalkQuery* fixed = nullptr) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const auto number = [&] { return std::min(0.5F + 0.5F * unit(random), below_one); };
    std::vector<WalkQuery> queries(count);
    for (WalkQuery& q : queries) {
        q.position = 12.0F * glm::vec3(unit(random), unit(random), unit(random));
        q.normal = glm::normalize(glm::vec3(unit(random), unit(random), unit(random)) + glm::vec3(1e-3F));
        q.any_side = unit(random) > 0.6F;
        q.axis = glm::normalize(glm::vec3(unit(random), unit(random), unit(random)) + glm::vec3(1e-3F));
        q.density = unit(random) > 0.6F ? 0.0F : std::exp(9.0F * unit(random));  // to beyond the sharpest that is told apart
        q.diffuse = std::max(unit(random), 0.0F);
        if (fixed != nullptr) q = *fixed;
        q.u = number();
        q.deep = number();
    }
    return queries;
}

// With lobes and without, and how many lights.
class LightTreeWalks : public testing::TestWithParam<std::tuple<bool, std::size_t>> {
protected:
    static bool glossy() { return std::get<0>(GetParam()); }
    static std::size_t lights() { return std::get<1>(GetParam()); }
};

TEST_P(LightTreeWalks, ProbabilitiesAreThoseOfDoublePrecision) {
    const LightTree tree = build_light_tree(random_lights(lights(), 1));
    const std::vector<WalkQuery> queries = random_queries(1 << 14, 2);
    const std::vector<Walk> walks = walk(tree, queries, glossy());
    std::size_t dark = 0;
    std::size_t strays = 0;
    for (std::size_t i = 0; i < walks.size(); ++i) {
        const Walk& w = walks[i];
        ASSERT_TRUE(w.probability >= 0.0F && w.probability <= 1.0F) << w.probability;
        if (w.probability <= 0.0F) {
            ++dark;
            continue;
        }
        ASSERT_EQ(w.probability, w.by_place) << "a hit weighs the sample that would have made it by another number";
        const double expected =
            reference_probability(tree.nodes, tree.places[w.light], w.receiver(queries[i].position, queries[i].any_side));
        // At the horizon a float's cosine keeps few digits.
        strays += std::abs(static_cast<double>(w.probability) / expected - 1.0) < 1e-3 ? 0 : 1;
    }
    EXPECT_LE(strays, walks.size() / 500);
    EXPECT_LT(dark, walks.size() / 2);
}

TEST_P(LightTreeWalks, CountsFollowTheProbabilities) {
    const LightTree tree = build_light_tree(random_lights(lights(), 8));
    WalkQuery fixed{{1.0F, -2.0F, 3.0F}, glm::normalize(glm::vec3(0.2F, 1.0F, -0.4F)), false, 0.0F, 0.0F,
                    glm::normalize(glm::vec3(0.5F, 0.8F, 0.1F)), 4.0F, 0.3F};
    for (const bool any_side : {false, true}) {
        fixed.any_side = any_side;
        const std::vector<Walk> walks = walk(tree, random_queries(1 << 18, 9, &fixed), glossy());
        std::vector<double> expected;
        std::vector<double> counts(lights() + 1, 0.0);
        double sum = 0.0;
        for (const Uint32 place : tree.places) {
            expected.push_back(reference_probability(tree.nodes, place, walks[0].receiver(fixed.position, any_side)));
            sum += expected.back();
        }
        expected.push_back(std::max(1.0 - sum, 0.0));  // walks that end where no light shines
        for (double& e : expected) e *= static_cast<double>(walks.size());
        for (const Walk& w : walks) ++counts[w.probability > 0.0F ? w.light : lights()];
        const ChiSquareResult result = chi_square_test(counts, expected);
        EXPECT_GT(result.p_value, sidak_threshold(0.01, 16)) << result.statistic << " of " << result.degrees_of_freedom;
        EXPECT_GE(result.degrees_of_freedom, 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Receivers, LightTreeWalks, testing::Combine(testing::Bool(), testing::Values(5, 8, 9, 200)), [](const auto& p) {
    return fmt::format("{}_{}_lights", std::get<0>(p.param) ? "glossy" : "diffuse", std::get<1>(p.param));
});

// With a second number for the deep part, lights of a chance of 2^-25 still come up as often as they should.
TEST(LightTreeWalk, ReachesRareLights) {
    std::vector<LightBounds> lights(1 << 14);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        lights[i].lower = lights[i].upper = glm::dvec3(static_cast<double>(i % 128), static_cast<double>(i / 128), 0.0);
        lights[i].spread = std::numbers::pi;
        lights[i].emission = 0.5 * std::numbers::pi;
        lights[i].intensity = 1.0;
    }
    const LightTree tree = build_light_tree(lights);
    const WalkQuery fixed{{64.0F, 64.0F, 1e4F}, {0.0F, 0.0F, -1.0F}, true, 0.0F, 0.0F};
    const std::vector<Walk> walks = walk(tree, random_queries(1 << 18, 10, &fixed));
    std::vector<double> counts(lights.size(), 0.0);
    for (const Walk& w : walks) ++counts[w.light];
    const std::vector<double> expected(lights.size(), static_cast<double>(walks.size()) / static_cast<double>(lights.size()));
    const ChiSquareResult result = chi_square_test(counts, expected);
    EXPECT_GT(result.p_value, 1e-3) << result.statistic << " of " << result.degrees_of_freedom;
}

TEST(LightTreeWalk, ReceiversKeepTheirNormal) {
    const LightTree tree = build_light_tree(random_lights(2, 1));
    std::vector<WalkQuery> queries = random_queries(1 << 12, 11);
    const glm::vec3 corners[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (std::size_t i = 0; i < 6; ++i) queries[i].normal = corners[i];
    for (WalkQuery& q : queries) q.any_side = false;
    const std::vector<Walk> walks = walk(tree, queries);
    for (std::size_t i = 0; i < walks.size(); ++i) {
        ASSERT_LE(glm::length(walks[i].normal - queries[i].normal), 8e-5F) << i;
    }
}

TEST(LightTreeWalk, ReceiversKeepTheirLobe) {
    const LightTree tree = build_light_tree(random_lights(2, 1));
    std::vector<WalkQuery> queries = random_queries(1 << 12, 14);
    const std::vector<Walk> walks = walk(tree, queries, true);
    for (std::size_t i = 0; i < walks.size(); ++i) {
        const float peak = std::numbers::pi_v<float> * queries[i].density;
        if (peak < 1.25F) {
            ASSERT_EQ(walks[i].peak, 0.0F) << "as good as diffuse";
        } else {
            // Rounded down to a quarter of an octave, and to the sharpest there is.
            ASSERT_LE(walks[i].peak, peak * 1.0001F);
            ASSERT_GE(walks[i].peak, std::min(peak * 0.8F, 800.0F));
        }
        if (queries[i].density <= 0.0F) {
            ASSERT_EQ(walks[i].diffuse, 1.0F);
            continue;
        }
        ASSERT_LE(glm::length(walks[i].axis - queries[i].axis), 1.3e-3F) << i;
        ASSERT_NEAR(walks[i].diffuse, 0.125F + 0.875F * queries[i].diffuse, 0.15F);
    }
}

TEST(LightTreeWalk, SameBitsAtEveryWidth) {
    const LightTree tree = build_light_tree(random_lights(700, 12));
    const std::vector<WalkQuery> queries = random_queries(4096, 13);
    const std::vector<Walk> wide = walk(tree, queries, true);
    for (const int lanes : {1, 8}) {
        EXPECT_EQ(std::memcmp(walk(tree, queries, true, lanes).data(), wide.data(), wide.size() * sizeof(Walk)), 0) << lanes;
    }
}

}  // namespace
}  // namespace wavelobe::test
