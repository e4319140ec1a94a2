// Lane types: the one source of every vectorised stage body.
//
// Bodies are written once on Float, Int and UInt, which hold LANES paths (16, 8 or 1), with selects in
// place of branches.  The same body gives the same bits at every width: contraction of a*b+c is off
// everywhere and `madd` asks for it where it is wanted.
//
// Masks are Int.  A comparison of vectors gives -1 where true, of scalars 1: so combine masks with
// & and |, negate with !, test with any_lane() and lane_bits(), and never do arithmetic on them.
//
// Beside each instruction-set idiom stands its portable twin; WAVELOBE_PORTABLE forces the twins.
#ifndef WAVELOBE_CORE_LANES_H
#define WAVELOBE_CORE_LANES_H

#pragma OPENCL FP_CONTRACT OFF

// Wide vectors never cross a call on machines that lack the registers: everything is inlined.
#pragma clang diagnostic ignored "-Wpsabi"

#ifndef LANES
#define LANES 16
#endif

// A program takes from a header what it needs.
#define INLINE static inline __attribute__((always_inline, unused))
#define LIKELY(x) __builtin_expect(!!(x), 1)
#define UNLIKELY(x) __builtin_expect(!!(x), 0)

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && !defined(WAVELOBE_PORTABLE)
#define WAVELOBE_AVX512 1
#else
#define WAVELOBE_AVX512 0
#endif
#if defined(__AVX2__) && !defined(WAVELOBE_PORTABLE)
#define WAVELOBE_AVX2 1
#else
#define WAVELOBE_AVX2 0
#endif

#if LANES == 16
typedef float16 Float;
typedef int16 Int;
typedef uint16 UInt;
#define as_Float as_float16
#define as_Int as_int16
#define as_UInt as_uint16
#define convert_Int convert_int16
#define convert_Float convert_float16
#define LANE_INDEX ((uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#elif LANES == 8
typedef float8 Float;
typedef int8 Int;
typedef uint8 UInt;
#define as_Float as_float8
#define as_Int as_int8
#define as_UInt as_uint8
#define convert_Int convert_int8
#define convert_Float convert_float8
#define LANE_INDEX ((uint8)(0, 1, 2, 3, 4, 5, 6, 7))
#elif LANES == 1
typedef float Float;
typedef int Int;
typedef uint UInt;
#define as_Float as_float
#define as_Int as_int
#define as_UInt as_uint
#define convert_Int convert_int
#define convert_Float convert_float
#define LANE_INDEX 0u
#else
#error "LANES is 1, 8 or 16"
#endif

// One instruction on x86; fmin and fmax cost more because of what they promise about NaN.
#define SELECT(mask, a, b) ((mask) ? (a) : (b))
#define LESSER(a, b) ((a) < (b) ? (a) : (b))
#define GREATER(a, b) ((a) > (b) ? (a) : (b))

#if LANES == 1
#define FIRST_LANE(v) (v)
#else
#define FIRST_LANE(v) (v).s0
#endif

#define TRUE_MASK ((Int)(LANE_INDEX >= 0u))
#define ZERO ((Float)0.0f)
#define ONE ((Float)1.0f)

// a * b + c with one rounding on machines that can (the only contraction there is).
INLINE Float madd(Float a, Float b, Float c) {
#pragma OPENCL FP_CONTRACT ON
    return a * b + c;
}

// The same for eight values of one ray or path, whatever LANES is.
INLINE float8 madd8(float8 a, float8 b, float8 c) {
#pragma OPENCL FP_CONTRACT ON
    return a * b + c;
}

// Bit i is set where lane i of the mask is true.
INLINE uint lane_bits8(int8 m) {
#if WAVELOBE_AVX512
    return (uchar)__builtin_ia32_cvtd2mask256(m);
#elif WAVELOBE_AVX2
    return (uint)__builtin_ia32_movmskps256(as_float8(m));
#else
    // Gathers the sign bytes by a multiplication; 5 to 16 % slower in traversal.
    return (uint)(((as_ulong(convert_char8(m)) & 0x8040201008040201ul) * 0x0101010101010101ul) >> 56);
#endif
}

INLINE uint lane_bits(Int m) {
#if LANES == 16 && WAVELOBE_AVX512
    return (ushort)__builtin_ia32_cvtd2mask512(m);
#elif LANES == 16
    return lane_bits8(m.lo) | (lane_bits8(m.hi) << 8);
#elif LANES == 8
    return lane_bits8(m);
#else
    return m ? 1u : 0u;
#endif
}

