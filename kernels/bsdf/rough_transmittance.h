// How much light a rough dielectric surface lets through, out of a table over the cosine of incidence.
#ifndef WAVELOBE_BSDF_ROUGH_TRANSMITTANCE_H
#define WAVELOBE_BSDF_ROUGH_TRANSMITTANCE_H

#include "bsdf/lobe.h"

// From outside at incidence of this cosine; `table` is a material's RoughTransmittance.
INLINE Float rough_transmittance(MaterialInput table, Float cosine) {
    const float last = (float)(ROUGH_TRANSMITTANCE_STEPS - 1u);
    Float at = LESSER(GREATER(cosine, ZERO), ONE) * last;
    Float step = LESSER(floor(at), (Float)(last - 1.0f));
    global const float *words = (global const float *)table.materials;
    UInt word = table.material * RECORD_WORDS(Material) + as_UInt(convert_Int(step));
    Float share = at - step;
    return madd(1.0f - share, gather(words, word), share * gather(words + 1, word));
}

#endif
