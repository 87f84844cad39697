/* SPDX-License-Identifier: BSD-2-Clause */
/* Regions of samples whose level lines agree. */
#ifndef ASJ_SRC_LINE_SEGMENTS_REGION_H
#define ASJ_SRC_LINE_SEGMENTS_REGION_H

#include "line_segments_rectangle.h"

/* cos of the angle tolerance, 22.5 degrees: p = 1/8 of all directions. */
#define ASJ_REGION_COSINE 0.92387953251128676

/* A region while it grows. `samples` and `used` belong to the caller: as many elements as the field has samples. */
typedef struct asj_support_region {
    int32_t *samples;
    uint8_t *used;      /* 1: sample belongs to a region that was kept, or to this one */
    int32_t count;
    double x, y;        /* mean direction of the level lines, a unit vector */
} asj_support_region;

/* Grows the region of a sample that is not used; cosine: of the largest angle between a sample that joins and the mean. */
void asj_region_grow(const asj_levels *levels, int32_t seed, double cosine, asj_support_region *region);

/* Cuts a region to what a rectangle covers well, and gives the rectangle. 0 when nothing is left but its seed. */
int asj_region_approximate(const asj_levels *levels, asj_support_region *region, asj_rectangle *rectangle);

#endif
