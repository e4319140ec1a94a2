// The idioms of core/lanes.h against what they promise, at every width, with and without the portable twins.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <numeric>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "support/probe.h"

namespace wavelobe::test {
namespace {

struct Setting {
    unsigned lanes;
    bool portable;
};

void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.lanes << (setting.portable ? " portable" : ""); }

class Lanes : public testing::TestWithParam<Setting> {
protected:
    unsigned lanes() const { return GetParam().lanes; }
    std::uint32_t all() const { return (std::uint32_t{1} << lanes()) - 1; }
    Probe probe(const std::string& body) const {
        return Probe("#include \"core/lanes.h\"\n" + body,
                     {.lanes = static_cast<int>(lanes()), .defines = GetParam().portable ? "-DWAVELOBE_PORTABLE=1" : ""});
    }
    // Every mask there is.
    std::vector<std::uint32_t> masks() const {
        std::vector<std::uint32_t> list(all() + std::size_t{1});
        std::iota(list.begin(), list.end(), 0u);
        return list;
    }
};

TEST_P(Lanes, BitsOfAMaskAndBack) {
    Probe p = probe(R"(
        kernel void run(global const uint *bits, global uint *from_idiom, global uint *from_compare, global uint *any) {
            size_t i = get_global_id(0);
            Int mask = mask_of_bits(bits[i]);
            from_idiom[i] = lane_bits(mask);
            // A mask as a comparison makes it: lane k holds bit k of the bits.
            Float lane = convert_Float(as_Int(((UInt)bits[i] >> LANE_INDEX) & (UInt)1u));
            from_compare[i] = lane_bits(lane > 0.5f);
            any[i] = any_lane(lane > 0.5f) ? 1u : 0u;
        })");
    const auto bits = masks();
    std::vector<std::uint32_t> from_idiom(bits.size()), from_compare(bits.size()), any(bits.size());
    p.run("run", bits.size(), bits, from_idiom, from_compare, any);
    EXPECT_EQ(from_idiom, bits);
    EXPECT_EQ(from_compare, bits);
    for (std::size_t i = 0; i < bits.size(); ++i) ASSERT_EQ(any[i], bits[i] != 0 ? 1u : 0u);
}

TEST_P(Lanes, RowsAreTheWordsFromEachLanesPlaceOn) {
    Probe p = probe(R"(
        #include "core/rows.h"
        kernel void run(global const float *words, global const uint *places, global float *out) {
            Rows rows;
            gather_rows(words, as_UInt(load((global const float *)places)), &rows);
            for (uint k = 0; k < ROW_WORDS; k++) store(out + k * LANES, rows.word[k]);
        })");
    std::vector<float> words(1000);
    std::iota(words.begin(), words.end(), 0.0F);
    std::vector<std::uint32_t> places(lanes());
    for (std::uint32_t i = 0; i < lanes(); ++i) places[i] = i * 577 % 984;
    std::vector<float> out(std::size_t{16} * lanes());
    p.run("run", 1, words, places, out);
    for (std::uint32_t k = 0; k < 16; ++k) {
        for (std::uint32_t i = 0; i < lanes(); ++i) EXPECT_EQ(out[k * lanes() + i], words[places[i] + k]) << "word " << k << " of lane " << i;
    }
}

TEST_P(Lanes, MasksCombine) {
    Probe p = probe(R"(
        kernel void run(global const uint *a, global const uint *b, global uint *out) {
            size_t i = get_global_id(0);
            Int x = mask_of_bits(a[i]), y = mask_of_bits(b[i]);
            out[4 * i] = lane_bits(x & y);
            out[4 * i + 1] = lane_bits(x | y);
            out[4 * i + 2] = lane_bits(!x);
            out[4 * i + 3] = lane_bits(SELECT(x, ONE, ZERO) == ONE) | (lane_bits(TRUE_MASK) << 16);
        })");
    const auto a = masks();
    std::vector<std::uint32_t> b(a.size()), out(4 * a.size());
    for (std::size_t i = 0; i < a.size(); ++i) b[i] = (a[i] * 2654435761u >> 7) & all();
    const auto& constant_b = b;
    p.run("run", a.size(), a, constant_b, out);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(out[4 * i], a[i] & b[i]);
        ASSERT_EQ(out[4 * i + 1], a[i] | b[i]);
        ASSERT_EQ(out[4 * i + 2], ~a[i] & all());
        ASSERT_EQ(out[4 * i + 3], a[i] | (all() << 16));
    }
}

