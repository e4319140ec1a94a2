// Size of the table by which film positions are drawn.
#ifndef WAVELOBE_SHARED_FILTER_TABLE_H
#define WAVELOBE_SHARED_FILTER_TABLE_H

// Cells of the table; it holds their ends, one more.
#define FILTER_TABLE_CELLS 512u

#endif
