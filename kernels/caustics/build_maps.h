// Maps of directions from sums of photons.
#ifndef WAVELOBE_CAUSTICS_BUILD_MAPS_H
#define WAVELOBE_CAUSTICS_BUILD_MAPS_H

#include "core/math.h"
#include "shared/caustics.h"

// A map of each cell that has one, from the sums of its photons.
kernel void build_caustic_maps(global const ulong *caustic_sums, global float *caustic_maps) {
    global const ulong *bins = caustic_sums + get_global_id(0) * CAUSTIC_BINS;
    global float *map = caustic_maps + get_global_id(0) * CAUSTIC_MAP_FLOATS;
    ulong all = 0u;
    for (uint k = 0u; k < CAUSTIC_BINS; k++) all += bins[k];
    ulong rows = 0u;
    float before_row = 0.0f;
    for (uint r = 0u; r < CAUSTIC_ROWS; r++) {
        global const ulong *row = bins + r * CAUSTIC_COLUMNS;
        ulong of_row = 0u, within = 0u;
        for (uint c = 0u; c < CAUSTIC_COLUMNS; c++) of_row += row[c];
        rows += of_row;
        map[r] = all == 0u ? 1.0f : (float)rows / (float)all;
        float before = 0.0f;
        for (uint c = 0u; c < CAUSTIC_COLUMNS; c++) {
            uint bin = r * CAUSTIC_COLUMNS + c;
            within += row[c];
            float up_to = of_row == 0u ? 1.0f : (float)within / (float)of_row;
            map[CAUSTIC_SUMS_WITHIN + bin] = up_to;
            // That of choosing it by the rounded sums.
            map[CAUSTIC_DENSITIES + bin] = row[c] == 0u ? 0.0f : (map[r] - before_row) * (up_to - before) * ((float)CAUSTIC_BINS * INV_FOUR_PI_F);
            before = up_to;
        }
        before_row = map[r];
    }
}

#endif
