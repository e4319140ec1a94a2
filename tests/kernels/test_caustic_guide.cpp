// Maps of the directions caustics arrive from: what is sampled has the density that is said, whatever the photons.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "shared/caustics.h"
#include "support/probe.h"
#include "support/verification.h"

namespace wavelobe::test {
namespace {

class CausticMaps : public testing::TestWithParam<int> {
protected:
    // Maps of these sums of flux, one a row of CAUSTIC_BINS.
    std::vector<float> build(const std::vector<std::uint64_t>& sums) {
        const std::size_t maps = sums.size() / CAUSTIC_BINS;
        std::vector<float> out(maps * CAUSTIC_MAP_FLOATS);
        build_.run("build_caustic_maps", maps, sums, out);
        return out;
    }

    struct Samples {
        std::vector<float> directions, pdf, mixed;  // the former three arrays one after the other
        std::vector<std::uint32_t> bin;
    };

    Samples sample(const std::vector<float>& maps, std::uint32_t map, std::size_t count) {
        Generator random(1);
        std::vector<float> u(2 * count);
        for (float& x : u) x = uniform(random, 0.0F, 1.0F);
        Samples s{std::vector<float>(3 * count), std::vector<float>(count), std::vector<float>(count), std::vector<std::uint32_t>(count)};
        auto n = static_cast<std::uint32_t>(count);
        sample_.run("sample", count / static_cast<std::size_t>(GetParam()), maps, u, s.directions, s.pdf, s.mixed, s.bin, n, map);
        return s;
    }

    using Generator = std::mt19937;
    static float uniform(Generator& random, float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }

    Probe build_{R"(
        #include "caustics/build_maps.h"
    )", {.lanes = GetParam(), .defines = ""}};
    Probe sample_{R"(
        #include "caustics/guide.h"
        kernel void sample(global const float *maps, global const float *u, global float *directions, global float *pdf, global float *mixed,
                           global uint *bin, uint n, uint map) {
            size_t i = get_global_id(0) * LANES;
            CausticView view = {0, 0, maps};
            CausticGuide guide = {(UInt)(map * CAUSTIC_MAP_FLOATS), ONE};
            Vec3 d = caustic_sample(view, guide, load(u + i), load(u + n + i));
            store(directions + i, d.x), store(directions + n + i, d.y), store(directions + 2u * n + i, d.z);
            store(pdf + i, guided_pdf(view, guide, (Float)7.0f, d));
            store((global float *)bin + i, as_Float(caustic_bin(d)));
            guide.share = (Float)0.25f;
            store(mixed + i, guided_pdf(view, guide, (Float)7.0f, d));
        })",
                  {.lanes = GetParam(), .defines = ""}};
};

std::vector<std::uint64_t> random_sums(unsigned seed, double share_of_empty) {
    std::mt19937_64 random(seed);
    std::vector<std::uint64_t> sums(CAUSTIC_BINS, 0);
    for (std::uint64_t& s : sums) {
        if (std::uniform_real_distribution<double>()(random) >= share_of_empty) s = random() >> (random() % 40 + 24);
    }
    return sums;
}

TEST_P(CausticMaps, SamplesHaveTheirDensity) {
    constexpr std::size_t count = 1 << 18;
    for (const double empty : {0.0, 0.5, 0.97}) {
        const std::vector<std::uint64_t> sums = random_sums(3, empty);
        const std::vector<float> maps = build(sums);
        const Samples s = sample(maps, 0, count);
        const double all = std::accumulate(sums.begin(), sums.end(), 0.0);
        std::vector<double> found(CAUSTIC_BINS, 0.0);
        for (std::size_t i = 0; i < count; ++i) {
            const double x = static_cast<double>(s.directions[i]), y = static_cast<double>(s.directions[count + i]), z = static_cast<double>(s.directions[2 * count + i]);
            ASSERT_NEAR(x * x + y * y + z * z, 1.0, 1e-6);
            const double share = static_cast<double>(sums[s.bin[i]]) / all;
            ASSERT_GT(share, 0.0) << "a direction that no photon came from";
            ASSERT_NEAR(static_cast<double>(s.pdf[i]), share * CAUSTIC_BINS / (4.0 * std::numbers::pi), 1e-6 * (7.0 + CAUSTIC_BINS));
            ASSERT_NEAR(s.mixed[i], 0.25F * s.pdf[i] + 0.75F * 7.0F, 1e-5F * s.mixed[i]);
            found[s.bin[i]] += 1.0;
        }
        for (std::size_t bin = 0; bin < CAUSTIC_BINS; ++bin) {
            const double expected = static_cast<double>(sums[bin]) / all * count;
            EXPECT_NEAR(found[bin], expected, 5.0 * std::sqrt(expected) + 1.0) << "bin " << bin;
        }
    }
}

// Samples of a bin fill it evenly.
TEST_P(CausticMaps, SamplesAreEvenWithinABin) {
    std::vector<std::uint64_t> sums(CAUSTIC_BINS, 0);
    sums[5 * CAUSTIC_COLUMNS + 3] = 17;
    constexpr std::size_t count = 1 << 16;
    const Samples s = sample(build(sums), 0, count);
    double z = 0.0, turns = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(s.bin[i], 5 * CAUSTIC_COLUMNS + 3);
        z += static_cast<double>(s.directions[2 * count + i]) / count;
        turns += std::atan2(static_cast<double>(s.directions[count + i]), static_cast<double>(s.directions[i])) / (2.0 * std::numbers::pi) / count;
    }
    EXPECT_NEAR(z, 5.5 / 8.0 - 1.0, 5.0 * 0.125 / std::sqrt(12.0 * count));
    EXPECT_NEAR(turns, 3.5 / 16.0 - 0.5, 5.0 * 0.0625 / std::sqrt(12.0 * count));
}

TEST_P(CausticMaps, AreEachCellsOwn) {
    std::vector<std::uint64_t> sums(3 * CAUSTIC_BINS, 0);
    sums[CAUSTIC_BINS + 200] = 1;
    sums[2 * CAUSTIC_BINS + 7] = 1U << 30;
    const std::vector<float> maps = build(sums);
    for (const float x : maps) ASSERT_TRUE(std::isfinite(x));
    for (const std::uint32_t bin : sample(maps, 1, 256).bin) EXPECT_EQ(bin, 200U);
    for (const std::uint32_t bin : sample(maps, 2, 256).bin) EXPECT_EQ(bin, 7U);
}

INSTANTIATE_TEST_SUITE_P(Widths, CausticMaps, testing::Values(1, 8, 16));

}  // namespace
}  // namespace wavelobe::test
