/* SPDX-License-Identifier: BSD-2-Clause */
/* The grid in which what lists of several octaves, sizes or planes have beside a place is found. */
#ifndef ASJ_SRC_OCTAVE_GRID_H
#define ASJ_SRC_OCTAVE_GRID_H

#include "hypothesis.h"

/* A list of hypotheses in pixels of the image, each linked into the cell that it lies in: heads[row * columns + column] is the last
 * one of the cell, next[i] the one before i, -1 none. */
typedef struct asj_octave_grid {
    int32_t *heads, *next;
    int32_t columns, rows;
    double coarsest; /* octave of those that are in */
} asj_octave_grid;

/* From the first to the last, all in the grid. */
typedef struct asj_octave_cells {
    int32_t left, right, top, bottom;
} asj_octave_cells;

/* Elements of `cells` for an image of this size and so many hypotheses; the grid stands there. */
size_t asj_octave_grid_cells(size_t count, int32_t width, int32_t height);
asj_octave_grid asj_octave_grid_start(int32_t width, int32_t height, int32_t *cells);
void asj_octave_grid_add(asj_octave_grid *grid, const asj_hypothesis *hypotheses, size_t index);

/* The cells of all that may lie within `reach` px. */
asj_octave_cells asj_octave_grid_around(const asj_octave_grid *grid, const asj_hypothesis *hypothesis, double reach);

#endif
