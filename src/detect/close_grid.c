/* SPDX-License-Identifier: BSD-2-Clause */
/* The grid of suppression. See close_grid.h. */
#include "close_grid.h"

#include <math.h>
#include <string.h>

static int32_t cells_of(int32_t size)
{
    return size / ASJ_CLOSE_CELL + 3; /* a border of cells for junctions just outside the image, and for the neighbours */
}

size_t asj_close_grid_cells(size_t count, int32_t width, int32_t height)
{
    return (size_t)cells_of(width) * (size_t)cells_of(height) + count;
}

asj_close_grid asj_close_grid_start(int32_t width, int32_t height, int32_t *cells)
{
    const asj_close_grid grid = {cells, cells + (size_t)cells_of(width) * (size_t)cells_of(height), cells_of(width),
                                 cells_of(height)};
    memset(grid.heads, 0xff, (size_t)grid.columns * (size_t)grid.rows * sizeof *grid.heads);
    return grid;
}

int64_t asj_close_grid_cell(const asj_close_grid *grid, double x, double y)
{
    int32_t column = (int32_t)floor(x / ASJ_CLOSE_CELL) + 1, row = (int32_t)floor(y / ASJ_CLOSE_CELL) + 1;
    column = column < 1 ? 1 : column > grid->columns - 2 ? grid->columns - 2 : column;
    row = row < 1 ? 1 : row > grid->rows - 2 ? grid->rows - 2 : row;
    return (int64_t)row * grid->columns + column;
}

void asj_close_grid_add(asj_close_grid *grid, int64_t cell, size_t index)
{
    grid->next[index] = grid->heads[cell];
    grid->heads[cell] = (int32_t)index;
}
