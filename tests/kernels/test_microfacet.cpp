// Microfacet distributions: normalization, masking, and sampling of visible normals.
#include "support/lobe_test.h"
#include "support/statistics.h"

namespace wavelobe::test {
namespace {

struct Surface {
    const char* name;
    float alpha_u, alpha_v;
    Uint32 flags;
};

const std::vector<Surface> surfaces{
    {"ggx", 0.3F, 0.3F, 0},
    {"ggx stretched", 0.1F, 0.6F, 0},
    {"ggx roughest", 1.0F, 1.0F, 0},
    {"beckmann", 0.3F, 0.3F, MATERIAL_BECKMANN},
    {"beckmann stretched", 0.6F, 0.1F, MATERIAL_BECKMANN},
    {"beckmann roughest", 1.0F, 1.0F, MATERIAL_BECKMANN},
};

// Twelve numbers an item in, six out, as arrays one after the other. Surfaces change from lane to lane.
class MicrofacetProbe {
public:
    struct Item {
        Surface surface;
        glm::vec3 wi{0.0F, 0.0F, 1.0F};
        glm::vec3 wo{0.0F, 0.0F, 1.0F};
        glm::vec3 m{0.0F, 0.0F, 1.0F};
    };
    struct Result {
        double density, visible, both;
        glm::dvec3 normal;  // sampled from wi with wo.x, wo.y as random numbers
    };

