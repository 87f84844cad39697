/* SPDX-License-Identifier: BSD-2-Clause */
/* The grid in which suppression finds what lies close by: what stays is linked into cells as wide as the largest radius of
 * suppression, so that only the nine cells around a place need a look. */
#ifndef ASJ_SRC_CLOSE_GRID_H
#define ASJ_SRC_CLOSE_GRID_H

#include "isotropic.h"

/* A hypothesis suppresses others within the larger of 3 px and this share of its radius (suppress.c). */
#define ASJ_CLOSE_SHARE 0.35
#define ASJ_CLOSE_CELL 11 /* px: ASJ_CLOSE_SHARE * ASJ_MAX_RADIUS rounded up */

/* heads[cell] is the last element of a cell, next[i] the one before i; -1 = none. */
typedef struct asj_close_grid {
    int32_t *heads, *next;
    int32_t columns, rows;
} asj_close_grid;

/* Elements of `cells` for an image of this size and so many elements; the grid stands there. */
size_t asj_close_grid_cells(size_t count, int32_t width, int32_t height);
asj_close_grid asj_close_grid_start(int32_t width, int32_t height, int32_t *cells);

/* The cell of a place, which may lie outside the image; those around it are cell + dy * columns + dx, dx and dy of -1 .. 1. */
int64_t asj_close_grid_cell(const asj_close_grid *grid, double x, double y);
void asj_close_grid_add(asj_close_grid *grid, int64_t cell, size_t index);

#endif
