/* SPDX-License-Identifier: BSD-2-Clause */
/* Places by square cells: which are nearest, and which a branch passes. */
#ifndef ASJ_SRC_LOCATION_GRID_H
#define ASJ_SRC_LOCATION_GRID_H

#include "core/memory.h"

typedef struct asj_location_place {
    double x, y;    /* px */
    uint32_t index; /* what it is called in answers */
} asj_location_place;

/* Cells cover the places; the places of cell c are places[first[c]] .. places[first[c + 1] - 1]. About four to a cell. */
typedef struct asj_location_grid {
    uint32_t *first;
    asj_location_place *places;
    double left, upper, cell; /* px */
    int32_t columns, rows;
} asj_location_grid;

/* Of `count` places. ASJ_ERROR_MEMORY: nothing is left to free; the caller says so. */
asj_status asj_location_grid_make(asj_memory *memory, const asj_location_place *places, uint32_t count, asj_location_grid *grid);
void asj_location_grid_free(asj_memory *memory, asj_location_grid *grid);

/* The indices of the `limit` places nearest to (x, y), nearest first, ties by index; of those farther than `separation`, of all if
 * that is negative. Returns how many there are. */
uint32_t asj_location_grid_nearest(const asj_location_grid *grid, double x, double y, double separation, uint32_t limit,
                                   uint32_t *out);

/* The indices of all places no farther than `radius` px from (x, y), rising, with room for `most`. Returns how many there are; when
 * that is more than `most` nothing else is known. */
uint32_t asj_location_grid_within(const asj_location_grid *grid, double x, double y, double radius, uint32_t most, uint32_t *out);

/* px from (x, y) along the unit vector u to the farthest place that lies between `least` and `most` along it and less than `off`
 * beside it; 0 = none. */
double asj_location_grid_last(const asj_location_grid *grid, double x, double y, const double u[2], double least, double most,
                              double off);

#endif
