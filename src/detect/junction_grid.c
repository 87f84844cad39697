/* SPDX-License-Identifier: BSD-2-Clause */
#include "junction_grid.h"
#include "detection_run.h"
#include "core/memory.h"

#include <string.h>

static int32_t cells_of(int32_t side)
{
    return side / ASJ_GRID_CELL + 3;
}

static size_t cell_of(const asj_junction_grid *grid, const asj_hypothesis *junction)
{
    return (size_t)asj_grid_cell(junction->y, grid->rows) * (size_t)grid->columns +
           (size_t)asj_grid_cell(junction->x, grid->columns);
}

/* Counts the junctions of each cell; where the cells before end is where one begins; then each goes to the next place of its cell,
 * which ends with first[c] where cell c + 1 begins. */
static void fill(const asj_hypothesis *junctions, size_t count, size_t cells, asj_junction_grid *grid)
{
    int32_t *next = grid->first + 1;
    memset(grid->first, 0, (cells + 2) * sizeof *grid->first);
    for (size_t i = 0; i < count; i++)
        grid->first[cell_of(grid, &junctions[i]) + 2]++;
    for (size_t c = 0; c < cells; c++)
        next[c + 1] += next[c];
    for (size_t i = 0; i < count; i++) {
        const asj_hypothesis *h = &junctions[i];
        grid->places[next[cell_of(grid, h)]++] = (asj_grid_place){h->x, h->y, (int32_t)i, asj_octave_index(h->octave)};
    }
}

asj_status asj_junction_grid_make(asj_context *context, const asj_hypothesis *junctions, size_t count, int32_t width,
                                  int32_t height, asj_junction_grid *grid)
{
    grid->columns = cells_of(width);
    grid->rows = cells_of(height);
    const size_t cells = (size_t)grid->columns * (size_t)grid->rows;
    grid->first = asj_allocate(&context->memory, cells + 2, sizeof *grid->first);
    grid->places = asj_allocate_list(&context->memory, asj_detection_run_room(count), sizeof *grid->places);
    if (!grid->first || !grid->places) {
        asj_junction_grid_free(context, grid);
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for where %zu junctions are", count);
    }
    fill(junctions, count, cells, grid);
    return ASJ_OK;
}

void asj_junction_grid_free(asj_context *context, asj_junction_grid *grid)
{
    asj_release(&context->memory, grid->first);
    asj_release(&context->memory, grid->places);
    grid->first = NULL;
    grid->places = NULL;
}