    std::vector<Result> run(const std::vector<Item>& items) {
        const std::size_t n = (items.size() + 15) / 16 * 16;
        std::vector<float> in(12 * n, 0.5F);
        for (std::size_t i = 0; i < items.size(); ++i) {
            const Item& t = items[i];
            const float values[12] = {t.surface.alpha_u, t.surface.alpha_v, t.surface.flags ? 1.0F : 0.0F,
                                      t.wi.x, t.wi.y, t.wi.z, t.wo.x, t.wo.y, t.wo.z, t.m.x, t.m.y, t.m.z};
            for (std::size_t c = 0; c < 12; ++c) in[c * n + i] = values[c];
        }
        std::vector<float> out(6 * n);
        const auto count = static_cast<std::uint32_t>(n);
        const std::vector<float>& input = in;
        probe_.run("run", n / 16, input, out, count);
        std::vector<Result> results(items.size());
        for (std::size_t i = 0; i < results.size(); ++i) {
            const auto channel = [&](std::size_t c) { return static_cast<double>(out[c * n + i]); };
            results[i] = {channel(0), channel(1), channel(2), {channel(3), channel(4), channel(5)}};
        }
        return results;
    }

private:
    Probe probe_{R"(
        #define HAS_TEXTURES 0
        #include "bsdf/microfacet.h"
        #define LOAD(channel) load(in + (channel) * n + i)
        #define LOAD3(first) vec3(LOAD(first), LOAD((first) + 1), LOAD((first) + 2))
        kernel void run(global const float *in, global float *out, uint n) {
            size_t i = get_global_id(0) * LANES;
            Microfacets d = {LOAD(0), LOAD(1), LOAD(2) != 0.0f};
            Vec3 wi = LOAD3(3), wo = LOAD3(6), m = LOAD3(9);
            Masking g = microfacet_masking(d, wi, wo);
            Vec3 normal = sample_visible_normal(d, wi, wo.x, wo.y);
            store(out + i, microfacet_density(d, m));
            store(out + n + i, g.visible);
            store(out + 2 * n + i, g.both);
            store(out + 3 * n + i, normal.x);
            store(out + 4 * n + i, normal.y);
            store(out + 5 * n + i, normal.z);
        })"};
};

Material material_of(const Surface& s) { return rough(white_material(), s.alpha_u, s.alpha_v, s.flags); }

// The normals' projected areas onto the surface add up to one, and those visible from wi to cos wi.
TEST(Microfacet, NormalsAddUpToTheSurface) {
    MicrofacetProbe probe;
    for (const Surface& s : surfaces) {
        for (double z : {1.0, 0.6, 0.1, 1e-3}) {
            const glm::dvec3 wi = glm::vec3(direction_at_height(z, 0.9));
            const std::vector<double> integrals = integrate_cells(
                SphereGrid::whole(32),
                [&](const std::vector<glm::dvec3>& directions) {
                    std::vector<MicrofacetProbe::Item> items;
                    for (const glm::dvec3& m : directions) items.push_back({s, wi, {0, 0, 1}, m});
                    const std::vector<MicrofacetProbe::Result> results = probe.run(items);
                    std::vector<double> values;
                    for (std::size_t i = 0; i < results.size(); ++i) {
                        const bool up = directions[i].z > 0.0;
                        const double density = up ? results[i].density : 0.0;
                        values.push_back(density * directions[i].z);
                        values.push_back(results[i].visible * density * std::max(glm::dot(wi, directions[i]), 0.0));
                    }
                    return values;
                },
                2, 1e-8);
            double projected = 0.0;
            double visible = 0.0;
            for (std::size_t i = 0; i < integrals.size(); i += 2) {
                projected += integrals[i];
                visible += integrals[i + 1];
            }
            EXPECT_NEAR(projected, 1.0, 2e-5) << s.name;
            EXPECT_NEAR(visible, 1.0, 2e-5) << s.name << " " << z;
        }
    }
}

TEST(Microfacet, MaskingMatchesDoublePrecision) {
    MicrofacetProbe probe;
    Random random(1);
    std::vector<MicrofacetProbe::Item> items;
    for (int i = 0; i < 50000; ++i) {
        const Surface s{"", random.log_between(1e-4F, 1.0F), random.log_between(1e-4F, 1.0F),
                        i % 2 ? MATERIAL_BECKMANN : 0U};
        const auto height = [&] { return i % 4 < 2 ? random.uniform() : random.log_between(1e-8F, 1.0F); };
        items.push_back({s, direction_at_height(height(), 6.0 * random.uniform()),
                         direction_at_height(height(), 6.0 * random.uniform()), {0, 0, 1}});
    }
    const std::vector<MicrofacetProbe::Result> results = probe.run(items);
    for (std::size_t i = 0; i < items.size(); ++i) {
        const Material m = material_of(items[i].surface);
        const glm::dvec3 wi = items[i].wi;
        const glm::dvec3 wo = items[i].wo;
        const double visible = reference_masking(m, wi, true) / wi.z;
        const double both = reference_masking(m, wi, false) * reference_masking(m, wo, false) / wi.z;
        ASSERT_NEAR(results[i].visible, visible, 32 * 0x1p-24 * visible);
        // The fit of Walter et al. jumps by 0.0013 where it ends.
        const auto at_end = [&](const glm::dvec3& v) {
            const double a = v.z / std::hypot(m.alpha_u.value * v.x, m.alpha_v.value * v.y);
            return std::abs(a - 1.6) < 1e-6;
        };
        if (items[i].surface.flags && (at_end(wi) || at_end(wo))) continue;
        ASSERT_NEAR(results[i].both, both, 32 * 0x1p-24 * both);
    }
}

// Nothing is hidden from straight above.
TEST(Microfacet, NoMaskingAlongTheNormal) {
    MicrofacetProbe probe;
    for (const Surface& s : surfaces) {
        const MicrofacetProbe::Result r = probe.run({{s}})[0];
        EXPECT_EQ(r.visible, 1.0) << s.name;
        EXPECT_EQ(r.both, 1.0) << s.name;
    }
}

TEST(Microfacet, SampledNormalsAreVisibleAndFollowTheirDensity) {
    MicrofacetProbe probe;
    Random random(2);
    const std::vector<double> heights{1.0, 0.6, 0.1, 1e-3, 1e-6};
    const double threshold = sidak_threshold(1e-3, surfaces.size() * heights.size());
    constexpr std::size_t sample_count = 200000;
    for (const Surface& s : surfaces) {
        const Material material = material_of(s);
        for (double z : heights) {
            const glm::vec3 wi = direction_at_height(z, 0.9);
            std::vector<MicrofacetProbe::Item> items(sample_count);
            for (MicrofacetProbe::Item& item : items) item = {s, wi, random.uniform3(), {0, 0, 1}};
            const SphereGrid grid = SphereGrid::whole(32);
            std::vector<double> counts(grid.size(), 0.0);
            for (const MicrofacetProbe::Result& r : probe.run(items)) {
                ASSERT_NEAR(glm::length(r.normal), 1.0, 4 * 0x1p-24) << s.name;
                ASSERT_GE(r.normal.z, 0.0) << s.name;
                ASSERT_GE(glm::dot(glm::dvec3(wi), r.normal), -2 * 0x1p-24) << s.name;
                counts[grid.index_of(r.normal)] += 1.0;
            }
            std::vector<double> expected = integrate_cells(
                grid,
                [&](const std::vector<glm::dvec3>& directions) {
                    std::vector<double> values;
                    for (const glm::dvec3& m : directions) {
                        const double cosine = std::max(glm::dot(glm::dvec3(wi), m), 0.0);
                        values.push_back(reference_density(material, m) * cosine *
                                         reference_masking(material, wi, true) / static_cast<double>(wi.z));
                    }
                    return values;
                },
                1, 1e-8);
            for (double& e : expected) e *= sample_count;
            const ChiSquareResult chi = chi_square_test(counts, expected);
            EXPECT_GT(chi.p_value, threshold) << s.name << ", height " << z << ": chi-square " << chi.statistic << " of "
                                              << chi.degrees_of_freedom;
        }
    }
}

// The slope towards the viewer is the inverse of its distribution function at the first random number.
TEST(Microfacet, BeckmannInversionReachesRoundingError) {
    MicrofacetProbe probe;
    Random random(3);
    const Surface s{"", 1.0F, 1.0F, MATERIAL_BECKMANN};
    std::vector<MicrofacetProbe::Item> items;
    for (int i = 0; i < 200000; ++i) {
        const float height = i % 3 == 0 ? random.uniform() : i % 3 == 1 ? random.log_between(1e-7F, 1.0F)
                                                                        : std::sqrt(1.0F - random.log_between(1e-6F, 1.0F));
        const float u = i % 5 == 0 ? random.log_between(1e-7F, 1.0F) : i % 5 == 1 ? 1.0F - random.log_between(1e-7F, 1.0F)
                                                                                  : random.uniform();
        items.push_back({s, direction_at_height(height, 0.0), {u, 0.5F, 0.0F}, {0, 0, 1}});
    }
    const std::vector<MicrofacetProbe::Result> results = probe.run(items);
    double worst = 0.0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const double c = items[i].wi.z;
        const double sine = items[i].wi.x;
        const auto area = [&](double x) { return c * (1.0 + std::erf(x)) + sine / std::sqrt(pi) * std::exp(-x * x); };
        const double largest = sine > 0.0 ? c / sine : 1e9;
        const double slope = std::min(-results[i].normal.x / results[i].normal.z, largest);
        worst = std::max(worst, std::abs(area(slope) / area(largest) - static_cast<double>(items[i].wo.x)));
    }
    EXPECT_LT(worst, 8 * 0x1p-24);
}

}  // namespace
}  // namespace wavelobe::test
