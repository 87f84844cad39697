/* SPDX-License-Identifier: BSD-2-Clause */
/* The offsets of a radius in the order of the image, and gamma at all of them around one pixel. */
#ifndef ASJ_SRC_SECTOR_RUNS_H
#define ASJ_SRC_SECTOR_RUNS_H

#include "sector.h"

#define ASJ_SECTOR_RUN 8

/* Offsets in runs of neighbours in a row, some of which are not within the radius: those, and that of the centre, have no
 * direction. */
typedef struct asj_sector_runs {
    int32_t count;
    int16_t *dx, *dy;                     /* of the first offset of each run */
    int16_t (*factors)[ASJ_SECTOR_RUN];   /* four rows for each run: x, y, cross_x, dot_y of asj_direction */
    void *memory;
} asj_sector_runs;

asj_status asj_sector_runs_create(asj_memory *memory, const asj_sectors *sectors, asj_sector_runs *runs);
void asj_sector_runs_free(asj_memory *memory, asj_sector_runs *runs);

/* Where each offset of these sectors, whose radius is that of the runs or smaller, stands in them: run * ASJ_SECTOR_RUN + number in
 * the run. */
void asj_sector_runs_places(const asj_sector_runs *runs, const asj_sectors *sectors, int16_t *places);

/* gamma at each offset of all runs around the pixel at (gx, gy); 0 where there is no direction. */
void asj_sector_gammas(const asj_sector_runs *runs, const int16_t *gx, const int16_t *gy, ptrdiff_t stride, uint16_t *gamma);

#endif
