// Choice of a row of an alias table by one random number (Walker 1974; Vose 1991).
#ifndef WAVELOBE_LIGHTS_ALIAS_PICK_H
#define WAVELOBE_LIGHTS_ALIAS_PICK_H

#include "core/lanes.h"
#include "shared/lights.h"

typedef struct {
    UInt index;     // below the number of rows
    Float fraction; // what is left of the random number, even over [0, 1)
} AliasPick;

#define BELOW_ONE 0.999999940395355224609375f // 1 - 2^-24

// Among `count` rows from row `first` on.  `u` has 24 bits at most: log2(count) of them go into the choice of the row, the
// rest settle between the row and its alias.
INLINE AliasPick alias_pick(global const struct AliasEntry *table, UInt first, uint count, Float u) {
    Float x = u * (float)count;
    Float row = LESSER(floor(x), (Float)((float)count - 1.0f));
    UInt i = as_UInt(convert_Int(row));
    Float f = LESSER(x - row, (Float)BELOW_ONE);
    Float threshold = GATHER_FIELD(table, AliasEntry, first + i, threshold);
    Int keep = f < threshold;
    AliasPick p;
    p.index = SELECT(keep, i, GATHER_UINT_FIELD(table, AliasEntry, first + i, other));
    Float rest = SELECT(keep, f, f - threshold) / SELECT(keep, threshold, 1.0f - threshold);
    p.fraction = LESSER(rest, (Float)BELOW_ONE);
    return p;
}

#endif
