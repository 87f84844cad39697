/* SPDX-License-Identifier: BSD-2-Clause */
/* Which of many line segments may come within ASJ_OFF_LINE px of another that goes about the same way: they are kept by the square
 * cells that they pass, and in each by their direction. */
#ifndef ASJ_SRC_SEGMENT_CELLS_H
#define ASJ_SRC_SEGMENT_CELLS_H

#include "course.h"
#include "core/memory.h"

typedef struct asj_cell_entry {
    uint32_t segment;
    uint32_t next; /* the next entry of the cell and class; 0 = none */
} asj_cell_entry;

typedef struct asj_segment_cells {
    double left, top, side;  /* px */
    double extent;           /* px: width or height of it all */
    int32_t columns, rows;
    int32_t classes;         /* of directions: so many in half a turn */
    uint32_t *first;         /* of each cell and class its newest entry; 0 = none */
    asj_cell_entry *entries; /* from 1 on */
    size_t count, capacity;
} asj_segment_cells;

/* Of a cell: its classes. */
static inline uint32_t *asj_segment_cells_first(const asj_segment_cells *cells, int32_t row, int32_t column)
{
    return cells->first + ((size_t)row * (size_t)cells->columns + (size_t)column) * (size_t)cells->classes;
}

/* Some cells in a row: those of columns first .. last. */
typedef struct asj_cell_run {
    int32_t row, first, last;
} asj_cell_run;

/* Classes next .. next + count - 1, and from the last one on to the first again. */
typedef struct asj_cell_classes {
    int32_t next, count;
} asj_cell_classes;

/* For about `segments` of them in this rectangle. 0: no memory, and nothing is left to free. */
int32_t asj_segment_cells_make(asj_memory *memory, double left, double top, double right, double bottom, size_t segments,
                               asj_segment_cells *cells);
void asj_segment_cells_clear(asj_segment_cells *cells);
void asj_segment_cells_free(asj_memory *memory, asj_segment_cells *cells);

/* Adds a segment to the cells that it comes within ASJ_OFF_LINE px of. 0: no memory. */
int32_t asj_segment_cells_add(asj_memory *memory, asj_segment_cells *cells, const asj_end_point ends[2], uint32_t segment);

/* Of the rows of cells, which does a segment pass? Then run after run: */
void asj_segment_cells_rows(const asj_segment_cells *cells, const asj_end_point ends[2], double margin, int32_t *first,
                            int32_t *last);
/* Those of what is turned against a segment by at most `turn` rad, to either side. */
asj_cell_classes asj_segment_cells_classes(const asj_segment_cells *cells, const asj_end_point ends[2], double turn);
asj_cell_run asj_segment_cells_run(const asj_segment_cells *cells, const asj_end_point ends[2], double margin, int32_t row);

#endif
