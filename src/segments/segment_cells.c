/* SPDX-License-Identifier: BSD-2-Clause */
/* A segment is in the cells that its strip, `margin` px to all sides, reaches: of each row of cells those columns between which the
 * part of the segment lies that is within `margin` of the row. So two segments that come within `margin` px of each other share a
 * cell when one was added with that margin and the other is asked for without. (SLACK: rounding.)
 *
 * Where many long ones cross, most of those in a cell go another way: each is kept by its direction, too, in as many classes as
 * make CLASS_SHARE of them for each segment, over all cells. */
#include "segment_cells.h"
#include "core/angle.h"

#include <math.h>
#include <string.h>

#define SIDE 32.0 /* px: of a cell, .. */
#define MOST 256  /* .. where so many cover the width and the height */
#define SLACK 0.01 /* px */
#define FEW 256    /* entries to begin with */
#define MOST_CLASSES 64
#define CLASS_SHARE 4
#define SLACK_TURN 0.01 /* rad: rounding, but of .. */
#define TOO_SHORT 1e-9  /* .. what is shorter than this part of it all, whose direction rounding may decide */

static int32_t cells_over(double length, double side)
{
    return (int32_t)fmin(floor(length / side) + 1, MOST + 1);
}

int32_t asj_segment_cells_make(asj_memory *memory, double left, double top, double right, double bottom, size_t segments,
                               asj_segment_cells *cells)
{
    memset(cells, 0, sizeof *cells);
    cells->left = left;
    cells->top = top;
    cells->extent = fmax(right - left, bottom - top);
    cells->side = fmax(SIDE, cells->extent / MOST);
    cells->columns = cells_over(right - left, cells->side);
    cells->rows = cells_over(bottom - top, cells->side);
    const size_t places = (size_t)cells->columns * (size_t)cells->rows, classes = CLASS_SHARE * segments / places;
    cells->classes = classes < 1 ? 1 : classes < MOST_CLASSES ? (int32_t)classes : MOST_CLASSES;
    cells->first = asj_allocate_zero(memory, places * (size_t)cells->classes, sizeof *cells->first);
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
    memset(cells->first, 0, (size_t)cells->columns * (size_t)cells->rows * (size_t)cells->classes * sizeof *cells->first);
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

/* In classes, from 0 on; what has no length goes some way. */
static double direction_of(const asj_segment_cells *cells, const asj_end_point ends[2])
{
    const double angle = atan2(ends[1].y - ends[0].y, ends[1].x - ends[0].x);
    return (angle < 0 ? angle + ASJ_PI : angle) / ASJ_PI * cells->classes;
}

asj_cell_classes asj_segment_cells_classes(const asj_segment_cells *cells, const asj_end_point ends[2], double turn)
{
    const double length = hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y), middle = direction_of(cells, ends);
    const double aside = (turn + SLACK_TURN) / ASJ_PI * cells->classes;
    const int32_t first = (int32_t)floor(middle - aside), count = (int32_t)floor(middle + aside) - first + 1;
    if (count >= cells->classes || !(length > TOO_SHORT * cells->extent))
        return (asj_cell_classes){0, cells->classes};
    return (asj_cell_classes){(first + cells->classes) % cells->classes, count};
}

static int32_t add_to_run(asj_memory *memory, asj_segment_cells *cells, asj_cell_run run, int32_t class, uint32_t segment)
{
    void *entries = cells->entries;
    const size_t more = (size_t)(run.last - run.first) + 1;
    if (cells->count + more > UINT32_MAX || asj_grow(memory, &entries, &cells->capacity, cells->count + more,
                                                     sizeof *cells->entries, cells->count) != ASJ_OK)
        return 0;
    cells->entries = entries;
    for (int32_t column = run.first; column <= run.last; column++) {
        uint32_t *first = asj_segment_cells_first(cells, run.row, column) + class;
        cells->entries[cells->count] = (asj_cell_entry){segment, *first};
        *first = (uint32_t)cells->count++;
    }
    return 1;
}

int32_t asj_segment_cells_add(asj_memory *memory, asj_segment_cells *cells, const asj_end_point ends[2], uint32_t segment)
{
    const int32_t class = (int32_t)direction_of(cells, ends) % cells->classes; /* half a turn is none */
    int32_t first, last, added = 1;
    asj_segment_cells_rows(cells, ends, ASJ_OFF_LINE, &first, &last);
    for (int32_t row = first; row <= last && added; row++)
        added = add_to_run(memory, cells, asj_segment_cells_run(cells, ends, ASJ_OFF_LINE, row), class, segment);
    return added;
}