INLINE Int mask_of_bits(uint bits) {
#if LANES == 16 && WAVELOBE_AVX512
    return __builtin_ia32_cvtmask2d512((ushort)bits);
#else
    return ((UInt)bits & ((UInt)1u << LANE_INDEX)) != (UInt)0u;
#endif
}

INLINE int any_lane(Int m) {
#if LANES == 16 && !WAVELOBE_AVX512
    int8 half8 = m.lo | m.hi;
    ulong2 words = as_ulong2(half8.lo | half8.hi);
    return (words.x | words.y) != 0ul;
#elif LANES == 8 && !WAVELOBE_AVX2
    ulong2 words = as_ulong2(m.lo | m.hi);
    return (words.x | words.y) != 0ul;
#else
    return lane_bits(m) != 0u;
#endif
}

// Lanes of the group that starts at item i which hold one of n items.
INLINE Int lanes_below(uint i, uint n) { return (LANE_INDEX + (UInt)i) < (UInt)n; }

// The least value of all lanes.
INLINE float least_lane(Float v) {
#if LANES == 1
    return v;
#else
#if LANES == 16
    float8 a = LESSER(v.lo, v.hi);
#else
    float8 a = v;
#endif
    float4 b = LESSER(a.lo, a.hi);
    float2 c = LESSER(b.lo, b.hi);
    return LESSER(c.x, c.y);
#endif
}

// A mask that outlives a branch. Where there are mask registers it is carried in one, by way of its bits: as lanes the compiler
// would carry a whole vector and turn it to and fro.
#if LANES == 16 && WAVELOBE_AVX512
typedef ushort KeptMask;
INLINE KeptMask keep_mask(Int m) { return (ushort)lane_bits(m); }
INLINE Int kept_mask(KeptMask m) { return mask_of_bits(m); }
#else
typedef Int KeptMask;
INLINE KeptMask keep_mask(Int m) { return m; }
INLINE Int kept_mask(KeptMask m) { return m; }
#endif

// Index of the lowest set bit; `bits` is not zero. (Checking tools interpret code for SPIR, and know no such instruction.)
INLINE uint lowest_bit(uint bits) {
#ifdef __SPIR__
    return popcount((bits & (0u - bits)) - 1u);
#else
    return (uint)__builtin_ctz(bits);
#endif
}

#define POP_LOWEST_BIT(mask, index) uint index = lowest_bit(mask); mask &= mask - 1u

// Asks for a line of memory that will be read soon; where there is no such instruction, waiting for it is the way.
INLINE void fetch_line(ulong address) {
#if !defined(__SPIR__) && __has_builtin(__builtin_prefetch)
    __builtin_prefetch((const void *)address);
#endif
}

// ---- lanes as arrays, for what goes lane by lane -------------------------------------------------------------

typedef struct {
    float value[LANES] __attribute__((aligned(64)));
} LaneFloats;

typedef struct {
    uint value[LANES] __attribute__((aligned(64)));
} LaneUints;

#define LANES_OF(floats) (*(const Float *)(floats).value)
#define UINTS_OF(uints) (*(const UInt *)(uints).value)

INLINE LaneFloats lane_floats(Float v) {
    LaneFloats a;
    *(Float *)a.value = v;
    return a;
}

INLINE LaneUints lane_uints(UInt v) {
    LaneUints a;
    *(UInt *)a.value = v;
    return a;
}

// ---- unaligned access to LANES consecutive values ------------------------------------------------

typedef Float __attribute__((aligned(4))) FloatUnaligned;
typedef UInt __attribute__((aligned(4))) UIntUnaligned;
typedef float8 __attribute__((aligned(4))) Float8Unaligned;

INLINE Float load(global const float *p) { return *(global const FloatUnaligned *)p; }
INLINE void store(global float *p, Float v) { *(global FloatUnaligned *)p = v; }

// ---- gather: p[i] for each lane ------------------------------------------------------------------------

#if LANES == 16
#define FOR_LANES(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(a) X(b) X(c) X(d) X(e) X(f)
#elif LANES == 8
#define FOR_LANES(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)
#endif

