/* SPDX-License-Identifier: BSD-2-Clause */
/* How to compute the sums of all sectors of one radius with the least work at every pixel of a region. */
#ifndef ASJ_SRC_SECTOR_PLAN_H
#define ASJ_SRC_SECTOR_PLAN_H

#include "sector_runs.h"

/* gamma depends on the axis of an offset only, so it is computed once for each axis and pixel, as planes, and shared by all
 * offsets on that axis. The four mirror images of an axis share their products:
 *     a >= b >= 0, high halves of products, as in asj_sector_direction()
 *     plane 0: axis ( a, b)   |gx b - gy a| - |gx a - gy -b|        plane 1: axis (-b, a)   the negative of plane 0
 *     plane 2: axis ( b, a)   |gx a - gy b| - |gx b - gy -a|        plane 3: axis ( a,-b)   the negative of plane 2
 * each cut at zero.
 *
 * Of the running sum over the offsets only the values where a sector begins or ends are needed: the slots. A sector that runs past
 * the last offset ends in an extra slot, which is the total plus another slot. */
typedef struct asj_sector_plan {
    int32_t family_count;
    int16_t *a, *b;        /* for each family of four planes */
    int16_t *used[2];      /* for each family, in even rows [0] and odd rows [1] from the centre's: bit p set = plane p is used in
                            * even columns, bit p + 4 in odd columns */
    int16_t *plane;        /* for each offset */
    int32_t slot_count;    /* with the extra ones */
    int32_t plain_count;   /* the slots before the extra ones */
    int16_t *boundary;     /* plain slot j: the sum over the offsets before boundary[j], rising; the last is the total */
    int16_t *extra;        /* extra slot plain_count + e: the last plain slot plus slot extra[e] */
    int16_t *low, *high;   /* sector k: slot high[k] minus slot low[k] */
    int16_t (*steps)[2];   /* for each offset, times ASJ_SECTOR_RUN: where its gamma stands in runs, and the slot of the running
                            * sum: the first one whose boundary is behind the offset, so that what was put there last stays */
    void *memory;
} asj_sector_plan;

asj_status asj_sector_plan_create(asj_memory *memory, const asj_sectors *sectors, asj_sector_plan *plan);
/* Sets the steps; places: of the offsets in runs (sector_runs.h). */
void asj_sector_plan_set_steps(const asj_sectors *sectors, const int16_t *places, asj_sector_plan *plan);

void asj_sector_plan_free(asj_memory *memory, asj_sector_plan *plan);

#endif
