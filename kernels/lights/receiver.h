// Where light is received and how: what a light is chosen by. A path carries all but the place, in few bits: what chose a light must
// be found again where the path hits one, exactly.
#ifndef WAVELOBE_LIGHTS_RECEIVER_H
#define WAVELOBE_LIGHTS_RECEIVER_H

#include "core/math.h"
#include "core/vector.h"

typedef struct {
    UInt normal; // two numbers of 16 bits; RECEIVER_ANY stands for a surface that receives from both sides
#if HAS_GLOSSY_RECEIVERS
    UInt lobe;   // two numbers of 12 bits for the axis, six bits for the peak, two for the diffuse share
#endif
} ReceiverCode;

// `normal` is meaningless where both sides receive.
typedef struct {
    Vec3 position, normal;
    Int any_side;
#if HAS_GLOSSY_RECEIVERS
    Vec3 axis;     // mirror direction
    Float peak;    // density of the lobe there, times pi; zero without a lobe
    Float diffuse; // weight of what has no lobe
#endif
} Receiver;

#define RECEIVER_ANY 0xffffffffu
#define NORMAL_STEPS 32767.0f

// ---- directions as points of an unfolded octahedron ----------------------------------------------------------
// Meyer, Suessmuth, Sussner, Stamminger, Greiner 2010, "On Floating-Point Normal Vectors".

// The two coordinates in whole steps, of which there are `steps` on both sides of zero.
INLINE void octahedral_code(Vec3 v, float steps, UInt *a, UInt *b) {
    Vec3 m = absolute(v);
    Float inverse = 1.0f / (m.x + m.y + m.z);
    Float x = v.x * inverse, y = v.y * inverse;
    Int folded = v.z < 0.0f;
    Float fx = copy_sign(1.0f - fabs(y), x), fy = copy_sign(1.0f - fabs(x), y);
    x = SELECT(folded, fx, x);
    y = SELECT(folded, fy, y);
    *a = as_UInt(convert_Int(madd(x, (Float)steps, (Float)(steps + 0.5f))));
    *b = as_UInt(convert_Int(madd(y, (Float)steps, (Float)(steps + 0.5f))));
}

INLINE Vec3 octahedral_direction(UInt a, UInt b, float steps) {
    Float x = (convert_Float(as_Int(a)) - steps) / steps;
    Float y = (convert_Float(as_Int(b)) - steps) / steps;
    Float z = 1.0f - fabs(x) - fabs(y);
    Float fold = LESSER(z, ZERO); // negative in the lower half
    return normalize3(vec3(x + copy_sign(fold, -x), y + copy_sign(fold, -y), z));
}

INLINE UInt normal_code(Vec3 normal) {
    UInt a, b;
    octahedral_code(normal, NORMAL_STEPS, &a, &b);
    return a | (b << 16);
}

// ---- the glossy lobe -------------------------------------------------------------------------------------------

#if HAS_GLOSSY_RECEIVERS
#define LOBE_STEPS 2047.0f
#define LOBE_PEAK_SHIFT 24
#define LOBE_SHARE_SHIFT 30
#define NO_LOBE (3u << LOBE_SHARE_SHIFT)
// Sharper lobes find their lights by themselves.
#define GREATEST_PEAK 1023.0f
// The exponent and two bits of a float's fraction, from one on: quarters of octaves, rounded down.
#define PEAK_BITS_SHIFT 21
#define PEAK_OF_ONE (127u << 2)
// What has no diffuse part still gets this share of a diffuse surface's weight: lobes have tails.
#define LEAST_DIFFUSE 0.125f

// `axis` is the mirror direction, `density` that of sampling it (solid angle), `diffuse` the share of diffuse lobes.
INLINE UInt lobe_code(Vec3 axis, Float density, Float diffuse) {
    UInt a, b;
    octahedral_code(axis, LOBE_STEPS, &a, &b);
    Float peak = LESSER(GREATER(density * PI_F, ONE), (Float)GREATEST_PEAK);
    UInt step = (as_UInt(peak) >> PEAK_BITS_SHIFT) - (UInt)PEAK_OF_ONE;
    UInt share = as_UInt(convert_Int(madd(diffuse, (Float)3.0f, (Float)0.5f)));
    return a | (b << 12) | (step << LOBE_PEAK_SHIFT) | (share << LOBE_SHARE_SHIFT);
}

INLINE void decode_lobe(UInt code, Receiver *r) {
    r->axis = octahedral_direction(code & (UInt)0xfffu, (code >> 12) & (UInt)0xfffu, LOBE_STEPS);
    UInt step = (code >> LOBE_PEAK_SHIFT) & (UInt)63u;
    r->peak = SELECT(step == (UInt)0u, ZERO, as_Float((step + (UInt)PEAK_OF_ONE) << PEAK_BITS_SHIFT));
    Float share = convert_Float(as_Int(code >> LOBE_SHARE_SHIFT)) * (1.0f / 3.0f);
    r->diffuse = madd(share, (Float)(1.0f - LEAST_DIFFUSE), (Float)LEAST_DIFFUSE);
}
#endif

INLINE Receiver receiver_of(Vec3 position, ReceiverCode code) {
    Receiver r;
    r.position = position;
    r.any_side = code.normal == (UInt)RECEIVER_ANY;
    r.normal = octahedral_direction(code.normal & (UInt)0xffffu, code.normal >> 16, NORMAL_STEPS);
#if HAS_GLOSSY_RECEIVERS
    decode_lobe(code.lobe, &r);
#endif
    return r;
}

#endif
