/* SPDX-License-Identifier: BSD-2-Clause */
/* Which of many line segments may come within ASJ_OFF_LINE px of another: they are kept by the square cells that they pass. */
#ifndef ASJ_SRC_SEGMENT_CELLS_H
#define ASJ_SRC_SEGMENT_CELLS_H

#include "course.h"
#include "core/memory.h"

typedef struct asj_cell_entry {
    uint32_t segment;
    uint32_t next; /* the next entry of the cell; 0 = none */
} asj_cell_entry;

typedef struct asj_segment_cells {
    double left, top, side;  /* px */
    int32_t columns, rows;
    uint32_t *first;         /* of each cell its newest entry; 0 = none */
    asj_cell_entry *entries; /* from 1 on */
    size_t count, capacity;
} asj_segment_cells;

/* Some cells in a row: those of columns first .. last. */
typedef struct asj_cell_run {
    int32_t row, first, last;
} asj_cell_run;

/* For segments in this rectangle. 0: no memory, and nothing is left to free. */
int32_t asj_segment_cells_make(asj_memory *memory, double left, double top, double right, double bottom, asj_segment_cells *cells);
void asj_segment_cells_clear(asj_segment_cells *cells);
void asj_segment_cells_free(asj_memory *memory, asj_segment_cells *cells);

/* Adds a segment to the cells that it comes within ASJ_OFF_LINE px of. 0: no memory. */
int32_t asj_segment_cells_add(asj_memory *memory, asj_segment_cells *cells, const asj_end_point ends[2], uint32_t segment);

/* Of the rows of cells, which does a segment pass? Then run after run: */
void asj_segment_cells_rows(const asj_segment_cells *cells, const asj_end_point ends[2], double margin, int32_t *first,
                            int32_t *last);
asj_cell_run asj_segment_cells_run(const asj_segment_cells *cells, const asj_end_point ends[2], double margin, int32_t row);

#endif