INLINE Float gather(global const float *p, UInt i) {
#if LANES == 1
    return p[i];
#elif LANES == 16 && WAVELOBE_AVX512
    return __builtin_ia32_gathersiv16sf((float16)0.0f, (const void *)(ulong)p, as_int16(i), (ushort)0xffff, 4);
#elif LANES == 16 && WAVELOBE_AVX2
    Float v;
    v.lo = __builtin_ia32_gatherd_ps256((float8)0.0f, (const void *)(ulong)p, as_int8(i.lo), as_float8((int8)-1), 4);
    v.hi = __builtin_ia32_gatherd_ps256((float8)0.0f, (const void *)(ulong)p, as_int8(i.hi), as_float8((int8)-1), 4);
    return v;
#elif LANES == 8 && WAVELOBE_AVX2
    return __builtin_ia32_gatherd_ps256((float8)0.0f, (const void *)(ulong)p, as_int8(i), as_float8((int8)-1), 4);
#else
    Float v;
#define GATHER_LANE(k) v.s##k = p[i.s##k];
    FOR_LANES(GATHER_LANE)
#undef GATHER_LANE
    return v;
#endif
}

INLINE UInt gather_uint(global const uint *p, UInt i) { return as_UInt(gather((global const float *)p, i)); }

// Field `name` of record `i` in a buffer of `struct type`.
#define WORD_OFFSET(type, name) ((uint)(__builtin_offsetof(struct type, name) / 4u))
#define RECORD_WORDS(type) ((uint)(sizeof(struct type) / 4u))
#define GATHER_FIELD(buffer, type, i, name) \
    gather((global const float *)(buffer) + WORD_OFFSET(type, name), (i) * RECORD_WORDS(type))
#define GATHER_UINT_FIELD(buffer, type, i, name) as_UInt(GATHER_FIELD(buffer, type, i, name))

// p[i] = v in the lanes of the mask. No two of these lanes may name the same element.
INLINE void scatter(global float *p, UInt i, Float v, uint bits) {
#if LANES == 1
    if (bits) p[i] = v;
#elif LANES == 16 && WAVELOBE_AVX512
    __builtin_ia32_scattersiv16sf((void *)(ulong)p, (ushort)bits, as_int16(i), v, 4);
#else
#define SCATTER_LANE(k) if (bits & (1u << 0x##k)) p[i.s##k] = v.s##k;
    FOR_LANES(SCATTER_LANE)
#undef SCATTER_LANE
#endif
}

// Eight lanes in one permutation. (The first two generations of Zen have the instructions that find the order, but take hundreds of
// cycles for them.)
#if WAVELOBE_AVX2 && defined(__BMI2__) && !defined(__znver1__) && !defined(__znver2__)
#define WAVELOBE_COMPRESS8 1
INLINE void compress_store8(global float *p, float8 v, uint bits) {
    ulong kept = __builtin_ia32_pdep_di(bits, 0x0101010101010101ul) * 0xfful;
    int8 order = convert_int8(as_uchar8(__builtin_ia32_pext_di(0x0706050403020100ul, kept)));
    *(global Float8Unaligned *)p = __builtin_ia32_permvarsf256(v, order);
}
#else
#define WAVELOBE_COMPRESS8 0
#endif

// Stores the lanes named by `bits` one after the other from p on, keeping their order.
// May write anything to p[popcount(bits) .. LANES - 1]: queues are padded by LANES.
INLINE void compress_store(global float *p, Float v, uint bits) {
#if LANES == 1
    if (bits) *p = v;
#elif LANES == 16 && WAVELOBE_AVX512
    store(p, __builtin_ia32_compresssf512_mask(v, (float16)0.0f, (ushort)bits));
#elif LANES == 8 && WAVELOBE_AVX512
    store(p, __builtin_ia32_compresssf256_mask(v, (float8)0.0f, (uchar)bits));
#elif LANES == 16 && WAVELOBE_COMPRESS8
    compress_store8(p, v.lo, bits & 0xffu);
    compress_store8(p + popcount(bits & 0xffu), v.hi, bits >> 8);
#elif LANES == 8 && WAVELOBE_COMPRESS8
    compress_store8(p, v, bits);
#else
    // Branch-free: each lane is written where the next live one belongs, and overwritten if it is not live.
    uint n = 0;
#define COMPRESS_LANE(k) p[n] = v.s##k; n += (bits >> 0x##k) & 1u;
    FOR_LANES(COMPRESS_LANE)
#undef COMPRESS_LANE
#endif
}

INLINE void compress_store_uint(global uint *p, UInt v, uint bits) {
    compress_store((global float *)p, as_Float(v), bits);
}

#endif
