// Sheen: fibres that stand off a surface, by KHR_materials_sheen (Khronos Group 2020) after Estevez, Kulla 2017, "Production Friendly
// Microfacet Sheen BRDF". What is below gets what the sheen leaves by its directional albedo, out of a table.
//
// Deviation, without which rough surfaces seen at grazing angles would send out more than they get: where the albedo is above one the
// sheen is divided by it, that of the direction with the larger one.
#ifndef WAVELOBE_BSDF_SHEEN_H
#define WAVELOBE_BSDF_SHEEN_H

#include "bsdf/lobe.h"

typedef struct {
    Rgb color;
    Float roughness; // square root of the fibres' alpha, at least SHEEN_LEAST_ROUGHNESS
    global const float *words;
    UInt table; // in `words`, of SheenAlbedo
} Sheen;

// Of a directional albedo for white sheen.
INLINE Float sheen_albedo(Sheen s, Float cosine) {
    const float last_row = (float)(SHEEN_ROUGHNESSES - 1u), last_column = (float)(SHEEN_COSINES - 1u);
    Float y = (s.roughness - SHEEN_LEAST_ROUGHNESS) * (last_row / (1.0f - SHEEN_LEAST_ROUGHNESS));
    Float x = sqrt(LESSER(GREATER(cosine, ZERO), ONE)) * last_column;
    Float row = LESSER(floor(y), (Float)(last_row - 1.0f)), column = LESSER(floor(x), (Float)(last_column - 1.0f));
    UInt at = s.table + as_UInt(convert_Int(row)) * SHEEN_COSINES + as_UInt(convert_Int(column));
    Float across = x - column, along = y - row;
    Float low = madd(1.0f - across, gather(s.words, at), across * gather(s.words + 1, at));
    Float high = madd(1.0f - across, gather(s.words + SHEEN_COSINES, at), across * gather(s.words + SHEEN_COSINES + 1, at));
    return madd(1.0f - along, low, along * high);
}

// What of the light below is left, by the larger of the albedos along both directions.
INLINE Float sheen_rest(Sheen s, Float albedo) { return 1.0f - max_component(s.color) * LESSER(albedo, ONE); }

// Fit of the logarithm of masking at cosines up to one half; each constant varies with (1 - alpha)^2 = `smooth`.
INLINE Float sheen_log_masking(Float cosine, Float smooth) {
    Float a = madd(smooth, (Float)(25.3245f - 21.5473f), (Float)21.5473f);
    Float b = madd(smooth, (Float)(3.32435f - 3.82987f), (Float)3.82987f);
    Float c = madd(smooth, (Float)(0.16801f - 0.19823f), (Float)0.19823f);
    Float d = madd(smooth, (Float)(-1.27393f + 1.97760f), (Float)-1.97760f);
    Float e = madd(smooth, (Float)(-4.85967f + 4.32054f), (Float)-4.32054f);
    return madd(d, cosine, e) + a / madd(b, lane_pow(cosine, c), ONE);
}

INLINE Float sheen_masking(Float cosine, Float smooth) {
    Int steep = cosine < 0.5f;
    Float log_here = sheen_log_masking(SELECT(steep, cosine, GREATER(1.0f - cosine, ZERO)), smooth);
    return lane_exp(SELECT(steep, log_here, 2.0f * sheen_log_masking((Float)0.5f, smooth) - log_here));
}

// BSDF times |cos wo| of white sheen, both directions above the surface; `albedo` is the larger of theirs.
INLINE Float sheen_value(Sheen s, Vec3 wi, Vec3 wo, Float albedo) {
    Float alpha = s.roughness * s.roughness;
    Float smooth = (1.0f - alpha) * (1.0f - alpha);
    Vec3 sum = add(wi, wo);
    Float across = madd(sum.x, sum.x, sum.y * sum.y);
    Float sin2 = across / GREATER(madd(sum.z, sum.z, across), (Float)FLOAT_MIN_NORMAL); // both along the horizon and opposite: zero
    Float inverse = 1.0f / alpha;
    Float density = (2.0f + inverse) * (0.5f * INV_PI) * lane_pow(sin2, 0.5f * inverse);
    Float masking = 1.0f + sheen_masking(wi.z, smooth) + sheen_masking(wo.z, smooth);
    return density / (4.0f * wi.z * masking * GREATER(albedo, ONE));
}

#endif
