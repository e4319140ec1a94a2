// The diffuse part of the thin principled material: reflection and transmission.
#ifndef WAVELOBE_BSDF_PRINCIPLED_THIN_BASE_H
#define WAVELOBE_BSDF_PRINCIPLED_THIN_BASE_H

#include "bsdf/principled_parameters.h"
#include "sampling/warps.h"

typedef struct {
    PrincipledDiffuse diffuse;
    Float scattering, transmitting; // transmitting: share of what scatters
} PrincipledThinBaseLobe;

INLINE PrincipledThinBaseLobe principled_thin_base_load(MaterialInput in) {
    PrincipledThinBaseLobe l;
    l.diffuse = load_principled_diffuse(in);
    l.scattering = 1.0f - load_principled_float(in, spec_trans);
    l.transmitting = 0.5f * load_principled_float(in, diff_trans);
    return l;
}

INLINE Float principled_thin_base_weight(PrincipledThinBaseLobe l, Vec3 wi) {
    return l.scattering * max_component(add(l.diffuse.base, l.diffuse.sheen));
}

INLINE Float transmitted_chance(PrincipledThinBaseLobe l) { return LESSER(GREATER(l.transmitting, ZERO), ONE); }

INLINE LobeValue principled_thin_base_eval(PrincipledThinBaseLobe l, Vec3 wi, Vec3 wo) {
    Int reflects = wi.z * wo.z > 0.0f;
    Vec3 i = select3(wi.z < 0.0f, negate(wi), wi);
    Vec3 o = select3(wi.z < 0.0f, negate(wo), wo);
    Float reflecting = l.scattering * (1.0f - l.transmitting);
    Rgb reflected = principled_diffuse(l.diffuse, i, vec3(o.x, o.y, fabs(o.z)), reflecting, reflecting);
    Float cosine = fabs(wo.z) * INV_PI;
    Rgb transmitted = scale(l.diffuse.base, l.scattering * l.transmitting * cosine);
    Float chance = transmitted_chance(l);
    Rgb value = select3(reflects, reflected, transmitted);
    return lobe_value_where((wi.z != 0.0f) & (wo.z != 0.0f), value, cosine * SELECT(reflects, 1.0f - chance, chance));
}

INLINE Vec3 principled_thin_base_sample(PrincipledThinBaseLobe l, Vec3 wi, Float u1, Float u2, Float u3) {
    Vec3 wo = sample_cosine_hemisphere(u1, u2);
    Int below = (u3 < transmitted_chance(l)) == (wi.z > 0.0f);
    return select3(wi.z != 0.0f, select3(below, negate(wo), wo), vec3_all(ZERO));
}

#endif