TEST_P(Lanes, GatherTakesEachLanesElement) {
    Probe p = probe(R"(
        struct Record { float before; float value; uint key; };
        kernel void run(global const float *table, global const uint *indices, global float *out, global uint *out_bits,
                        global float *field, global uint *key) {
            size_t i = get_global_id(0) * LANES;
            UInt index = *(global const UIntUnaligned *)(indices + i);
            store(out + i, gather(table, index));
            *(global UIntUnaligned *)(out_bits + i) = gather_uint((global const uint *)table, index);
            UInt record = index / (UInt)3u;
            store(field + i, GATHER_FIELD(table, Record, record, value));
            *(global UIntUnaligned *)(key + i) = GATHER_UINT_FIELD(table, Record, record, key);
        })");
    std::mt19937 random(1);
    std::vector<float> table(3000);
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<float>(i) + 0.5F;
    std::vector<std::uint32_t> indices(1024);
    for (auto& index : indices) index = static_cast<std::uint32_t>(random() % 3000u);
    indices[0] = 0;
    indices[1] = 2999;
    for (std::size_t i = 100; i < 150; ++i) indices[i] = 7;
    const auto &t = table;
    const auto &x = indices;
    std::vector<float> out(x.size()), field(x.size());
    std::vector<std::uint32_t> out_bits(x.size()), key(x.size());
    p.run("run", x.size() / lanes(), t, x, out, out_bits, field, key);
    for (std::size_t i = 0; i < x.size(); ++i) {
        ASSERT_EQ(out[i], table[x[i]]);
        ASSERT_EQ(out_bits[i], std::bit_cast<std::uint32_t>(table[x[i]]));
        ASSERT_EQ(field[i], table[x[i] / 3 * 3 + 1]);
        ASSERT_EQ(key[i], std::bit_cast<std::uint32_t>(table[x[i] / 3 * 3 + 2]));
    }
}

TEST_P(Lanes, LoadsAndStoresAreUnaligned) {
    Probe p = probe(R"(
        kernel void run(global const float *in, global float *out, uint shift) {
            store(out + shift, load(in + shift));
        })");
    std::vector<float> in(40);
    std::iota(in.begin(), in.end(), 1.0F);
    const auto& constant_in = in;
    for (std::uint32_t shift = 0; shift < 16; ++shift) {
        std::vector<float> out(40, 0.0F);
        p.run("run", 1, constant_in, out, shift);
        for (std::size_t i = 0; i < out.size(); ++i) ASSERT_EQ(out[i], i >= shift && i < shift + lanes() ? in[i] : 0.0F);
    }
}

// Each work-item has its own stretch of LANES elements and writes them in reverse.
TEST_P(Lanes, ScatterWritesOnlyTheLanesOfTheMask) {
    Probe p = probe(R"(
        kernel void run(global const uint *bits, global float *out) {
            size_t i = get_global_id(0);
            UInt index = (UInt)(uint)(i * LANES) + ((UInt)(LANES - 1u) - LANE_INDEX);
            scatter(out, index, convert_Float(as_Int((UInt)LANE_INDEX)) + 1.0f, bits[i]);
        })");
    const auto bits = masks();
    std::vector<float> out(bits.size() * lanes(), -7.0F);
    p.run("run", bits.size(), bits, out);
    for (std::size_t i = 0; i < bits.size(); ++i) {
        for (unsigned k = 0; k < lanes(); ++k) {
            const float written = out[i * lanes() + (lanes() - 1 - k)];
            ASSERT_EQ(written, (bits[i] >> k & 1) != 0 ? static_cast<float>(k + 1) : -7.0F) << bits[i] << " lane " << k;
        }
    }
}

