/* SPDX-License-Identifier: BSD-2-Clause */
#include "location_grid.h"
#include "nearest.h"

#include <math.h>
#include <string.h>

#define A_CELL 4.0     /* places */
#define LEAST_CELL 1.0 /* px */
#define ROUNDING 1e-6  /* px: more than a sum of coordinates is off */

static int32_t cell_of(double x, double from, double cell, int32_t cells)
{
    return (int32_t)fmax(0, fmin(floor((x - from) / cell), cells - 1));
}

static size_t index_of(const asj_location_grid *grid, double x, double y)
{
    return (size_t)cell_of(y, grid->upper, grid->cell, grid->rows) * (size_t)grid->columns +
           (size_t)cell_of(x, grid->left, grid->cell, grid->columns);
}

/* The cells: squares that cover all places. */
static void lay_out(const asj_location_place *places, uint32_t count, asj_location_grid *grid)
{
    double left = HUGE_VAL, right = -HUGE_VAL, upper = HUGE_VAL, lower = -HUGE_VAL;
    for (uint32_t p = 0; p < count; p++) {
        left = fmin(left, places[p].x), right = fmax(right, places[p].x);
        upper = fmin(upper, places[p].y), lower = fmax(lower, places[p].y);
    }
    const double width = count > 0 ? right - left : 0, height = count > 0 ? lower - upper : 0;
    const double each = A_CELL * fmax(width, LEAST_CELL) * fmax(height, LEAST_CELL) / fmax(count, 1);
    grid->left = count > 0 ? left : 0;
    grid->upper = count > 0 ? upper : 0;
    grid->cell = fmax(sqrt(each), LEAST_CELL);
    grid->columns = (int32_t)(width / grid->cell) + 1;
    grid->rows = (int32_t)(height / grid->cell) + 1;
}

/* As junctions are sorted into cells (detect/junction_grid.c). */
static void fill(const asj_location_place *places, uint32_t count, size_t cells, asj_location_grid *grid)
{
    uint32_t *next = grid->first + 1;
    memset(grid->first, 0, (cells + 2) * sizeof *grid->first);
    for (uint32_t p = 0; p < count; p++)
        grid->first[index_of(grid, places[p].x, places[p].y) + 2]++;
    for (size_t c = 0; c < cells; c++)
        next[c + 1] += next[c];
    for (uint32_t p = 0; p < count; p++)
        grid->places[next[index_of(grid, places[p].x, places[p].y)]++] = places[p];
}

asj_status asj_location_grid_make(asj_memory *memory, const asj_location_place *places, uint32_t count, asj_location_grid *grid)
{
    lay_out(places, count, grid);
    const size_t cells = (size_t)grid->columns * (size_t)grid->rows;
    grid->first = asj_allocate(memory, cells + 2, sizeof *grid->first);
    grid->places = asj_allocate(memory, count, sizeof *grid->places);
    if (!grid->first || !grid->places) {
        asj_location_grid_free(memory, grid);
        return ASJ_ERROR_MEMORY;
    }
    fill(places, count, cells, grid);
    return ASJ_OK;
}

void asj_location_grid_free(asj_memory *memory, asj_location_grid *grid)
{
    asj_release(memory, grid->first);
    asj_release(memory, grid->places);
    grid->first = NULL;
    grid->places = NULL;
}

/* --- the nearest ------------------------------------------------------------------------------------------------------------ */

typedef struct search {
    const asj_location_grid *grid;
    double x, y, least; /* px; px^2 */
    asj_nearest list;
} search;

/* Cells first_column .. last_column of a row, as far as there are such. */
static void look_in_row(search *s, int32_t row, int32_t first_column, int32_t last_column)
{
    const asj_location_grid *grid = s->grid;
    if (row < 0 || row >= grid->rows || last_column < 0 || first_column >= grid->columns)
        return;
    const size_t before = (size_t)row * (size_t)grid->columns;
    const int32_t from = first_column > 0 ? first_column : 0, to = last_column < grid->columns ? last_column : grid->columns - 1;
    for (uint32_t k = grid->first[before + (size_t)from]; k < grid->first[before + (size_t)to + 1]; k++) {
        const double dx = grid->places[k].x - s->x, dy = grid->places[k].y - s->y, square = dx * dx + dy * dy;
        if (square > s->least)
            asj_nearest_offer(&s->list, grid->places[k].index, square);
    }
}

/* px to the nearest side of the cells around that have others behind it; infinite when there are none. */
static double covered(const search *s, int32_t column, int32_t row, int32_t ring)
{
    const asj_location_grid *grid = s->grid;
    double least = HUGE_VAL;
    if (column - ring > 0)
        least = fmin(least, s->x - (grid->left + (column - ring) * grid->cell));
    if (row - ring > 0)
        least = fmin(least, s->y - (grid->upper + (row - ring) * grid->cell));
    if (column + ring < grid->columns - 1)
        least = fmin(least, grid->left + (column + ring + 1) * grid->cell - s->x);
    if (row + ring < grid->rows - 1)
        least = fmin(least, grid->upper + (row + ring + 1) * grid->cell - s->y);
    return fmax(least - ROUNDING, 0);
}

