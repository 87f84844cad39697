/* SPDX-License-Identifier: BSD-2-Clause */
/* The grey plane between pixels. */
#ifndef ASJ_SRC_GRAY_AT_H
#define ASJ_SRC_GRAY_AT_H

#include "core/image.h"

#include <math.h>

static inline int32_t asj_gray_inside(double value, int32_t last)
{
    return value <= 0 ? 0 : value >= last ? last : (int32_t)value;
}

/* How far a coordinate is from its pixel. fmin() and fmax() would be calls. */
static inline double asj_gray_part(double value, int32_t pixel)
{
    const double part = value - pixel;
    return part <= 0 ? 0 : part >= 1 ? 1 : part;
}

/* Grey level at (x, y) in 1/ASJ_GRAY_ONE, bilinear; outside the image its border counts. */
static inline double asj_gray_at(const asj_frame *frame, double x, double y)
{
    const int32_t column = asj_gray_inside(x, frame->width - 1), row = asj_gray_inside(y, frame->height - 1);
    const int32_t right = column + 1 < frame->width ? 1 : 0;
    const double wx = asj_gray_part(x, column), wy = asj_gray_part(y, row);
    const uint16_t *upper = frame->gray + row * frame->stride + column;
    const uint16_t *lower = row + 1 < frame->height ? upper + frame->stride : upper;
    return (1 - wy) * ((1 - wx) * upper[0] + wx * upper[right]) + wy * ((1 - wx) * lower[0] + wx * lower[right]);
}

#endif
