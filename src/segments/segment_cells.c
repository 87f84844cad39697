/* SPDX-License-Identifier: BSD-2-Clause */
/* A segment is in the cells that its strip, `margin` px to all sides, reaches: of each row of cells those columns between which the
 * part of the segment lies that is within `margin` of the row. So two segments that come within `margin` px of each other share a
 * cell when one was added with that margin and the other is asked for without. (SLACK: rounding.) */
#include "segment_cells.h"

#include <math.h>
#include <string.h>

#define SIDE 32.0 /* px: of a cell, .. */
#define MOST 256  /* .. where so many cover the width and the height */
#define SLACK 0.01 /* px */
#define FEW 256    /* entries to begin with */

static int32_t cells_over(double length, double side)
{
    return (int32_t)fmin(floor(length / side) + 1, MOST + 1);
}

int32_t asj_segment_cells_make(asj_memory *memory, double left, double top, double right, double bottom, asj_segment_cells *cells)
{
    memset(cells, 0, sizeof *cells);
    cells->left = left;
    cells->top = top;
    cells->side = fmax(SIDE, fmax(right - left, bottom - top) / MOST);
    cells->columns = cells_over(right - left, cells->side);
    cells->rows = cells_over(bottom - top, cells->side);
    cells->first = asj_allocate_zero(memory, (size_t)cells->columns * (size_t)cells->rows, sizeof *cells->first);
    cells->entries = asj_allocate(memory, FEW, sizeof *cells->entries);
    cells->capacity = FEW;
    cells->count = 1;
    if (cells->first && cells->entries)
        return 1;
    asj_segment_cells_free(memory, cells);
    return 0;
}

void asj_segment_cells_clear(asj_segment_cells *cells)
{
    memset(cells->first, 0, (size_t)cells->columns * (size_t)cells->rows * sizeof *cells->first);
    cells->count = 1;
}

void asj_segment_cells_free(asj_memory *memory, asj_segment_cells *cells)
{
    asj_release(memory, cells->first);
    asj_release(memory, cells->entries);
    memset(cells, 0, sizeof *cells);
}

static int32_t cell_of(double offset, double side, int32_t count)
{
    return (int32_t)fmax(0, fmin(floor(offset / side), count - 1));
}

void asj_segment_cells_rows(const asj_segment_cells *cells, const asj_end_point ends[2], double margin, int32_t *first,
                            int32_t *last)
{
    margin += SLACK;
    *first = cell_of(fmin(ends[0].y, ends[1].y) - margin - cells->top, cells->side, cells->rows);
    *last = cell_of(fmax(ends[0].y, ends[1].y) + margin - cells->top, cells->side, cells->rows);
}

asj_cell_run asj_segment_cells_run(const asj_segment_cells *cells, const asj_end_point ends[2], double margin, int32_t row)
{
    const double dx = ends[1].x - ends[0].x, dy = ends[1].y - ends[0].y;
    double from = 0, to = 1; /* the part of the segment, from end to end */
    margin += SLACK;
    if (fabs(dy) > cells->side) { /* less does not narrow it */
        const double above = (cells->top + row * cells->side - margin - ends[0].y) / dy;
        const double below = (cells->top + (row + 1) * cells->side + margin - ends[0].y) / dy;
        from = fmax(0, fmin(above, below));
        to = fmin(1, fmax(above, below));
    }
    const double one = ends[0].x + from * dx, other = ends[0].x + to * dx;
    return (asj_cell_run){row, cell_of(fmin(one, other) - margin - cells->left, cells->side, cells->columns),
                          cell_of(fmax(one, other) + margin - cells->left, cells->side, cells->columns)};
}

static int32_t add_to_run(asj_memory *memory, asj_segment_cells *cells, asj_cell_run run, uint32_t segment)
{
    void *entries = cells->entries;
    const size_t more = (size_t)(run.last - run.first) + 1;
    if (cells->count + more > UINT32_MAX || asj_grow(memory, &entries, &cells->capacity, cells->count + more,
                                                     sizeof *cells->entries, cells->count) != ASJ_OK)
        return 0;
    cells->entries = entries;
    for (int32_t column = run.first; column <= run.last; column++) {
        uint32_t *first = &cells->first[(size_t)run.row * (size_t)cells->columns + (size_t)column];
        cells->entries[cells->count] = (asj_cell_entry){segment, *first};
        *first = (uint32_t)cells->count++;
    }
    return 1;
}

int32_t asj_segment_cells_add(asj_memory *memory, asj_segment_cells *cells, const asj_end_point ends[2], uint32_t segment)
{
    int32_t first, last, added = 1;
    asj_segment_cells_rows(cells, ends, ASJ_OFF_LINE, &first, &last);
    for (int32_t row = first; row <= last && added; row++)
        added = add_to_run(memory, cells, asj_segment_cells_run(cells, ends, ASJ_OFF_LINE, row), segment);
    return added;
}
