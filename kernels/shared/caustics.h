// What guides paths to caustics: where photons are aimed, and what is kept of where they arrive (caustics/photons.h).
#ifndef WAVELOBE_SHARED_CAUSTICS_H
#define WAVELOBE_SHARED_CAUSTICS_H

#include "shared/types.h"

// A sphere about a surface with delta lobes.
struct CausticTarget {
    float center[3];
    float radius;
    float cumulative;     // chance of this one and those before it
    float inverse_chance; // of this one
};
WAVELOBE_CHECK_SIZE(CausticTarget, 24);

// The grid of cells about the targets. Where caustics are worth it a cell has a map of the directions they arrive from.
struct CausticGrid {
    float origin[3];
    float inverse_step;
    Uint32 size[3];
    Uint32 target_count;
    Uint32 batches;       // of photons
    Uint32 next_batch;    // that no work-item has taken
    Uint32 greatest_flux, greatest_radiance; // bits of floats: of all photons that arrived
    Uint32 recording;     // 0: photons are counted; 1: they are recorded in the maps of their cells
    float scene_size;     // diagonal of the scene's bounds
    float mean_irradiance; // of the scene's surfaces, about, were nothing in the way of light; by luminance, W / m^2
};
WAVELOBE_CHECK_SIZE(CausticGrid, 60);

// Directions by height and azimuth, all bins alike in solid angle.
#define CAUSTIC_ROWS 16u
#define CAUSTIC_COLUMNS 16u
#define CAUSTIC_BINS (CAUSTIC_ROWS * CAUSTIC_COLUMNS)
#define CAUSTIC_MAPS 4096u // at the most
// Floats of a map: running sums of the rows, running sums within each row, the density (solid angle) of each bin, and the share of
// samples that follow it.
#define CAUSTIC_SUMS_WITHIN CAUSTIC_ROWS
#define CAUSTIC_DENSITIES (CAUSTIC_ROWS + CAUSTIC_BINS)
#define CAUSTIC_SHARE (CAUSTIC_ROWS + 2u * CAUSTIC_BINS)
#define CAUSTIC_MAP_FLOATS (CAUSTIC_SHARE + 1u)

#define PHOTONS_A_BATCH 4096u
#define PHOTON_ROW 0x100000u // of the film, in no picture: photons share no random number with paths

#endif
