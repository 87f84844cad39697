/* SPDX-License-Identifier: BSD-2-Clause */
/* Where junctions are, by square cells of the image: edges and ends look for those near a place. */
#ifndef ASJ_SRC_JUNCTION_GRID_H
#define ASJ_SRC_JUNCTION_GRID_H

#include "hypothesis.h"
#include "core/context.h"

#include <math.h>

#define ASJ_GRID_CELL 32 /* px */

typedef struct asj_grid_place {
    double x, y;
    int32_t junction; /* its index */
    int32_t octave;   /* asj_octave_index() */
} asj_grid_place;

/* Those of cell c are places[first[c]] .. places[first[c + 1] - 1], in order of index. A border of empty cells
 * stands around the image, so that all have neighbours; what lies outside of it counts in its outermost cells. */
typedef struct asj_junction_grid {
    int32_t *first;
    asj_grid_place *places;
    int32_t columns, rows;
} asj_junction_grid;

/* Of `count` junctions in an image of this size. ASJ_ERROR_MEMORY: nothing is left to free, and the message is set. */
asj_status asj_junction_grid_make(asj_context *context, const asj_hypothesis *junctions, size_t count, int32_t width,
                                  int32_t height, asj_junction_grid *grid);
void asj_junction_grid_free(asj_context *context, asj_junction_grid *grid);

/* The column of x, or the row of y, of so many: 1 .. cells - 2. */
static inline int32_t asj_grid_cell(double x, int32_t cells)
{
    const double cell = floor(x / ASJ_GRID_CELL) + 1;
    return (int32_t)fmax(1, fmin(cell, cells - 2));
}

#endif
