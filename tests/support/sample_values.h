// Values of the sampler, made by its kernel code.
#pragma once

#include <cstddef>
#include <vector>

#include "support/probe.h"
#include "support/sobol_reference.h"

namespace wavelobe::test {

// Values as multiples of 2^-24, by sample.
struct Samples {
    std::vector<float> u1, u2;
    Word a(std::size_t i) const { return static_cast<Word>(u1[i] * 0x1p24F); }
    Word b(std::size_t i) const { return static_cast<Word>(u2[i] * 0x1p24F); }
};

struct Where {
    std::vector<Word> x, y, index, pair;
    void add(Word x_, Word y_, Word index_, Word pair_) {
        x.push_back(x_);
        y.push_back(y_);
        index.push_back(index_);
        pair.push_back(pair_);
    }
};

// `digits`: of the samples of a pixel; 31 where no two pixels share a sequence.
inline Samples sample(const Where& where, Word seed, Word digits = 31, int lanes = 16) {
    Probe probe(R"(
        #include "sampling/sampler.h"
        INLINE UInt load_words(global const uint *p) { return *(global const UIntUnaligned *)p; }
        kernel void run(global const uint *x, global const uint *y, global const uint *index, global const uint *pair,
                        global float *out1, global float *out2, uint seed, uint digits) {
            size_t i = get_global_id(0) * LANES;
            struct SampleSequence sequence = {seed, digits};
            SampleId id = sample_id(load_words(x + i), load_words(y + i), load_words(index + i), sequence);
            Float u1, u2;
            sample_2d(id, load_words(pair + i), &u1, &u2);
            store(out1 + i, u1);
            store(out2 + i, u2);
        })",
                {.lanes = lanes, .defines = ""});
    Where w = where;
    const std::size_t count = w.x.size();
    for (auto* list : {&w.x, &w.y, &w.index, &w.pair}) list->resize((count + 15) / 16 * 16);
    const Where& padded = w;
    Samples s{std::vector<float>(w.x.size()), std::vector<float>(w.x.size())};
    probe.run("run", w.x.size() / static_cast<unsigned>(lanes), padded.x, padded.y, padded.index, padded.pair, s.u1, s.u2, seed, digits);
    s.u1.resize(count);
    s.u2.resize(count);
    return s;
}

}  // namespace wavelobe::test