TEST_P(Lanes, CompressStoreKeepsOrderAndStaysWithinItsLanes) {
    Probe p = probe(R"(
        kernel void run(global const uint *bits, global float *out, global uint *out_uint) {
            size_t i = get_global_id(0);
            compress_store(out + i * (LANES + 1), convert_Float(as_Int((UInt)LANE_INDEX)) + 1.0f, bits[i]);
            compress_store_uint(out_uint + i * (LANES + 1), (UInt)LANE_INDEX + (UInt)100u, bits[i]);
        })");
    const auto bits = masks();
    const std::size_t stride = lanes() + 1;
    std::vector<float> out(bits.size() * stride, -7.0F);
    std::vector<std::uint32_t> out_uint(bits.size() * stride, 5u);
    p.run("run", bits.size(), bits, out, out_uint);
    for (std::size_t i = 0; i < bits.size(); ++i) {
        std::size_t at = i * stride;
        for (unsigned k = 0; k < lanes(); ++k) {
            if ((bits[i] >> k & 1) == 0) continue;
            ASSERT_EQ(out[at], static_cast<float>(k + 1)) << bits[i];
            ASSERT_EQ(out_uint[at], k + 100) << bits[i];
            ++at;
        }
        ASSERT_EQ(out[i * stride + lanes()], -7.0F) << "beyond the lanes";
        ASSERT_EQ(out_uint[i * stride + lanes()], 5u) << "beyond the lanes";
    }
}

// The comparisons that LESSER and GREATER are: the second operand where either is NaN or both are equal.
TEST_P(Lanes, LesserAndGreater) {
    Probe p = probe(R"(
        kernel void run(global const float *a, global const float *b, global float *lesser, global float *greater) {
            size_t i = get_global_id(0) * LANES;
            store(lesser + i, LESSER(load(a + i), load(b + i)));
            store(greater + i, GREATER(load(a + i), load(b + i)));
        })");
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> values = {0.0F, -0.0F, 1.0F, -1.0F, inf, -inf, nan, 1e-40F};
    std::vector<float> a, b;
    for (float x : values) {
        for (float y : values) {
            a.push_back(x);
            b.push_back(y);
        }
    }
    const auto &ca = a, &cb = b;
    std::vector<float> lesser(a.size()), greater(a.size());
    p.run("run", a.size() / lanes(), ca, cb, lesser, greater);
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(bits(lesser[i]), bits(a[i] < b[i] ? a[i] : b[i])) << a[i] << " " << b[i];
        EXPECT_EQ(bits(greater[i]), bits(a[i] > b[i] ? a[i] : b[i])) << a[i] << " " << b[i];
    }
}

// a * b + c is never contracted unless asked for, and then by every machine that can: bits must not depend on the width.
TEST_P(Lanes, OnlyMaddContracts) {
    Probe p = probe(R"(
        kernel void run(global const float *x, global float *plain, global float *fused, global uint *must_fuse) {
            size_t i = get_global_id(0) * LANES;
            Float a = load(x + i);
            store(plain + i, a * a - (Float)1.0f);
            store(fused + i, madd(a, a, (Float)-1.0f));
        #if defined(__FMA__) || defined(FP_FAST_FMAF)
            *must_fuse = 1u;
        #endif
        })");
    std::vector<float> x(1024);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1.0F + static_cast<float>(i + 1) * 0x1p-23F;
    const auto& constant_x = x;
    std::vector<float> plain(x.size()), fused(x.size());
    std::vector<std::uint32_t> must_fuse(1);
    p.run("run", x.size() / lanes(), constant_x, plain, fused, must_fuse);
    std::size_t unlike = 0, are_fused = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double exact = static_cast<double>(x[i]) * x[i];
        const float separate = static_cast<float>(exact) - 1.0F, together = static_cast<float>(exact - 1.0);
        ASSERT_EQ(plain[i], separate);
        ASSERT_TRUE(fused[i] == together || fused[i] == separate);
        unlike += separate != together;
        are_fused += separate != together && fused[i] == together;
    }
    EXPECT_GT(unlike, 0U) << "these inputs tell the two apart";
    EXPECT_TRUE(are_fused == unlike || (are_fused == 0 && must_fuse[0] == 0)) << are_fused << " of " << unlike << " are fused";
}

INSTANTIATE_TEST_SUITE_P(All, Lanes,
                         testing::Values(Setting{1, false}, Setting{8, false}, Setting{16, false}, Setting{1, true}, Setting{8, true},
                                         Setting{16, true}),
                         [](const auto& tested) {
                             return std::to_string(tested.param.lanes) + (tested.param.portable ? "_portable" : "");
                         });

}  // namespace
}  // namespace wavelobe::test
