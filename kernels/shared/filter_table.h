// Size of the table by which film positions are drawn.
#ifndef WAVELOBE_SHARED_FILTER_TABLE_H
#define WAVELOBE_SHARED_FILTER_TABLE_H

// Cells of the table; it holds their ends, one more, and for filters that are negative somewhere then the weight of each cell.
#define FILTER_TABLE_CELLS 512u
#define FILTER_TABLE_WEIGHTS (FILTER_TABLE_CELLS + 1u)

#endif