/* Ring after ring of cells around the place, until what lies beyond is too far away. */
uint32_t asj_location_grid_nearest(const asj_location_grid *grid, double x, double y, double separation, uint32_t limit,
                                   uint32_t *out)
{
    const double least = separation < 0 ? -1 : separation * separation;
    search s = {grid, x, y, least, {.limit = limit, .index = out}};
    const int32_t column = cell_of(x, grid->left, grid->cell, grid->columns), row = cell_of(y, grid->upper, grid->cell, grid->rows);
    look_in_row(&s, row, column, column);
    for (int32_t ring = 0;;) {
        const double all_within = covered(&s, column, row, ring);
        if (isinf(all_within) || asj_nearest_beyond(&s.list, all_within * all_within))
            return s.list.count;
        ring++;
        look_in_row(&s, row - ring, column - ring, column + ring);
        look_in_row(&s, row + ring, column - ring, column + ring);
        for (int32_t k = row - ring + 1; k < row + ring; k++) {
            look_in_row(&s, k, column - ring, column - ring);
            look_in_row(&s, k, column + ring, column + ring);
        }
    }
}

/* --- all that are near ------------------------------------------------------------------------------------------------------ */

/* Into a list that rises. */
static void insert(uint32_t index, uint32_t count, uint32_t *list)
{
    uint32_t k = count;
    for (; k > 0 && list[k - 1] > index; k--)
        list[k] = list[k - 1];
    list[k] = index;
}

uint32_t asj_location_grid_within(const asj_location_grid *grid, double x, double y, double radius, uint32_t most, uint32_t *out)
{
    const double reach = radius + ROUNDING, left = x - radius;
    const int32_t upper = cell_of(y - reach, grid->upper, grid->cell, grid->rows);
    const int32_t lower = cell_of(y + reach, grid->upper, grid->cell, grid->rows);
    const size_t from = (size_t)cell_of(x - reach, grid->left, grid->cell, grid->columns);
    const size_t end = (size_t)cell_of(x + reach, grid->left, grid->cell, grid->columns) + 1;
    uint32_t count = 0;
    for (int32_t row = upper; row <= lower; row++) {
        const size_t before = (size_t)row * (size_t)grid->columns;
        for (uint32_t k = grid->first[before + from]; k < grid->first[before + end]; k++) {
            const asj_location_place *p = &grid->places[k];
            const double dx = p->x - x, dy = p->y - y;
            if (dx * dx + dy * dy > radius * radius || dx > radius || p->x < left)
                continue;
            if (count == most)
                return most + 1;
            insert(p->index, count++, out);
        }
    }
    return count;
}

/* --- along a branch --------------------------------------------------------------------------------------------------------- */

/* Row after row of cells: in each the columns that the branch and `off` px beside it pass there. */
double asj_location_grid_last(const asj_location_grid *grid, double x, double y, const double u[2], double least, double most,
                              double off)
{
    const double beside = off + 1, y1 = y + least * u[1], y2 = y + most * u[1];
    const int32_t upper = cell_of(fmin(y1, y2) - beside, grid->upper, grid->cell, grid->rows);
    const int32_t lower = cell_of(fmax(y1, y2) + beside, grid->upper, grid->cell, grid->rows);
    double last = 0;
    for (int32_t row = upper; row <= lower && most >= least; row++) {
        double from = least, to = most; /* px along the branch */
        if (fabs(u[1]) > 1e-3) {
            const double enters = grid->upper + row * grid->cell - beside - y, leaves = enters + grid->cell + 2 * beside;
            const double one = enters / u[1], other = leaves / u[1];
            from = fmax(from, fmin(one, other));
            to = fmin(to, fmax(one, other));
        }
        if (!(from <= to))
            continue;
        const double x1 = x + from * u[0], x2 = x + to * u[0];
        const size_t before = (size_t)row * (size_t)grid->columns;
        const size_t first = (size_t)cell_of(fmin(x1, x2) - beside, grid->left, grid->cell, grid->columns);
        const size_t end = (size_t)cell_of(fmax(x1, x2) + beside, grid->left, grid->cell, grid->columns) + 1;
        for (uint32_t k = grid->first[before + first]; k < grid->first[before + end]; k++) {
            const double dx = grid->places[k].x - x, dy = grid->places[k].y - y, along = dx * u[0] + dy * u[1];
            if (along >= least && along <= most && along > last && fabs(dx * u[1] - dy * u[0]) < off)
                last = along;
        }
    }
    return last;
}
