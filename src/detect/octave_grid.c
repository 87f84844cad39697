/* SPDX-License-Identifier: BSD-2-Clause */
#include "octave_grid.h"

#include <string.h>

#define CELL 16 /* px */

static int32_t cells_of(int32_t size)
{
    return size / CELL + 1;
}

size_t asj_octave_grid_cells(size_t count, int32_t width, int32_t height)
{
    return (size_t)cells_of(width) * (size_t)cells_of(height) + count;
}

static int32_t inside(double cell, int32_t cells)
{
    return cell <= 0 ? 0 : cell >= cells - 1 ? cells - 1 : (int32_t)cell;
}

asj_octave_cells asj_octave_grid_around(const asj_octave_grid *grid, const asj_hypothesis *hypothesis, double reach)
{
    const double x = hypothesis->x, y = hypothesis->y;
    return (asj_octave_cells){inside((x - reach) / CELL, grid->columns), inside((x + reach) / CELL, grid->columns),
                              inside((y - reach) / CELL, grid->rows), inside((y + reach) / CELL, grid->rows)};
}

asj_octave_grid asj_octave_grid_start(int32_t width, int32_t height, int32_t *cells)
{
    asj_octave_grid grid = {cells, NULL, cells_of(width), cells_of(height), 0};
    const size_t count = (size_t)grid.columns * (size_t)grid.rows;
    grid.next = cells + count;
    memset(grid.heads, 0xff, count * sizeof *grid.heads);
    return grid;
}

void asj_octave_grid_add(asj_octave_grid *grid, const asj_hypothesis *hypotheses, size_t index)
{
    const asj_octave_cells at = asj_octave_grid_around(grid, &hypotheses[index], 0);
    int32_t *head = &grid->heads[at.top * grid->columns + at.left];
    grid->next[index] = *head;
    *head = (int32_t)index;
    grid->coarsest = grid->coarsest > hypotheses[index].octave ? grid->coarsest : hypotheses[index].octave;
}
