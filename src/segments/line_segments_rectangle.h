/* SPDX-License-Identifier: BSD-2-Clause */
/* Rectangles that stand for regions of level lines. */
#ifndef ASJ_SRC_LINE_SEGMENTS_RECTANGLE_H
#define ASJ_SRC_LINE_SEGMENTS_RECTANGLE_H

#include "line_segments_levels.h"

/* All places with  first <= along <= last,  low <= across <= high, where along and across are the coordinates from (x, y) in
 * direction (ux, uy) and in (-uy, ux), in samples. */
typedef struct asj_rectangle {
    double x, y, ux, uy;
    double first, last, low, high;
} asj_rectangle;

static inline double asj_rectangle_length(const asj_rectangle *r)
{
    return r->last - r->first;
}

/* At least 1: a line of samples is one wide. */
static inline double asj_rectangle_width(const asj_rectangle *r)
{
    return r->high - r->low > 1 ? r->high - r->low : 1;
}

/* The rectangle of `count` >= 1 samples, whose level lines point on average in direction (towards_x, towards_y). */
asj_rectangle asj_rectangle_of(const asj_levels *levels, const int32_t *samples, int32_t count, double towards_x, double towards_y);

/* Counts the samples of the field inside, and in aligned[i] those whose level line is within p_i pi of the rectangle's direction,
 * cosines[i] = cos(p_i pi), i = 0 .. count - 1. Returns the former. */
int32_t asj_rectangle_count(const asj_levels *levels, const asj_rectangle *r, const float *cosines, int32_t count,
                            int32_t *aligned);

#endif
