// Scalar types that mean the same to both compilers.
#ifndef WAVELOBE_SHARED_TYPES_H
#define WAVELOBE_SHARED_TYPES_H

#ifdef __OPENCL_C_VERSION__
typedef uint Uint32;
typedef ulong Uint64;
#define WAVELOBE_CHECK_SIZE(type, bytes) typedef char check_size_of_##type[sizeof(struct type) == (bytes) ? 1 : -1]
#else
#include <cstdint>
using Uint32 = std::uint32_t;
using Uint64 = std::uint64_t;
#define WAVELOBE_CHECK_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "host and kernels must agree")
#endif

#define WAVELOBE_NONE 0xffffffffu

// Words that core/rows.h reads at once, whether they are wanted or not: buffers that it reads end with as many of padding.
#define ROW_WORDS 16u

// Twelve bytes on both sides, unlike OpenCL's float3.
struct Packed3 {
    float x, y, z;
};
WAVELOBE_CHECK_SIZE(Packed3, 12);

// Row-major affine map: three rows of (x, y, z, translation).
struct Affine {
    float m[12];
};
WAVELOBE_CHECK_SIZE(Affine, 48);

#endif
